#include "fovea/simplify/quadric.h"

#include <gtest/gtest.h>

#include "fovea/base/random.h"
#include "oracle/collapse_oracle.h"

namespace fovea {
namespace {

Vec3d random_point(Random& random) {
  return {random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)};
}

std::vector<oracle::Sample> random_triangles(Random& random, int count) {
  std::vector<oracle::Sample> result;
  for (int i = 0; i < count; ++i) {
    oracle::Sample t;
    for (int k = 0; k < 3; ++k) {
      t.p[k] = random_point(random);
      t.s[k] = random.uniform(-1, 1);
    }
    t.weight = random.uniform(0.1, 1);
    result.push_back(t);
  }
  return result;
}

/// The engine's way: the quadric of planes, or of one attribute, over triangles.
Quadric plane_quadric(const std::vector<oracle::Sample>& triangles) {
  Quadric q;
  for (const auto& t : triangles) {
    const Vec3d n = normalized(cross(t.p[1] - t.p[0], t.p[2] - t.p[0]));
    q.add_linear(n, -dot(n, t.p[0]), t.weight);
  }
  return q;
}

Quadric attribute_quadric(const std::vector<oracle::Sample>& triangles, std::vector<double>& value) {
  Quadric q;
  value.assign(attribute_stride(1), 0.0);
  for (const auto& t : triangles) {
    const Vec3d n = cross(t.p[1] - t.p[0], t.p[2] - t.p[0]);
    const Vec3d g =
        TriangleGradient(t.p[1] - t.p[0], t.p[2] - t.p[0], normalized(n), length(n))(t.s[0], t.s[1], t.s[2]);
    const double d = t.s[0] - dot(g, t.p[0]);
    q.add_linear(g, d, t.weight);
    value[0] += t.weight * g.x;
    value[1] += t.weight * g.y;
    value[2] += t.weight * g.z;
    value[3] += t.weight * d;
    value[4] += t.weight;
  }
  return q;
}

// All quantities are of order 1; double rounding over a dozen terms stays below 1e-12. The golden
// section leaves about 1e-8 in s, squared in the error; slim random triangles magnify both.
constexpr double kTolerance = 1e-9;

TEST(Quadric, IsTheSumOfSquaredPlaneDistances) {
  Random random(1);
  const auto triangles = random_triangles(random, 12);
  const Quadric q = plane_quadric(triangles);
  for (int i = 0; i < 20; ++i) {
    const Vec3d p = random_point(random);
    double expected = 0;
    for (const auto& t : triangles) expected += t.weight * oracle::plane_distance_squared(t, p);
    EXPECT_NEAR(q.value(p), expected, kTolerance * (1 + expected));
  }
}

TEST(Quadric, MinimumIsNotBeatenByAnyPointAround) {
  Random random(2);
  const Quadric q = plane_quadric(random_triangles(random, 9));
  Vec3d best;
  ASSERT_TRUE(q.minimum(best));
  EXPECT_NEAR(q.value_at_minimum(best), q.value(best), kTolerance);
  for (int i = 0; i < 50; ++i) EXPECT_GE(q.value(best + random_point(random) * 0.1), q.value(best));
}

TEST(Quadric, HasNoMinimumOnASinglePlane) {
  Quadric q;
  q.add_linear({0, 0, 1}, -0.5, 2);
  Vec3d best;
  EXPECT_FALSE(q.minimum(best));
}

TEST(Quadric, PointPullMakesAPlaneSolvable) {
  Quadric q;
  q.add_linear({0, 0, 1}, 0, 1);
  q.add_point({0.3, -0.2, 0}, 1e-4);
  Vec3d best;
  ASSERT_TRUE(q.minimum(best));
  EXPECT_NEAR(best.x, 0.3, 1e-9);
  EXPECT_NEAR(best.y, -0.2, 1e-9);
  EXPECT_NEAR(best.z, 0, 1e-9);
}

TEST(TriangleGradient, TakesTheCornerValues) {
  Random random(3);
  for (const auto& t : random_triangles(random, 20)) {
    const Vec3d n = cross(t.p[1] - t.p[0], t.p[2] - t.p[0]);
    const Vec3d g =
        TriangleGradient(t.p[1] - t.p[0], t.p[2] - t.p[0], normalized(n), length(n))(t.s[0], t.s[1], t.s[2]);
    for (int k = 1; k < 3; ++k) EXPECT_NEAR(dot(g, t.p[k] - t.p[0]), t.s[k] - t.s[0], 1e-9);
    EXPECT_NEAR(dot(g, normalized(n)), 0, kTolerance * length(g));
  }
}

TEST(VertexQuadric, IsTheQuadricToSinglePrecision) {
  Random random(21);
  for (int i = 0; i < 20; ++i) {
    // Of planes near the vertex, as they are at a vertex of a mesh.
    const Vec3d at{random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)};
    Quadric exact;
    for (int k = 0; k < 6; ++k) {
      const Vec3d n = normalized(Vec3d{random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)});
      exact.add_linear(n, -dot(n, at) + random.uniform(-0.01, 0.01), random.uniform(0, 1));
    }
    exact.weight = 3;
    const Quadric back = VertexQuadric(exact, at).around_origin(at);
    EXPECT_FLOAT_EQ(static_cast<float>(back.weight), 3.0f);
    const Vec3d p = at + Vec3d{random.uniform(-0.02, 0.02), random.uniform(-0.02, 0.02), 0.01};
    EXPECT_NEAR(back.value(p), exact.value(p), 1e-9);  // 10⁻⁷ of weights times squared distances
  }
}

TEST(VertexQuadric, AddsWhatIsAFunctionOfTheWayFromItsVertex) {
  const Vec3d at{0.5, -0.25, 2};
  Quadric plane;
  plane.weight = 2;
  plane.add_linear({0, 0, 1}, 0, 2);
  VertexQuadric sum;
  sum.add_scaled(plane, 3);
  const Quadric q = sum.around_origin(at);
  EXPECT_NEAR(q.value(at), 0, 1e-12);
  EXPECT_NEAR(q.value(at + Vec3d{7, 8, 0.5}), 3 * 2 * 0.25, 1e-12);
  EXPECT_EQ(q.weight, 2);
}

TEST(AttributeQuadric, ReducedIsTheLeastErrorOverTheValue) {
  Random random(4);
  for (int trial = 0; trial < 5; ++trial) {
    const auto triangles = random_triangles(random, 6);
    std::vector<double> value;
    Quadric q = attribute_quadric(triangles, value);
    reduce(q, value.data(), 1);
    for (int i = 0; i < 5; ++i) {
      const Vec3d p = random_point(random);
      const double expected = oracle::least_attribute_error(triangles, p);
      EXPECT_NEAR(q.value(p), expected, 1e-7 * (1 + expected));
      EXPECT_NEAR(oracle::attribute_error(triangles, p, fitted_value(value.data(), 1, 0, p)), expected,
                  1e-7 * (1 + expected));
    }
  }
}

TEST(AttributeQuadric, HeldIsTheErrorOfThatValue) {
  Random random(5);
  for (int trial = 0; trial < 5; ++trial) {
    const auto triangles = random_triangles(random, 6);
    std::vector<double> value;
    Quadric q = attribute_quadric(triangles, value);
    const double s = random.uniform(-2, 2);
    hold(q, value.data(), 1, &s);
    for (int i = 0; i < 5; ++i) {
      const Vec3d p = random_point(random);
      const double expected = oracle::attribute_error(triangles, p, s);
      EXPECT_NEAR(q.value(p), expected, 1e-7 * (1 + expected));
    }
  }
}

TEST(AttributeQuadric, InFloatsLosesAFewHundredThousandths) {
  // Values of a few hundredths and small triangles far from the origin, as in the engine.
  Random random(6);
  for (int trial = 0; trial < 20; ++trial) {
    auto triangles = random_triangles(random, 6);
    for (auto& t : triangles) {
      for (Vec3d& p : t.p) p = p * 0.01 + Vec3d{0.3, -0.4, 0.2};
      for (double& s : t.s) s = 0.03 + 1e-4 * s;
    }
    std::vector<double> value;
    Quadric exact = attribute_quadric(triangles, value), rounded = exact;
    const std::vector<float> floats(value.begin(), value.end());
    reduce(exact, value.data(), 1);
    reduce(rounded, floats.data(), 1);
    const Vec3d p = triangles[0].p[0];
    // 0.03² times the 6e-8 of a float is a distance of 7e-6; slim random triangles magnify it a little.
    EXPECT_LT(std::sqrt(std::abs(exact.value(p) - rounded.value(p)) / value[4]), 3e-5);
  }
}

TEST(AttributeQuadric, IsNotFittedWithoutWeight) {
  Quadric q;
  q.add_point({0, 0, 0}, 1);
  const Quadric before = q;
  const std::vector<double> nothing(attribute_stride(2), 0.0);
  reduce(q, nothing.data(), 2);
  EXPECT_EQ(q.c, before.c);
  EXPECT_EQ(q.xx, before.xx);
}

}  // namespace
}  // namespace fovea
