#include "fovea/surface/rigid_distance.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "fovea/base/random.h"
#include "oracle/pose_oracle.h"

namespace fovea {
namespace {

std::vector<Vec3d> random_points(std::size_t count, std::uint64_t seed, Vec3d extent) {
  Random random(seed);
  std::vector<Vec3d> points;
  for (std::size_t i = 0; i < count; ++i)
    points.emplace_back(extent.x * random.uniform(-1, 1), extent.y * random.uniform(-1, 1),
                        extent.z * random.uniform(-1, 1));
  return points;
}

std::vector<Vec3d> moved(std::vector<Vec3d> points, const Mat4& motion) {
  for (Vec3d& p : points) p = transform_point(motion, p);
  return points;
}

Mat4 rigid_motion(Random& random) {
  Quat q{random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)};
  const double l = std::sqrt(q.x * q.x + q.y * q.y + q.z * q.z + q.w * q.w);
  q = {q.x / l, q.y / l, q.z / l, q.w / l};
  return compose({random.uniform(-9, 9), random.uniform(-9, 9), random.uniform(-9, 9)}, q, {1, 1, 1});
}

TEST(RigidDistance, DoesNotSeeRigidMotion) {
  Random random(5);
  // In space, in a plane, on a line, and a ball, which has no axis of its own.
  for (const Vec3d extent : {Vec3d{3, 2, 1}, Vec3d{2, 1, 0}, Vec3d{0, 2, 0}, Vec3d{1, 1, 1}}) {
    const std::vector<Vec3d> points = random_points(50, 3, extent);
    for (int i = 0; i < 20; ++i) EXPECT_LT(rigid_distance(points, moved(points, rigid_motion(random))), 1e-6);
  }
}

TEST(RigidDistance, IsWhatIsLeftOfADeformation) {
  // Two points 2 apart against two 5 apart, wherever: each end is 1.5 off.
  const std::vector<Vec3d> a = {{0, 0, 0}, {2, 0, 0}}, b = {{7, 7, 7}, {7, 12, 7}};
  EXPECT_NEAR(rigid_distance(a, b), 1.5, 1e-12);
}

TEST(RigidDistance, AMirrorImageIsAnotherShape) {
  const std::vector<Vec3d> points = random_points(50, 3, {3, 2, 1});
  EXPECT_GT(rigid_distance(points, moved(points, compose({}, {}, {1, 1, -1}))), 0.1);
}

TEST(RigidDistance, EqualsTheOracle) {
  Random random(8);
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    const std::vector<Vec3d> a = random_points(30, seed, {3, 2, 1});
    const std::vector<Vec3d> change = random_points(30, seed + 100, {0.5, 0.5, 0.5});
    std::vector<Vec3d> b = moved(a, rigid_motion(random));
    for (std::size_t i = 0; i < b.size(); ++i) b[i] += change[i];
    EXPECT_NEAR(rigid_distance(a, b), test::rigid_distance(a, b), 1e-9);
    EXPECT_NEAR(rigid_distance(a, b), rigid_distance(b, a), 1e-12);
  }
}

TEST(RigidDistance, FarFromTheOriginNothingIsLost) {
  const std::vector<Vec3d> a = random_points(30, 1, {1, 1, 1}), b = random_points(30, 2, {1, 1, 1});
  const Mat4 far = compose({1e6, -1e6, 1e6}, {}, {1, 1, 1});
  EXPECT_NEAR(rigid_distance(moved(a, far), moved(b, far)), rigid_distance(a, b), 1e-8);
}

TEST(RigidDistance, OfFewPoints) {
  EXPECT_EQ(rigid_distance({}, {}), 0);
  const std::vector<Vec3d> a = {{1, 2, 3}}, b = {{4, 5, 6}};
  EXPECT_EQ(rigid_distance(a, b), 0);
}

}  // namespace
}  // namespace fovea
