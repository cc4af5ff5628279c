#include "fovea/saliency/viewing.h"

#include <gtest/gtest.h>

#include <cmath>

#include "support/meshes.h"

namespace fovea {
namespace {

VertexField seen(const Surface& surface, const ViewRing& ring = {}, int threads = 1) {
  Context context;
  context.threads = threads;
  return visibility(surface, Adjacency(surface, context), ring, context);
}

/// Mean over a ring at an elevation of max(0, cos) between a normal at `height_deg` and the line of sight.
double expected(double height_deg, const ViewRing& ring) {
  const double h = height_deg * M_PI / 180, e = ring.elevation_deg * M_PI / 180;
  double sum = 0;
  for (int i = 0; i < ring.count; ++i) {
    const double angle = 2 * M_PI * i / static_cast<double>(ring.count);
    sum += std::max(0.0, std::cos(h) * std::cos(e) * std::cos(angle) + std::sin(h) * std::sin(e));
  }
  return sum / static_cast<double>(ring.count);
}

TEST(Visibility, OfASphereIsTheMeanCosine) {
  const Surface surface = surface_of(test::icosphere(4));
  ViewRing ring;
  ring.count = 90;
  const VertexField found = seen(surface, ring);
  for (std::uint32_t v = 0; v < surface.positions.size(); ++v) {
    const double height = std::asin(surface.position(v).y) * 180 / M_PI;
    // Vertices on the rim of a view are decided by a pixel of a hundredth of the radius.
    EXPECT_NEAR(found.values()[v], expected(height, ring), 0.01) << height;
  }
}

TEST(Visibility, WhatIsBehindIsNotSeen) {
  // A small ball inside a large one.
  Surface surface = surface_of(test::icosphere(3));
  const Surface inner = surface;
  const auto count = static_cast<std::uint32_t>(surface.positions.size());
  for (const Vec3f& p : inner.positions) surface.positions.push_back(p * 0.5f);
  for (auto t : inner.triangles) {
    for (std::uint32_t& v : t) v += count;
    surface.triangles.push_back(t);
  }
  const VertexField found = seen(surface);
  for (std::uint32_t v = count; v < 2 * count; ++v) EXPECT_EQ(found.values()[v], 0);
  EXPECT_GT(found.values()[0], 0);
}

TEST(Visibility, TurnsWithTheUprightAxis) {
  const Surface surface = surface_of(test::torus(40, 24));
  const VertexField upright = seen(surface);
  // The same shape lying: (x, y, z) -> (z, x, y) takes y to z.
  Surface lying = surface;
  for (Vec3f& p : lying.positions) p = {p.z, p.x, p.y};
  ViewRing ring;
  ring.up = UpAxis::z;
  const VertexField found = seen(lying, ring);
  double worst = 0, sum = 0;
  for (std::size_t v = 0; v < found.size(); ++v) {
    worst = std::max<double>(worst, std::abs(found.values()[v] - upright.values()[v]));
    sum += std::abs(found.values()[v] - upright.values()[v]);
  }
  // The ring begins elsewhere, a quarter turn on: the same twelve places.
  EXPECT_LT(sum / static_cast<double>(found.size()), 1e-3);
  EXPECT_LT(worst, 0.1);
}

TEST(Visibility, DoesNotDependOnThreadsOrStrayVertices) {
  Surface surface = surface_of(test::torus(40, 24));
  const VertexField one = seen(surface, {}, 1);
  EXPECT_EQ(one, seen(surface, {}, 3));
  surface.positions.push_back({1000, 1000, 1000});
  const VertexField stray = seen(surface);
  for (std::size_t v = 0; v < one.size(); ++v) EXPECT_EQ(stray.values()[v], one.values()[v]);
  EXPECT_EQ(stray.values()[one.size()], 0);
}

TEST(Visibility, IsANumberOnEveryMesh) {
  for (const test::NamedMesh& named : test::all_families()) {
    const VertexField found = seen(surface_of(named.mesh));
    for (const float x : found.values()) EXPECT_TRUE(x >= 0 && x <= 1) << named.name;
  }
}

}  // namespace
}  // namespace fovea
