#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "fovea/base/wide.h"
#include "fovea/model/ids.h"
#include "fovea/render/scan_convert.h"

namespace fovea {

/// What a triangle shows at the middle of a pixel.
struct Fragment {
  float nearness = 0;
  std::uint32_t triangle = kInvalid;
  std::uint32_t value = 0;  ///< Whatever the caller keeps of it: a colour, a region.

  /// Nearer ones come first; of equally near ones the smaller number.
  bool is_before(const Fragment& other) const {
    return nearness != other.nearness ? nearness > other.nearness : triangle < other.triangle;
  }
  friend bool operator==(const Fragment&, const Fragment&) = default;
};

/// The nearest fragments of a pixel; the background where there are fewer.
struct FrontPixel {
  Fragment first, second;
};

/// What most looks at kWide pixels beside each other need, in two cache lines: the nearest fragment, and how
/// near the second is.
struct alignas(64) FrontBlock {
  WideFloats nearness;
  WideWords triangle, value;
  WideFloats second_nearness;
};

/// All triangles behind each pixel of a view, nearest first, hidden ones among them: what is visible after a
/// triangle goes is the next in the list, and nothing has to be drawn again.
///
/// The lists depend on the triangles that are in them, not on the order in which they came. A pixel takes 32
/// bytes, its two nearest fragments among them, each further fragment 12. These lie in one pool in rooms of
/// powers of two, so that they take at most twice what they need. Rooms that they have outgrown wait for
/// others: all together takes about two to four times, at most nine times what the fragments need when each
/// list is at its longest.
///
/// Pixels lie in blocks of kWide beside each other, those of a column below each other: a look at a few tens
/// of rows stays within few pages of memory. The last column is filled up with pixels that no triangle
/// covers.
class FragmentLists {
 public:
  /// `background` is the value where there is no triangle.
  FragmentLists(int width, int height, std::uint32_t background = 0)
      : width_(width),
        height_(height),
        background_{-std::numeric_limits<float>::infinity(), kInvalid, background},
        fronts_((static_cast<std::size_t>(width) + kWide - 1) / kWide * static_cast<std::size_t>(height)),
        seconds_(fronts_.size()),
        behind_(fronts_.size() * kWide),
        row_(static_cast<std::size_t>(width)) {
    for (std::size_t p = 0; p < pixel_count(); ++p) set_first(p, background_), set_second(p, background_);
  }

  int width() const { return width_; }
  int height() const { return height_; }
  SampleRect rect() const { return {0, 0, width_, height_}; }
  /// The number of a pixel, below `pixel_count`.
  std::size_t pixel(int x, int y) const {
    const auto column = static_cast<std::size_t>(x);
    return (column / kWide * static_cast<std::size_t>(height_) + static_cast<std::size_t>(y)) * kWide +
           column % kWide;
  }
  /// With those that fill up.
  std::size_t pixel_count() const { return behind_.size(); }

  /// The nearest fragments of a pixel; the background is infinitely far and without a triangle.
  FrontPixel front(std::size_t pixel) const { return {first(pixel), second(pixel)}; }
  Fragment first(std::size_t pixel) const {
    const FrontBlock& block = fronts_[pixel / kWide];
    const std::size_t i = pixel % kWide;
    return {block.nearness[i], block.triangle[i], block.value[i]};
  }
  /// Those of the pixels from x = column · kWide on in all rows. [#rows]
  const FrontBlock* blocks(int column) const {
    return fronts_.data() + static_cast<std::size_t>(column) * static_cast<std::size_t>(height_);
  }
  /// Those behind them, nearest first. Valid until something is inserted.
  std::span<const Fragment> behind(std::size_t pixel) const {
    return {pool_.data() + behind_[pixel].begin, behind_[pixel].size};
  }
  /// All of them, nearest first.
  std::vector<Fragment> at(std::size_t pixel) const;
  const Fragment& background() const { return background_; }
  /// How many fragments there are in all.
  std::size_t size() const { return size_; }
  std::size_t bytes() const;

  /// A value that stands for a hole.
  static constexpr std::uint32_t kHole = 0;

  /// Adds a triangle, which is not there yet. `values(y, x0, x1, out)` says what it shows at the pixels
  /// [x0, x1) of a row. Calls `changed(pixel, before, after)` where it is in front of all others, with what
  /// was there and what is. O(pixels · depth).
  template <class Values, class Changed>
  void insert(std::uint32_t triangle, const std::array<ScreenVertex, 3>& v, Values&& values,
              Changed&& changed) {
    for_spans(v, rect(), [&](int y, int x0, int x1, const NearnessPlane& plane) {
      values(y, x0, x1, row_.data());
      plane.for_row(y, x0, x1, [&](int x, float nearness) {
        const Fragment fragment{nearness, triangle, row_[static_cast<std::size_t>(x - x0)]};
        if (fragment.value == kHole) return;
        const std::size_t p = pixel(x, y);
        const Fragment before = first(p);
        if (add(p, fragment)) changed(p, before, fragment);
      });
    });
  }
  template <class Values>
  void insert(std::uint32_t triangle, const std::array<ScreenVertex, 3>& v, Values&& values) {
    insert(triangle, v, values, [](auto&&...) {});
  }
  /// Takes a triangle out; it must be where it was put in. Calls `changed(pixel, before, after)` where it was
  /// in front of all others, with what was there and what is.
  template <class Changed>
  void remove(std::uint32_t triangle, const std::array<ScreenVertex, 3>& v, Changed&& changed) {
    for_spans(v, rect(), [&](int y, int x0, int x1, const NearnessPlane&) {
      for (int x = x0; x < x1; ++x) {
        const std::size_t p = pixel(x, y);
        const Fragment front = first(p);
        drop(p, triangle);
        if (front.triangle == triangle) changed(p, front, first(p));
      }
    });
  }
  void remove(std::uint32_t triangle, const std::array<ScreenVertex, 3>& v) {
    remove(triangle, v, [](auto&&...) {});
  }

 private:
  struct List {
    std::uint32_t begin = 0;
    std::uint32_t size = 0;  // its room is the next power of two
  };
  static std::size_t room_class(std::uint32_t size) {
    return static_cast<std::size_t>(std::countr_zero(std::bit_ceil(size)));
  }

  /// The rest of what is second, beside its nearness.
  struct SecondBlock {
    WideWords triangle, value;
  };

  Fragment second(std::size_t pixel) const {
    const SecondBlock& block = seconds_[pixel / kWide];
    const std::size_t i = pixel % kWide;
    return {fronts_[pixel / kWide].second_nearness[i], block.triangle[i], block.value[i]};
  }
  void set_first(std::size_t pixel, const Fragment& fragment) {
    FrontBlock& block = fronts_[pixel / kWide];
    const std::size_t i = pixel % kWide;
    block.nearness[i] = fragment.nearness;
    block.triangle[i] = fragment.triangle;
    block.value[i] = fragment.value;
  }
  void set_second(std::size_t pixel, const Fragment& fragment) {
    SecondBlock& block = seconds_[pixel / kWide];
    const std::size_t i = pixel % kWide;
    fronts_[pixel / kWide].second_nearness[i] = fragment.nearness;
    block.triangle[i] = fragment.triangle;
    block.value[i] = fragment.value;
  }
  bool add(std::size_t pixel, const Fragment& fragment);
  void drop(std::size_t pixel, std::uint32_t triangle);
  void add_behind(std::size_t pixel, const Fragment& fragment);
  bool drop_behind(std::size_t pixel, std::uint32_t triangle);
  Fragment take_behind(std::size_t pixel);
  void resize(List& list, std::uint32_t size);

  int width_, height_;
  std::size_t size_ = 0;
  Fragment background_;
  std::vector<FrontBlock> fronts_;    // [#blocks]
  std::vector<SecondBlock> seconds_;  // [#blocks]
  std::vector<List> behind_;          // [#pixels], what comes after the two in front
  std::vector<std::uint32_t> row_;    // scratch of insert
  std::vector<Fragment> pool_;
  std::array<std::vector<std::uint32_t>, 32> free_;  // [log2 of room], where rooms begin
};

/// Whether it is now in front.
inline bool FragmentLists::add(std::size_t pixel, const Fragment& fragment) {
  const auto is_free = [](const Fragment& place) { return place.triangle == kInvalid; };
  const Fragment second = this->second(pixel);
  ++size_;
  if (!is_free(second) && !fragment.is_before(second)) {
    add_behind(pixel, fragment);
    return false;
  }
  if (!is_free(second)) add_behind(pixel, second);
  const Fragment first = this->first(pixel);
  const bool is_first = is_free(first) || fragment.is_before(first);
  set_second(pixel, is_first ? first : fragment);
  if (is_first) set_first(pixel, fragment);
  return is_first;
}

inline void FragmentLists::drop(std::size_t pixel, std::uint32_t triangle) {
  const Fragment second = this->second(pixel);
  if (fronts_[pixel / kWide].triangle[pixel % kWide] == triangle) {
    set_first(pixel, second);
  } else if (second.triangle != triangle) {
    // Or a hole.
    if (second.triangle != kInvalid && drop_behind(pixel, triangle)) --size_;
    return;
  }
  if (second.triangle != kInvalid) set_second(pixel, take_behind(pixel));
  --size_;
}

}  // namespace fovea
