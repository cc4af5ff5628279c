#include "fovea/base/math.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <utility>

#include "fovea/base/random.h"

namespace fovea {
namespace {

// Numbers here are of order 1 and go through a few dozen operations.
constexpr double kTolerance = 1e-13;

void expect_near(Vec3d a, Vec3d b) {
  EXPECT_NEAR(a.x, b.x, kTolerance);
  EXPECT_NEAR(a.y, b.y, kTolerance);
  EXPECT_NEAR(a.z, b.z, kTolerance);
}

/// Half a turn has sine 1 at its half: `angle` about z.
Quat about_z(double angle) { return {0, 0, std::sin(angle / 2), std::cos(angle / 2)}; }

Vec3d random_point(Random& random) {
  return {random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)};
}

Mat4 random_affine(Random& random) {
  const Vec3d axis = normalized(random_point(random));
  const double half = random.uniform(0, 3);
  const Quat q{axis.x * std::sin(half), axis.y * std::sin(half), axis.z * std::sin(half), std::cos(half)};
  return compose(random_point(random), q, {random.uniform(0.5, 2), random.uniform(0.5, 2), -1.5});
}

TEST(Vec3, SinglePrecisionIsThatOfEachNumber) {
  Random random(1);
  for (int i = 0; i < 100; ++i) {
    const Vec3d p = random_point(random), q = in_single_precision(p);
    for (const auto& [whole, rounded] : {std::pair{p.x, q.x}, {p.y, q.y}, {p.z, q.z}}) {
      const float single = static_cast<float>(whole);
      EXPECT_EQ(rounded, static_cast<double>(single));
      EXPECT_NE(rounded, whole);  // 53 random bits do not fit
    }
  }
}

TEST(Vec3, CrossIsRightHandedAndOrthogonal) {
  EXPECT_EQ(cross(Vec3d{1, 0, 0}, Vec3d{0, 1, 0}), (Vec3d{0, 0, 1}));
  const Vec3d a{1, 2, 3}, b{-4, 5, 0.5};
  EXPECT_EQ(dot(cross(a, b), a), 0.0);
  EXPECT_EQ(cross(Vec2d{2, 0}, Vec2d{0, 3}), 6.0);
}

TEST(Vec3, NormalizedLeavesZeroAlone) {
  EXPECT_EQ(normalized(Vec3d{0, 0, 0}), (Vec3d{0, 0, 0}));
  EXPECT_EQ(normalized(Vec3d{0, 3, 4}), (Vec3d{0, 0.6, 0.8}));
}

TEST(Mat4, ComposeScalesThenTurnsThenMoves) {
  const Mat4 m = compose({10, 0, 0}, about_z(std::numbers::pi / 2), {2, 3, 4});
  expect_near(transform_point(m, {1, 1, 1}), {10 - 3, 2, 4});
  expect_near(transform_direction(m, {1, 1, 1}), {-3, 2, 4});
  EXPECT_EQ(compose({0, 0, 0}, Quat{}, {1, 1, 1}), Mat4{});
}

TEST(Mat4, ProductAppliesTheRightFactorFirst) {
  Random random(1);
  const Mat4 a = random_affine(random), b = random_affine(random);
  const Vec3d p = random_point(random);
  expect_near(transform_point(a * b, p), transform_point(a, transform_point(b, p)));
}

TEST(Mat4, AffineInverseUndoes) {
  Random random(2);
  for (int i = 0; i < 20; ++i) {
    const Mat4 a = random_affine(random);
    const Vec3d p = random_point(random);
    expect_near(transform_point(affine_inverse(a), transform_point(a, p)), p);
  }
}

TEST(Mat4, DeterminantIsVolumeAndTellsMirrors) {
  EXPECT_NEAR(determinant3(compose({1, 2, 3}, about_z(1.0), {2, 3, 4})), 24.0, 24 * kTolerance);
  EXPECT_LT(determinant3(compose({}, about_z(1.0), {1, -1, 1})), 0.0);
}

TEST(Box, EmptyUntilSomethingIsAdded) {
  Box box;
  EXPECT_TRUE(box.empty());
  EXPECT_EQ(box.diagonal(), 0.0);
  EXPECT_EQ(box.center(), Vec3d{});
  box.add(Box{});
  EXPECT_TRUE(box.empty()) << "an empty box adds nothing";
  box.add({1, 1, 1});
  EXPECT_FALSE(box.empty());
  box.add({-1, 4, 1});
  EXPECT_EQ(box.center(), (Vec3d{0, 2.5, 1}));
  EXPECT_EQ(box.diagonal(), std::sqrt(4.0 + 9.0));
}

}  // namespace
}  // namespace fovea
