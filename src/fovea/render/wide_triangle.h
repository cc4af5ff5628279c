#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <utility>

#include "fovea/base/wide.h"
#include "fovea/render/scan_convert.h"

namespace fovea {

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

}  // namespace fovea
