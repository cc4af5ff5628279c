#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

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

/// What most looks at a pixel need, in half a cache line.
struct alignas(32) FrontPixel {
  Fragment first, second;                ///< The nearest; the background where there are fewer.
  std::array<std::uint32_t, 2> notes{};  ///< The caller's own.
};

/// All triangles behind each pixel of a view, nearest first, hidden ones among them: what is visible after a
/// triangle goes is the next in the list, and nothing has to be drawn again.
///
/// The lists depend on the triangles that are in them, not on the order in which they came. A pixel takes 40
/// bytes, its two nearest fragments among them, each further fragment 12. These lie in one pool in rooms of
/// powers of two, so that they take at most twice what they need. Rooms that they have outgrown wait for
/// others: all together takes about two to four times, at most nine times what the fragments need when each
/// list is at its longest.
class FragmentLists {
 public:
  /// `background` is the value where there is no triangle.
  FragmentLists(int width, int height, std::uint32_t background = 0)
      : width_(width),
        height_(height),
        background_{-std::numeric_limits<float>::infinity(), kInvalid, background},
        fronts_(static_cast<std::size_t>(width) * static_cast<std::size_t>(height),
                {background_, background_, {}}),
        behind_(fronts_.size()),
        row_(static_cast<std::size_t>(width)) {}

  int width() const { return width_; }
  int height() const { return height_; }
  SampleRect rect() const { return {0, 0, width_, height_}; }
  std::size_t pixel(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) + static_cast<std::size_t>(x);
  }

  /// The nearest fragments of a pixel; the background is infinitely far and without a triangle.
  const FrontPixel& front(std::size_t pixel) const { return fronts_[pixel]; }
  /// Those behind them, nearest first. Valid until something is inserted.
  std::span<const Fragment> behind(std::size_t pixel) const {
    return {pool_.data() + behind_[pixel].begin, behind_[pixel].size};
  }
  /// All of them, nearest first.
  std::vector<Fragment> at(std::size_t pixel) const;
  std::array<std::uint32_t, 2>& notes(std::size_t pixel) { return fronts_[pixel].notes; }
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
        const Fragment before = fronts_[p].first;
        add(p, fragment);
        if (fronts_[p].first.triangle == triangle) changed(p, before, fragment);
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
        const Fragment front = fronts_[p].first;
        drop(p, triangle);
        if (front.triangle == triangle) changed(p, front, fronts_[p].first);
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

  void add(std::size_t pixel, const Fragment& fragment);
  void drop(std::size_t pixel, std::uint32_t triangle);
  void add_behind(std::size_t pixel, const Fragment& fragment);
  bool drop_behind(std::size_t pixel, std::uint32_t triangle);
  Fragment take_behind(std::size_t pixel);
  void resize(List& list, std::uint32_t size);

  int width_, height_;
  std::size_t size_ = 0;
  Fragment background_;
  std::vector<FrontPixel> fronts_;  // [#pixels]
  std::vector<List> behind_;        // [#pixels], what comes after the two in front
  std::vector<std::uint32_t> row_;  // scratch of insert
  std::vector<Fragment> pool_;
  std::array<std::vector<std::uint32_t>, 32> free_;  // [log2 of room], where rooms begin
};

inline void FragmentLists::add(std::size_t pixel, const Fragment& fragment) {
  const auto is_free = [](const Fragment& place) { return place.triangle == kInvalid; };
  FrontPixel& front = fronts_[pixel];
  ++size_;
  if (!is_free(front.second) && !fragment.is_before(front.second)) {
    add_behind(pixel, fragment);
    return;
  }
  if (!is_free(front.second)) add_behind(pixel, front.second);
  const bool is_first = is_free(front.first) || fragment.is_before(front.first);
  front.second = is_first ? front.first : fragment;
  if (is_first) front.first = fragment;
}

inline void FragmentLists::drop(std::size_t pixel, std::uint32_t triangle) {
  FrontPixel& front = fronts_[pixel];
  if (front.first.triangle == triangle) {
    front.first = front.second;
  } else if (front.second.triangle != triangle) {
    // Or a hole.
    if (front.second.triangle != kInvalid && drop_behind(pixel, triangle)) --size_;
    return;
  }
  if (front.second.triangle != kInvalid) front.second = take_behind(pixel);
  --size_;
}

}  // namespace fovea
