#include "fovea/surface/closest_point.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "fovea/base/error.h"
#include "fovea/base/random.h"

namespace fovea {
namespace {

Vec3d random_point(Random& random) {
  return {random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)};
}

TEST(ClosestPoint, NoPointOfTheTriangleIsNearer) {
  Random random(2);
  for (int i = 0; i < 300; ++i) {
    const Vec3d a = random_point(random), b = random_point(random), c = random_point(random),
                p = random_point(random);
    const auto [q, weights] = closest_on_triangle(p, a, b, c);
    EXPECT_LT(length(a * weights[0] + b * weights[1] + c * weights[2] - q), 1e-12);
    EXPECT_NEAR(weights[0] + weights[1] + weights[2], 1, 1e-12);
    for (const double w : weights) EXPECT_GE(w, 0);
    // q is a point of the triangle ...
    const Vec3d n = cross(b - a, c - a);
    EXPECT_NEAR(dot(q - a, n), 0, 1e-12);
    EXPECT_GE(dot(cross(b - a, q - a), n), -1e-12);
    EXPECT_GE(dot(cross(c - b, q - b), n), -1e-12);
    EXPECT_GE(dot(cross(a - c, q - c), n), -1e-12);
    // ... and others are no nearer.
    for (int k = 0; k < 50; ++k) {
      const double r = std::sqrt(random.uniform()), s = random.uniform();
      const Vec3d other = a * (1 - r) + b * (r * (1 - s)) + c * (r * s);
      EXPECT_LE(length(p - q), length(p - other) + 1e-12);
    }
  }
}

TEST(ClosestPoint, WorksOnTrianglesWithoutArea) {
  const Vec3d a{0, 0, 0}, b{2, 0, 0};
  EXPECT_LT(length(closest_on_triangle({1, 1, 0}, a, b, a).point - Vec3d{1, 0, 0}), 1e-12);
  EXPECT_LT(length(closest_on_triangle({1, 1, 0}, a, a, a).point), 1e-12);
  EXPECT_LT(length(closest_on_triangle({5, 1, 0}, a, b, {1, 0, 0}).point - b), 1e-12);
}

TEST(ClosestPoint, FindsWhatLookingAtEveryTriangleFinds) {
  Random random(4);
  Surface soup;
  for (std::uint32_t t = 0; t < 400; ++t) {
    const Vec3d corner = random_point(random);
    for (int k = 0; k < 3; ++k) soup.positions.emplace_back(corner + random_point(random) * 0.1);
    soup.triangles.push_back({3 * t, 3 * t + 1, 3 * t + 2});
  }
  const ClosestPoint tree(soup);
  for (int i = 0; i < 500; ++i) {
    const Vec3d p = random_point(random) * 1.5;
    double best = std::numeric_limits<double>::infinity();
    for (const auto& t : soup.triangles) {
      const Vec3d q = closest_on_triangle(p, Vec3d(soup.positions[t[0]]), Vec3d(soup.positions[t[1]]),
                                          Vec3d(soup.positions[t[2]]))
                          .point;
      best = std::min(best, length(p - q));
    }
    const ClosestPoint::Hit hit = tree.nearest(p);
    EXPECT_EQ(hit.distance, best);
    EXPECT_EQ(length(hit.point - p), best);
    Vec3d from_weights;
    for (std::size_t k = 0; k < 3; ++k)
      from_weights += Vec3d(soup.positions[soup.triangles[hit.triangle][k]]) * hit.weights[k];
    EXPECT_LT(length(from_weights - hit.point), 1e-12);
  }
}

TEST(ClosestPoint, OfEquallyNearTheLowestNumber) {
  Surface soup;
  soup.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  soup.triangles.assign(9, {0, 1, 2});
  EXPECT_EQ(ClosestPoint(soup).nearest({0.2, 0.2, 3}).triangle, 0u);
}

TEST(ClosestPoint, NothingIsInfinitelyFar) {
  const Surface empty;
  EXPECT_EQ(ClosestPoint(empty).nearest({}).distance, std::numeric_limits<double>::infinity());
}

/// A square whose corners are at ±size, and the largest and smallest sizes at which it may be: Embree itself
/// takes nothing beyond 10¹⁸ and loses what is near 0.
Surface square(float size) {
  return {{{-size, -size, 0}, {size, -size, 0}, {size, size, 0}, {-size, size, 0}}, {{0, 1, 2}, {0, 2, 3}}};
}
constexpr float kSizes[] = {1e-30f, 1e-12f, 1, 1e15f, 1e30f};

TEST(ClosestPoint, WorksAtAnySize) {
  for (const float size : kSizes) {
    const Surface surface = square(size);
    const double s = static_cast<double>(size);
    const ClosestPoint::Hit hit = ClosestPoint(surface).nearest({-0.5 * s, 0.5 * s, s});
    EXPECT_EQ(hit.triangle, 1u) << size;
    EXPECT_NEAR(hit.distance / s, 1, 1e-9) << size;
  }
}

TEST(ClosestPoint, APointFarOutsideHasOneToo) {
  const Surface surface = square(1);
  const ClosestPoint::Hit hit = ClosestPoint(surface).nearest({0, 1e30, 0});
  EXPECT_NEAR(hit.point.y, 1, 1e-9);
}

TEST(ClosestPoint, RefusesPositionsThatAreNotFinite) {
  const Surface surface = square(std::numeric_limits<float>::infinity());
  try {
    const ClosestPoint tree(surface);
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::unsupported);
  }
}

}  // namespace
}  // namespace fovea
