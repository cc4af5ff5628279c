#include "fovea/saliency/mesh_saliency.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "fovea/saliency/contrast.h"
#include "oracle/saliency_oracle.h"
#include "support/meshes.h"

namespace fovea {
namespace {

MeshSaliency saliency(const Surface& surface, const MeshSaliencyOptions& options = {}, int threads = 1) {
  Context context;
  context.threads = threads;
  return mesh_saliency(surface, options, context);
}

/// A sphere with bumps all over.
Surface bumpy_sphere(int subdivisions) {
  Surface surface = surface_of(test::icosphere(subdivisions));
  for (Vec3f& p : surface.positions) {
    const Vec3d q(p);
    p = Vec3f(q * (1 + 0.05 * std::sin(7 * q.x) * std::sin(9 * q.y) * std::cos(8 * q.z)));
  }
  return surface;
}

constexpr MeshSaliencyOptions kAll[] = {MeshSaliencyOptions{}, kLeeSaliency, kMunarettiSaliency};

/// Two spheres of radius 1 that nearly touch at the origin; the one at x < 0 comes first.
Surface two_spheres(bool dented) {
  Surface surface = surface_of(test::icosphere(4));
  const std::size_t count = surface.positions.size(), triangles = surface.triangles.size();
  for (std::size_t v = 0; v < count; ++v) {
    Vec3f p = surface.positions[v];
    surface.positions[v] = p + Vec3f{-1.01f, 0, 0};
    if (dented && p.x < -0.9f) p = p * 1.1f;  // a bump towards the first
    surface.positions.push_back(p + Vec3f{1.01f, 0, 0});
  }
  for (std::size_t t = 0; t < triangles; ++t) {
    auto other = surface.triangles[t];
    for (std::uint32_t& v : other) v += static_cast<std::uint32_t>(count);
    surface.triangles.push_back(other);
  }
  return surface;
}

TEST(MeshSaliency, LeeEqualsTheFormulas) {
  const Surface surface = bumpy_sphere(3);
  MeshSaliencyOptions options = kLeeSaliency;
  options.unit_rel = 0.02;  // so that neighbourhoods of this coarse mesh hold more than one vertex
  const MeshSaliency found = saliency(surface, options);
  const VertexField expected = test::lee_saliency(
      found.curvature, surface, 0.02 * diagonal(surface), 2,
      [&](std::uint32_t a, std::uint32_t b) { return length(surface.position(a) - surface.position(b)); });
  ASSERT_EQ(found.contrasts.size(), 5u);
  for (std::size_t v = 0; v < expected.size(); ++v)
    EXPECT_NEAR(found.saliency.values()[v], expected.values()[v], 1e-4);
}

TEST(MeshSaliency, FollowsTheShapeAndNotItsFrame) {
  const Surface surface = bumpy_sphere(4);
  Surface moved = surface;
  for (Vec3f& p : moved.positions) {
    const Vec3d q(p);
    p = Vec3f(Vec3d{q.y, q.z, q.x} * 64.0 + Vec3d{100, 0, -50});
  }
  for (const MeshSaliencyOptions& options : kAll) {
    const VertexField a = saliency(surface, options).saliency, b = saliency(moved, options).saliency;
    double worst = 0, highest = 0;
    for (std::size_t v = 0; v < a.size(); ++v) {
      worst = std::max<double>(worst, std::abs(a.values()[v] - b.values()[v]));
      highest = std::max<double>(highest, a.values()[v]);
    }
    // Floats lose seven bits beside 100; a local maximum more or less changes the factor of a scale.
    EXPECT_LT(worst, 0.05 * highest);
  }
}

TEST(MeshSaliency, ABumpStandsOut) {
  // A sheet with one bump of about four squares in its middle.
  Surface surface = surface_of(test::grid(60, 60));
  for (Vec3f& p : surface.positions) {
    const float x = p.x - 0.5f, y = p.y - 0.5f;
    p.z = 0.02f * std::exp(-(x * x + y * y) / (2 * 0.03f * 0.03f));
  }
  for (MeshSaliencyOptions options : kAll) {
    options.unit_rel = 0.008;
    const VertexField s = saliency(surface, options).saliency;
    const auto highest = static_cast<std::uint32_t>(std::max_element(s.values().begin(), s.values().end()) -
                                                    s.values().begin());
    const Vec3d at = surface.position(highest);
    EXPECT_LT(std::hypot(at.x - 0.5, at.y - 0.5), 0.04);
    for (std::uint32_t v = 0; v < s.size(); ++v) {
      const Vec3d p = surface.position(v);
      if (std::hypot(p.x - 0.5, p.y - 0.5) < 0.35) continue;
      EXPECT_LT(s.values()[v], 0.02 * s.values()[highest]);
    }
  }
}

TEST(MeshSaliency, OverTheSurfaceANeighborDoesNotMatter) {
  // Munaretti 2007, figure 3.4: a bump on one sphere changes what is salient on its touching neighbour if
  // distances are straight, and leaves it alone if they run over the surface.
  const Surface plain = two_spheres(false), dented = two_spheres(true);
  const auto change = [&](DistanceKind kind) {
    const Context context;
    const double unit = 0.003 * diagonal(plain);
    double most = 0;
    const auto contrasts = [&](const Surface& surface) {
      const Adjacency adjacency(surface, context);
      const VertexField h = mesh_saliency(surface, {}, context).curvature;
      const ScalePair pairs[] = {{6 * unit, 12 * unit}};
      return center_surround(surface, adjacency, {&h, 1}, pairs, {kind, 2, VertexWeight::one}, context)[0][0];
    };
    const VertexField a = contrasts(plain), b = contrasts(dented);
    for (std::size_t v = 0; v < plain.positions.size() / 2; ++v)
      most = std::max<double>(most, std::abs(a.values()[v] - b.values()[v]));
    return most;
  };
  EXPECT_GT(change(DistanceKind::euclidean), 0.01);
  EXPECT_EQ(change(DistanceKind::geodesic), 0);
}

TEST(MeshSaliency, IsANumberOnEveryMesh) {
  for (const test::NamedMesh& named : test::all_families()) {
    const Surface surface = surface_of(named.mesh);
    for (const MeshSaliencyOptions& options : kAll) {
      const VertexField s = saliency(surface, options).saliency;
      ASSERT_EQ(s.size(), surface.positions.size()) << named.name;
      for (const float x : s.values()) EXPECT_TRUE(std::isfinite(x) && x >= 0) << named.name;
    }
  }
}

TEST(MeshSaliency, TheSameBitsForAnyNumberOfThreads) {
  const Surface surface = bumpy_sphere(5);
  for (const MeshSaliencyOptions& options : kAll)
    EXPECT_EQ(saliency(surface, options, 1).saliency, saliency(surface, options, 3).saliency);
}

}  // namespace
}  // namespace fovea
