#pragma once

#include <array>
#include <cstdint>

namespace fovea {

/// The grid's coordinates are whole numbers, so many to the distance between samples.
constexpr int kSubsampleBits = 8;
constexpr int kSubsamples = 1 << kSubsampleBits;

/// A vertex on the sample grid, x to the right, y down. In 1/256 of the distance between samples, which are
/// at odd multiples of 128.
struct ScreenVertex {
  std::int32_t x = 0, y = 0;
  float nearness = 0;  ///< Linear on the screen, larger in front: 1 / distance, or −distance in parallel.
};

/// Twice the area on the screen; positive if clockwise, as y points down.
inline std::int64_t double_area(const std::array<ScreenVertex, 3>& v) {
  return (std::int64_t{v[1].x} - v[0].x) * (std::int64_t{v[2].y} - v[0].y) -
         (std::int64_t{v[2].x} - v[0].x) * (std::int64_t{v[1].y} - v[0].y);
}

}  // namespace fovea
