#include "fovea/render/view.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "fovea/base/random.h"

namespace fovea {
namespace {

ViewOptions views_of(ViewSet set) {
  ViewOptions options;
  options.set = set;
  options.count = 17;
  return options;
}

constexpr ViewSet kSolids[] = {ViewSet::tetrahedron,  ViewSet::cube,        ViewSet::octahedron,
                               ViewSet::dodecahedron, ViewSet::icosahedron, ViewSet::rhombicuboctahedron};

TEST(View, SolidsHaveTheirVertices) {
  const std::size_t counts[] = {4, 8, 6, 20, 12, 24};
  for (std::size_t i = 0; i < 6; ++i) EXPECT_EQ(directions(views_of(kSolids[i])).size(), counts[i]);
}

TEST(View, VerticesOfASolidAreAllAlike) {
  // On a vertex-transitive solid the sorted distances to the other vertices are the same from each.
  for (const ViewSet set : kSolids) {
    const std::vector<Vec3d> points = directions(views_of(set));
    std::vector<double> expected;
    for (const Vec3d& p : points) {
      EXPECT_NEAR(length(p), 1, 1e-12);
      std::vector<double> distances;
      for (const Vec3d& q : points) distances.push_back(length(p - q));
      std::sort(distances.begin(), distances.end());
      EXPECT_GT(distances[1], 0.3) << "two directions coincide";
      if (expected.empty()) expected = distances;
      for (std::size_t i = 0; i < distances.size(); ++i) EXPECT_NEAR(distances[i], expected[i], 1e-12);
    }
  }
}

TEST(View, FibonacciPointsAreSpreadEvenly) {
  ViewOptions options = views_of(ViewSet::fibonacci);
  options.count = 400;
  const std::vector<Vec3d> points = directions(options);
  ASSERT_EQ(points.size(), 400u);
  Vec3d mean;
  double closest = 2;
  for (std::size_t i = 0; i < points.size(); ++i) {
    mean += points[i] / 400.0;
    for (std::size_t k = 0; k < i; ++k) closest = std::min(closest, length(points[i] - points[k]));
  }
  EXPECT_LT(length(mean), 0.01);
  // 400 points in a hexagonal pattern would be √(8π / (√3 · 400)) = 0.19 apart.
  EXPECT_GT(closest, 0.13);
}

TEST(View, AnOrbitGoesAroundOnce) {
  ViewOptions options = views_of(ViewSet::orbit);
  options.count = 4;
  options.elevation_deg = 0;
  const std::vector<Vec3d> points = directions(options);
  const Vec3d expected[] = {{0, 0, 1}, {1, 0, 0}, {0, 0, -1}, {-1, 0, 0}};
  for (std::size_t i = 0; i < 4; ++i) EXPECT_LT(length(points[i] - expected[i]), 1e-12);
}

TEST(View, TheSphereJustFitsThePicture) {
  const Sphere sphere{{3, -2, 7}, 2.5};
  Random random(3);
  for (const double fov : {0.0, 30.0, 90.0}) {
    ViewOptions options;
    options.fov_deg = fov;
    for (const View& view : make_views(options, sphere)) {
      double highest = 0;
      for (int i = 0; i < 4000; ++i) {
        const Vec3d d =
            normalized(Vec3d{random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)});
        const Vec3d p = view.to_eye(sphere.center + d * sphere.radius);
        EXPECT_GT(p.z, view.near);
        const double scale = (view.perspective ? p.z : 1) * view.half_height;
        highest = std::max(highest, std::hypot(p.x, p.y) / scale);
      }
      EXPECT_LT(highest, 1 + 1e-6);
      EXPECT_GT(highest, 0.97);  // 4000 random points come that near to the outline
    }
  }
}

TEST(View, LastBitsOfSinesDoNotShow) {
  ViewOptions options;
  options.set = ViewSet::fibonacci;
  options.count = 50;
  for (const View& view : make_views(options, {{0.1, 0.2, 0.3}, 0.7})) {
    for (const Vec3d& v : {view.eye, view.right, view.up, view.back}) {
      for (const double x : {v.x, v.y, v.z}) EXPECT_EQ(x, static_cast<double>(static_cast<float>(x)));
    }
  }
}

TEST(View, AxesAreARightHandedFrame) {
  ViewOptions options = views_of(ViewSet::octahedron);  // looks straight down and up as well
  for (const View& view : make_views(options, {{}, 1})) {
    EXPECT_LT(length(cross(view.right, view.up) - view.back), 1e-6) << view.name;
    EXPECT_NEAR(length(view.right), 1, 1e-6);
    EXPECT_NEAR(dot(view.right, view.up), 0, 1e-6);
    EXPECT_GE(view.up.y, -1e-6) << "upside down";
  }
}

TEST(View, NothingToSeeStillGivesAView) {
  const View view = view_onto({}, {0, 0, 1}, 30, 0);
  EXPECT_TRUE(std::isfinite(view.eye.z));
  EXPECT_GT(view.half_height, 0);
}

}  // namespace
}  // namespace fovea
