#pragma once

#include <vector>

#include "fovea/base/math.h"

namespace fovea::sample {

/// A smooth curve through points of the plane (centripetal Catmull-Rom; Yuksel et al. 2011), which
/// neither loops nor overshoots between near points.
class Curve {
 public:
  explicit Curve(std::vector<Vec2d> points);

  /// The point at `t`: whole numbers are the curve's points, 0 … size - 1.
  Vec2d at(double t) const;
  /// `count` + 1 points from parameter `from` to `to` at equal distances along the curve; the first
  /// and the last are exactly `at(from)` and `at(to)`.
  std::vector<Vec2d> even(double from, double to, int count) const;
  /// Distance along the curve from parameter `from` to `to`.
  double length(double from, double to) const;

 private:
  std::vector<Vec2d> points_;
};

}  // namespace fovea::sample
