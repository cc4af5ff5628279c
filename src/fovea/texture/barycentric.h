#pragma once

#include <algorithm>
#include <array>

#include "fovea/base/math.h"

// Shared inside Fovea, not installed.

namespace fovea {

/// Places in a triangle of the plane as weights of its corners, with sum 1; all at the first corner if it
/// has no area.
class Barycentric {
 public:
  explicit Barycentric(const std::array<Vec2d, 3>& triangle)
      : origin_(triangle[0]), a_(triangle[1] - triangle[0]), b_(triangle[2] - triangle[0]) {
    const double area = cross(a_, b_), scale = area != 0 ? 1 / area : 0;
    a_ = a_ * scale;
    b_ = b_ * scale;
  }
  std::array<double, 3> at(Vec2d point) const {
    const Vec2d p = point - origin_;
    const double s = cross(p, b_), t = cross(a_, p);
    return {1 - s - t, s, t};
  }

 private:
  Vec2d origin_, a_, b_;  // edges over twice the area; 0 if there is none
};

/// Weights in the triangle for those of a point outside.
inline std::array<double, 3> clamped(const std::array<double, 3>& weights) {
  const double s = std::clamp(weights[1], 0.0, 1.0), t = std::clamp(weights[2], 0.0, 1.0 - s);
  return {1 - s - t, s, t};
}

}  // namespace fovea
