#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <utility>

#include "fovea/base/wide.h"
#include "fovea/render/scan_convert.h"

namespace fovea {

/// Pixels beside each other that are worked on together: those from a multiple of it on are a column.
constexpr int kColumn = static_cast<int>(kWide);
constexpr WideInts kLanes = {0, 1, 2, 3, 4, 5, 6, 7};

/// Rows [begin, end) of a column; by default none.
struct RowRange {
  int begin = std::numeric_limits<int>::max(), end = 0;
  bool empty() const { return begin >= end; }
};

/// A triangle whose edge functions fit into 32 bits, so that many samples can be tried at once: those of
/// `for_spans`, without a loop that depends on where a row of them begins and ends.
struct WideTriangle {
  /// Sample (x, y) is covered if aₖ·x + bₖ·y + cₖ, modulo 2³², has no sign bit for any k. True of the samples
  /// of `box` and of kWide beside it on either side.
  std::array<std::uint32_t, 3> a{}, b{}, c{};
  NearnessPlane plane;
  SampleBox box;

  /// Whether a triangle is small enough: then what is true of edge functions is less than 2³⁰.
  static bool fits(const std::array<ScreenVertex, 3>& v) {
    constexpr std::int64_t kMost = 1 << 18;
    const auto [xl, xh] = std::minmax({v[0].x, v[1].x, v[2].x});
    const auto [yl, yh] = std::minmax({v[0].y, v[1].y, v[2].y});
    return std::int64_t{xh} - xl < kMost && std::int64_t{yh} - yl < kMost;
  }

  /// `v` fits and has an area; either winding.
  WideTriangle(std::array<ScreenVertex, 3> v, const SampleRect& rect) : box(sample_box(v, rect)) {
    std::int64_t area = double_area(v);
    if (area < 0) {
      std::swap(v[1], v[2]);
      area = -area;
    }
    plane = NearnessPlane(v, static_cast<double>(area), rect);
    for (std::size_t k = 0; k < 3; ++k) {
      // Slopes are whole multiples of kSubsamples; what c has beyond one does not change a sign.
      const scan::Edge edge(v[k], v[(k + 1) % 3], rect);
      a[k] = static_cast<std::uint32_t>(edge.a >> kSubsampleBits);
      b[k] = static_cast<std::uint32_t>(edge.b >> kSubsampleBits);
      c[k] = static_cast<std::uint32_t>(edge.c >> kSubsampleBits);
    }
  }
};

/// In which rows a triangle that fits may cover samples of each column, of those that its box touches: little
/// more than where it does. The rectangle begins at 0, 0.
void find_rows(const std::array<ScreenVertex, 3>& v, const SampleBox& box, RowRange* out);

}  // namespace fovea
