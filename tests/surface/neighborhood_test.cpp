#include "fovea/surface/neighborhood.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "fovea/base/error.h"
#include "fovea/base/random.h"
#include "oracle/geodesic_oracle.h"
#include "oracle/saliency_oracle.h"
#include "support/meshes.h"

namespace fovea {
namespace {

std::vector<VertexField> averages(const Surface& surface, const VertexField& field,
                                  std::vector<double> sigmas, double cutoff, DistanceKind kind,
                                  int threads = 1) {
  Context context;
  context.threads = threads;
  return gaussian_averages(surface, Adjacency(surface, context), field, sigmas, cutoff, kind, context);
}

VertexField noise(std::size_t count) {
  Random random(8);
  VertexField field(count);
  for (float& x : field.values()) x = static_cast<float>(random.uniform(-1, 1));
  return field;
}

constexpr DistanceKind kKinds[] = {DistanceKind::euclidean, DistanceKind::geodesic, DistanceKind::diffusion};

TEST(Neighborhood, EuclideanEqualsTheFormula) {
  const Surface surface = surface_of(test::torus(24, 12));
  const VertexField field = noise(surface.positions.size());
  const auto results = averages(surface, field, {0.1, 0.25, 0.6}, 2, DistanceKind::euclidean);
  const auto distance = [&](std::uint32_t a, std::uint32_t b) {
    return length(surface.position(a) - surface.position(b));
  };
  const double sigmas[] = {0.1, 0.25, 0.6};
  for (std::size_t i = 0; i < 3; ++i) {
    const VertexField expected = test::gaussian_average(field, sigmas[i], 2, distance);
    for (std::size_t v = 0; v < field.size(); ++v)
      EXPECT_NEAR(results[i].values()[v], expected.values()[v], 1e-6) << i << " " << v;
  }
}

TEST(Neighborhood, GeodesicEqualsTheFormula) {
  const Surface surface = surface_of(test::icosphere(1));
  const VertexField field = noise(surface.positions.size());
  const auto all = test::all_geodesics(surface, 1.3);
  const auto results = averages(surface, field, {0.35, 0.6}, 2, DistanceKind::geodesic);
  const double sigmas[] = {0.35, 0.6};
  for (std::size_t i = 0; i < 2; ++i) {
    const VertexField expected = test::gaussian_average(
        field, sigmas[i], 2, [&](std::uint32_t a, std::uint32_t b) { return all[a][b]; });
    for (std::size_t v = 0; v < field.size(); ++v)
      EXPECT_NEAR(results[i].values()[v], expected.values()[v], 1e-6) << i << " " << v;
  }
}

TEST(Neighborhood, HeatFlowGivesNearlyTheSameOnAnEvenSurface) {
  // A smooth field of height 2, widths of several edges: what differs are terms of the next order, and that
  // one Gaussian ends at the cutoff and the other fades. A twentieth of the height.
  const Surface surface = surface_of(test::icosphere(4));
  VertexField field(surface.positions.size());
  for (std::uint32_t v = 0; v < field.size(); ++v) {
    const Vec3d p = surface.position(v);
    field.values()[v] = static_cast<float>(std::sin(5 * p.x) * std::cos(4 * p.y) + p.z);
  }
  for (const double cutoff : {1.0, 2.0}) {
    const auto exact = averages(surface, field, {0.1, 0.2}, cutoff, DistanceKind::geodesic),
               flow = averages(surface, field, {0.1, 0.2}, cutoff, DistanceKind::diffusion);
    for (std::size_t i = 0; i < 2; ++i) {
      for (std::size_t v = 0; v < field.size(); ++v)
        EXPECT_NEAR(flow[i].values()[v], exact[i].values()[v], 0.1) << cutoff << " " << i << " " << v;
    }
  }
}

TEST(Neighborhood, ConstantsStayOnEveryMesh) {
  for (const test::NamedMesh& named : test::all_families()) {
    const Surface surface = surface_of(named.mesh);
    const VertexField field(surface.positions.size(), 2.5f);
    const double d = std::max(diagonal(surface), 1e-3);
    for (const DistanceKind kind : kKinds) {
      const auto results = averages(surface, field, {0.05 * d, 0.1 * d}, 2, kind);
      ASSERT_EQ(results.size(), 2u);
      for (const VertexField& result : results) {
        ASSERT_EQ(result.size(), field.size());
        for (const float x : result.values()) EXPECT_NEAR(x, 2.5, 1e-4) << named.name;
      }
    }
  }
}

TEST(Neighborhood, VerticesAloneCountNowhere) {
  Surface surface = surface_of(test::grid(8, 8));
  VertexField field = noise(surface.positions.size());
  std::vector<VertexField> before;
  for (const DistanceKind kind : kKinds) before.push_back(averages(surface, field, {0.2}, 2, kind)[0]);
  surface.positions.push_back({0.5f, 0.5f, 0});
  std::vector<float> values(field.values().begin(), field.values().end());
  values.push_back(1000);
  for (std::size_t k = 0; k < std::size(kKinds); ++k) {
    const VertexField after = averages(surface, VertexField(values), {0.2}, 2, kKinds[k])[0];
    for (std::size_t v = 0; v < field.size(); ++v) EXPECT_EQ(after.values()[v], before[k].values()[v]);
    EXPECT_EQ(after.values()[field.size()], 1000);
  }
}

TEST(Neighborhood, TheSameBitsForAnyNumberOfThreads) {
  const Surface surface = surface_of(test::icosphere(5));
  const VertexField field = noise(surface.positions.size());
  for (const DistanceKind kind : kKinds)
    EXPECT_EQ(averages(surface, field, {0.03, 0.06}, 2, kind, 1),
              averages(surface, field, {0.03, 0.06}, 2, kind, 3));
}

TEST(Neighborhood, WidthsMustRiseFromAboveZero) {
  const Surface surface = surface_of(test::grid(2, 2));
  const VertexField field(9);
  for (const std::vector<double>& wrong : {std::vector<double>{}, {0.0, 1.0}, {2.0, 1.0}, {-1.0}})
    EXPECT_THROW(averages(surface, field, wrong, 2, DistanceKind::euclidean), Error);
  EXPECT_THROW(averages(surface, field, {1}, 0, DistanceKind::euclidean), Error);
}

}  // namespace
}  // namespace fovea
