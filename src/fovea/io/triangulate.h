#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "fovea/base/math.h"

namespace fovea {

/// Cuts polygons into triangles. Keeps its work space from call to call.
///
/// Triangles, convex polygons and quads take O(n); concave polygons are cut ear by ear in the plane
/// of their Newell normal, O(n²), without new points. Polygons that cross themselves, and concave
/// ones with more than kMaxEars corners, become a fan.
class Triangulator {
 public:
  static constexpr std::size_t kMaxEars = 512;

  /// Triangles over the corner numbers of `polygon` (n - 2 of them; none for n < 3), wound like it.
  /// Valid until the next call.
  std::span<const std::array<std::uint32_t, 3>> run(std::span<const Vec3f> polygon);

 private:
  void fan(std::size_t count);
  bool project(std::span<const Vec3f> polygon);
  bool is_convex();
  void cut_quad();
  void cut_ears();
  std::size_t find_ear(std::size_t from) const;
  bool is_ear(std::size_t at, bool strict) const;

  std::vector<std::array<std::uint32_t, 3>> triangles_;
  std::vector<Vec2d> points_;        // the polygon in its plane, counter-clockwise
  std::vector<Vec2d> distinct_;      // without repeated corners
  std::vector<std::uint32_t> left_;  // corners not yet cut off
};

}  // namespace fovea
