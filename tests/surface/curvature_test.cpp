#include "fovea/surface/curvature.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "fovea/base/random.h"
#include "oracle/saliency_oracle.h"
#include "support/meshes.h"

namespace fovea {
namespace {

VertexField curvature(const Surface& surface) {
  const Context context;
  return mean_curvature(surface, Adjacency(surface, context), context);
}

Surface scaled(Surface surface, float scale) {
  for (Vec3f& p : surface.positions) p = p * scale;
  return surface;
}

/// A sphere whose points are moved about on it.
Surface shaken_sphere(double by) {
  Surface surface = surface_of(test::icosphere(4));
  Random random(3);
  for (Vec3f& p : surface.positions) {
    const Vec3d shift{random.uniform(-by, by), random.uniform(-by, by), random.uniform(-by, by)};
    p = Vec3f(normalized(Vec3d(p) + shift));
  }
  return surface;
}

TEST(Adjacency, ListsCornersAndNeighborsInOrder) {
  //  2--3     two triangles 0 1 3, 0 3 2, and vertex 4 alone
  //  |/ |
  //  0--1
  Surface surface;
  surface.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}, {5, 5, 5}};
  surface.triangles = {{0, 1, 3}, {0, 3, 2}};
  const Adjacency adjacency(surface, Context());
  const auto list = [](std::span<const std::uint32_t> s) {
    return std::vector<std::uint32_t>(s.begin(), s.end());
  };
  EXPECT_EQ(list(adjacency.corners(0)), (std::vector<std::uint32_t>{0, 3}));
  EXPECT_EQ(list(adjacency.neighbors(0)), (std::vector<std::uint32_t>{1, 2, 3}));
  EXPECT_EQ(list(adjacency.corners(3)), (std::vector<std::uint32_t>{2, 4}));
  EXPECT_EQ(list(adjacency.neighbors(2)), (std::vector<std::uint32_t>{0, 3}));
  EXPECT_TRUE(adjacency.neighbors(4).empty());
  EXPECT_NEAR(diagonal(surface), std::sqrt(2), 1e-12) << "the vertex alone does not count";
  EXPECT_EQ(diagonal(Surface()), 0);
}

TEST(Curvature, EqualsTheFormula) {
  for (const TriMesh& mesh :
       {test::torus(20, 10), test::wavy_grid(14, 10, 0.2), test::open_cylinder(9, 4), test::cube(),
        test::non_manifold_edge(), test::bow_tie(), test::duplicate_faces(), test::sliver_strip(8)}) {
    const Surface surface = surface_of(mesh);
    const VertexField found = curvature(surface), expected = test::taubin_curvature(surface);
    for (std::size_t v = 0; v < found.size(); ++v)
      EXPECT_NEAR(found.values()[v], expected.values()[v], 1e-5 * (1 + std::abs(expected.values()[v])));
  }
}

TEST(Curvature, OfASphereIsOneOverItsRadius) {
  for (const float radius : {1.0f, 7.0f}) {
    const VertexField h = curvature(scaled(surface_of(test::icosphere(4)), radius));
    for (const float x : h.values()) EXPECT_NEAR(-x * radius, 1, 1e-4);
  }
  // Points shaken by a fifth of an edge; 2 N·e / ‖e‖² is exact for any chord, and so is the normal. Positions
  // are floats, and the shortest edge is 0.03.
  const VertexField h = curvature(shaken_sphere(0.015));
  for (const float x : h.values()) EXPECT_NEAR(-x, 1, 2e-4);
}

TEST(Curvature, OfACylinderIsHalfThat) {
  const Surface surface = surface_of(test::open_cylinder(128, 40));
  const VertexField h = curvature(surface);
  int inner = 0;
  for (std::uint32_t v = 0; v < surface.positions.size(); ++v) {
    const double z = surface.position(v).z, low = surface.positions.front().z;
    if (std::abs(z - low - 1) > 0.9) continue;  // a border has triangles on one side only
    // On a grid of right-angled triangles: one over twice the radius when along and around weigh the same,
    // and what the diagonal adds. Taubin's mean over six edges is not the mean over all directions: 0.4 …
    // 0.6.
    EXPECT_NEAR(-h.values()[v], 0.5, 0.1);
    ++inner;
  }
  EXPECT_GT(inner, 1000);
}

TEST(Curvature, OfAPlaneIsNone) {
  const VertexField h = curvature(surface_of(test::grid(9, 7)));
  for (const float x : h.values()) EXPECT_EQ(x, 0);
}

TEST(Curvature, DoesNotDependOnTheFrame) {
  const Surface surface = surface_of(test::torus(40, 20));
  Surface turned = surface;
  const double c = std::cos(0.7), s = std::sin(0.7);
  for (Vec3f& p : turned.positions) {
    const Vec3d q(p);
    p = Vec3f(Vec3d{c * q.x - s * q.y, s * q.x + c * q.y, q.z} + Vec3d{1, -2, 3});
  }
  const VertexField a = curvature(surface), b = curvature(turned), half = curvature(scaled(surface, 2));
  for (std::size_t v = 0; v < a.size(); ++v) {
    // Positions are floats: their rounding over the square of an edge of 0.15.
    EXPECT_NEAR(a.values()[v], b.values()[v], 1e-4);
    EXPECT_NEAR(a.values()[v], 2 * half.values()[v], 1e-6);
  }
}

TEST(Curvature, OfWhatIsNoSurfaceIsANumber) {
  for (const test::NamedMesh& named : test::all_families()) {
    const Surface surface = surface_of(named.mesh);
    const Context context;
    const Adjacency adjacency(surface, context);
    const VertexField h = mean_curvature(surface, adjacency, context);
    for (const float x : h.values()) EXPECT_TRUE(std::isfinite(x)) << named.name;
    const VertexField areas = vertex_areas(surface, adjacency, context);
    double area = 0;
    for (const auto& t : surface.triangles) {
      const Vec3d p = surface.position(t[0]);
      area += length(cross(surface.position(t[1]) - p, surface.position(t[2]) - p)) / 2;
    }
    EXPECT_NEAR(std::accumulate(areas.values().begin(), areas.values().end(), 0.0), area, 1e-5 * area)
        << named.name;
  }
}

}  // namespace
}  // namespace fovea
