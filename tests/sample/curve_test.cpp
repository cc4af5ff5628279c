#include "fovea/sample/curve.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

namespace fovea::sample {
namespace {

double distance(Vec2d a, Vec2d b) { return std::hypot(a.x - b.x, a.y - b.y); }

TEST(Curve, GoesThroughItsPointsExactly) {
  const std::vector<Vec2d> points{{0, 0.1}, {0.3, 1.7}, {2, 2}, {2.1, 0.3}};
  const Curve curve(points);
  for (std::size_t i = 0; i < points.size(); ++i) EXPECT_EQ(curve.at(static_cast<double>(i)), points[i]);
}

TEST(Curve, StraightStaysStraight) {
  const Curve curve({{0, 0}, {1, 1}, {4, 4}});
  for (double t = 0; t <= 2; t += 0.1) EXPECT_NEAR(curve.at(t).x, curve.at(t).y, 1e-14);
  // Chords of a straight line add up to it but for rounding.
  EXPECT_NEAR(curve.length(0, 2), std::sqrt(32.0), 1e-12);
}

TEST(Curve, EvenPointsHaveEqualDistancesAndExactEnds) {
  const Curve curve({{0, 0}, {0.2, 0}, {3, 1}, {3.1, 4}});
  const auto points = curve.even(0, 3, 40);
  ASSERT_EQ(points.size(), 41u);
  EXPECT_EQ(points.front(), curve.at(0));
  EXPECT_EQ(points.back(), curve.at(3));
  const double step = curve.length(0, 3) / 40;
  // Chords are shorter than arcs, most where the curve bends.
  for (std::size_t i = 1; i < points.size(); ++i) {
    EXPECT_NEAR(distance(points[i - 1], points[i]), step, 0.05 * step);
  }
}

TEST(Curve, LengthOfACirclesPoints) {
  std::vector<Vec2d> points;
  for (int i = 0; i <= 36; ++i) {
    const double angle = i * std::numbers::pi / 18;
    points.push_back({std::cos(angle), std::sin(angle)});
  }
  // The spline leaves the circle by less than 1e-4 between points, 10 degrees apart.
  EXPECT_NEAR(Curve(points).length(0, 36), 2 * std::numbers::pi, 2e-3);
}

TEST(Curve, OnePointIsAPlace) { EXPECT_EQ(Curve({{3, 4}}).at(0), (Vec2d{3, 4})); }

}  // namespace
}  // namespace fovea::sample
