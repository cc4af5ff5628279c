#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
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

/// All triangles behind each pixel of a view, nearest first, hidden ones among them: what is visible after a
/// triangle goes is the next in the list, and nothing has to be drawn again.
///
/// The lists depend on the triangles that are in them, not on the order in which they came. A fragment takes
/// 12 bytes, a pixel 8; lists lie in one pool in rooms of powers of two, so that a list takes at most twice
/// what its fragments need. Rooms that lists have outgrown wait for others: all together takes about two to
/// four times, at most nine times what the lists need when each is at its longest.
class FragmentLists {
 public:
  FragmentLists(int width, int height)
      : width_(width),
        height_(height),
        pixels_(static_cast<std::size_t>(width) * static_cast<std::size_t>(height)) {}

  int width() const { return width_; }
  int height() const { return height_; }
  SampleRect rect() const { return {0, 0, width_, height_}; }
  std::size_t pixel(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) + static_cast<std::size_t>(x);
  }

  /// The fragments behind a pixel, nearest first. Valid until something is inserted.
  std::span<const Fragment> at(std::size_t pixel) const {
    return {pool_.data() + pixels_[pixel].begin, pixels_[pixel].size};
  }
  /// How many fragments there are in all.
  std::size_t size() const { return size_; }
  std::size_t bytes() const;

  /// Adds a triangle, which is not there yet. `value(x, y, out)` says what it shows at a pixel; if it returns
  /// false it has a hole there. Calls `changed(pixel, before, after)` where it is in front of all others,
  /// with what was there (null: nothing) and what is. O(pixels · depth).
  template <class Value, class Changed>
  void insert(std::uint32_t triangle, const std::array<ScreenVertex, 3>& v, Value&& value,
              Changed&& changed) {
    for_spans(v, rect(), [&](int y, int x0, int x1, const NearnessPlane& plane) {
      plane.for_row(y, x0, x1, [&](int x, float nearness) {
        Fragment fragment{nearness, triangle, 0};
        if (!value(x, y, fragment.value)) return;
        const std::size_t p = pixel(x, y);
        add(pixels_[p], fragment);
        const std::span<const Fragment> list = at(p);
        if (list[0].triangle == triangle) changed(p, list.size() > 1 ? &list[1] : nullptr, &list[0]);
      });
    });
  }
  template <class Value>
  void insert(std::uint32_t triangle, const std::array<ScreenVertex, 3>& v, Value&& value) {
    insert(triangle, v, value, [](auto&&...) {});
  }
  /// Takes a triangle out; it must be where it was put in. Calls `changed(pixel, before, after)` where it was
  /// in front of all others.
  template <class Changed>
  void remove(std::uint32_t triangle, const std::array<ScreenVertex, 3>& v, Changed&& changed) {
    for_spans(v, rect(), [&](int y, int x0, int x1, const NearnessPlane&) {
      for (int x = x0; x < x1; ++x) {
        const std::size_t p = pixel(x, y);
        const std::span<const Fragment> list = at(p);
        if (list.empty()) continue;  // a hole
        const Fragment front = list[0];
        drop(pixels_[p], triangle);
        if (front.triangle == triangle) changed(p, &front, at(p).empty() ? nullptr : &at(p)[0]);
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

  void add(List& list, const Fragment& fragment);
  void drop(List& list, std::uint32_t triangle);
  void resize(List& list, std::uint32_t size);

  int width_, height_;
  std::size_t size_ = 0;
  std::vector<List> pixels_;
  std::vector<Fragment> pool_;
  std::array<std::vector<std::uint32_t>, 32> free_;  // [log2 of room], where rooms begin
};

}  // namespace fovea
