#include "fovea/saliency/baseline.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "support/meshes.h"

namespace fovea {
namespace {

/// A tall cone-like thing: a sphere drawn out along one direction, thin at its far end.
Surface drop(Vec3d along) {
  Surface surface = surface_of(test::icosphere(3));
  for (Vec3f& p : surface.positions) {
    const Vec3d q(p);
    const double t = dot(q, along);
    p = Vec3f(q * 0.5 + along * (2 * std::exp(t)) + Vec3d{10, 20, 30});
  }
  return surface;
}

std::uint32_t highest(const VertexField& field) {
  return static_cast<std::uint32_t>(std::max_element(field.values().begin(), field.values().end()) -
                                    field.values().begin());
}

TEST(Baseline, CenterOfASheet) {
  // Nine vertices; the middle has no distance, the corners √½.
  const Surface surface = surface_of(test::grid(2, 2));
  const VertexField near = near_center(surface, {}), far = far_from_center(surface, {});
  for (std::uint32_t v = 0; v < 9; ++v) {
    const Vec3d p = surface.position(v);
    const double distance = std::hypot(p.x - 0.5, p.y - 0.5);
    EXPECT_NEAR(far.values()[v], distance, 1e-6);
    EXPECT_NEAR(near.values()[v], std::sqrt(0.5) - distance, 1e-6);
  }
}

TEST(Baseline, TheMainAxisPointsToTheThinEnd) {
  for (const Vec3d direction : {Vec3d{1, 0, 0}, Vec3d{0, 0, -1}, normalized(Vec3d{1, -2, 3})}) {
    const Surface surface = drop(direction);
    const VertexField axis = along_main_axis(surface, {}), straight = along(surface, direction * 7, {});
    EXPECT_EQ(highest(axis), highest(straight));
    for (std::uint32_t v = 0; v < axis.size(); ++v)
      EXPECT_NEAR(axis.values()[v], straight.values()[v], 0.02);  // the sphere's triangles are not all alike
  }
}

TEST(Baseline, HeightBeginsAtTheLowest) {
  const Surface surface = drop({0, 1, 0});
  const VertexField height = along(surface, {0, 3, 0}, {});
  float low = surface.positions[0].y;
  for (const Vec3f& p : surface.positions) low = std::min(low, p.y);
  for (std::uint32_t v = 0; v < height.size(); ++v)
    EXPECT_NEAR(height.values()[v], surface.positions[v].y - low, 1e-5);
}

TEST(Baseline, VerticesWithoutAreaAreZeroAndCountNowhere) {
  Surface surface = surface_of(test::grid(2, 2));
  const VertexField before = near_center(surface, {});
  surface.positions.push_back({100, 100, 100});
  const VertexField after = near_center(surface, {});
  EXPECT_TRUE(std::equal(before.values().begin(), before.values().end(), after.values().begin()));
  EXPECT_EQ(after.values()[9], 0);
}

TEST(Baseline, IsANumberOnEveryMesh) {
  for (const test::NamedMesh& named : test::all_families()) {
    const Surface surface = surface_of(named.mesh);
    for (const VertexField& field :
         {near_center(surface, {}), far_from_center(surface, {}), along_main_axis(surface, {}),
          along(surface, {0, 1, 0}, {}), along(surface, {}, {})}) {
      ASSERT_EQ(field.size(), surface.positions.size()) << named.name;
      for (const float x : field.values()) EXPECT_TRUE(std::isfinite(x) && x >= 0) << named.name;
    }
  }
}

}  // namespace
}  // namespace fovea
