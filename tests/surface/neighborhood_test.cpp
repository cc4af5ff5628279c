#include "fovea/surface/neighborhood.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "fovea/base/error.h"
#include "fovea/base/random.h"
#include "fovea/surface/curvature.h"
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
  return gaussian_averages(surface, Adjacency(surface, context), {&field, 1}, sigmas,
                           {kind, cutoff, VertexWeight::one}, context)[0];
}

VertexField noise(std::size_t count) {
  Random random(8);
  VertexField field(count);
  for (float& x : field.values()) x = static_cast<float>(random.uniform(-1, 1));
  return field;
}

constexpr DistanceKind kKinds[] = {DistanceKind::euclidean, DistanceKind::geodesic, DistanceKind::window,
                                   DistanceKind::diffusion};

/// A sheet whose squares are ten times as wide on one side as on the other.
Surface uneven_sheet(int n) {
  Surface surface = surface_of(test::grid(n, n));
  for (Vec3f& p : surface.positions) {
    p.x = p.x * (0.2f + 0.8f * p.x);
    p.y = p.y * (0.2f + 0.8f * p.y);
  }
  return surface;
}

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

TEST(Neighborhood, ByAreaEqualsTheFormula) {
  const Surface surface = uneven_sheet(20);
  const VertexField field = noise(surface.positions.size());
  const Context context;
  const Adjacency adjacency(surface, context);
  const double sigmas[] = {0.05, 0.1};
  const auto results = gaussian_averages(surface, adjacency, {&field, 1}, sigmas,
                                         {DistanceKind::euclidean, 2, VertexWeight::area}, context)[0];
  const VertexField areas = vertex_areas(surface, adjacency, context);
  const auto distance = [&](std::uint32_t a, std::uint32_t b) {
    return length(surface.position(a) - surface.position(b));
  };
  for (std::size_t i = 0; i < 2; ++i) {
    const VertexField expected = test::gaussian_average(field, sigmas[i], 2, distance, areas);
    for (std::size_t v = 0; v < field.size(); ++v)
      EXPECT_NEAR(results[i].values()[v], expected.values()[v], 1e-6) << i << " " << v;
  }
}

TEST(Neighborhood, GivenWeightsTakeTheirPlace) {
  const Surface surface = uneven_sheet(20);
  const VertexField field = noise(surface.positions.size());
  const Context context;
  const Adjacency adjacency(surface, context);
  const double sigmas[] = {0.05, 0.1};
  for (const DistanceKind kind : kKinds) {
    const auto average = [&](VertexWeight weight, const VertexField& weights) {
      return gaussian_averages(surface, adjacency, {&field, 1}, sigmas, {kind, 2, weight}, context,
                               {&weights, 1});
    };
    const VertexField ones(field.size(), 1.0f);
    EXPECT_EQ(average(VertexWeight::area, ones), average(VertexWeight::one, {}));
    // Each field has its own.
    const VertexField both[] = {field, field}, each[] = {{}, ones};
    const auto together =
        gaussian_averages(surface, adjacency, both, sigmas, {kind, 2, VertexWeight::area}, context, each);
    EXPECT_EQ(together[0], average(VertexWeight::area, {})[0]);
    EXPECT_EQ(together[1], average(VertexWeight::one, {})[0]);
    if (kind == DistanceKind::diffusion) continue;  // it has its own areas where vertices are this uneven
    // Thrice the area is the area, but for rounding.
    VertexField areas = vertex_areas(surface, adjacency, context);
    for (float& a : areas.values()) a *= 3;
    const auto by_area = average(VertexWeight::area, {}), given = average(VertexWeight::one, areas);
    for (std::size_t i = 0; i < 2; ++i) {
      for (std::size_t v = 0; v < field.size(); ++v)
        EXPECT_NEAR(given[0][i].values()[v], by_area[0][i].values()[v], 1e-5);
    }
  }
}

TEST(Neighborhood, WindowEqualsTheWords) {
  // Edges of 0.01 to 0.1: the spheres of 0.04 leave out neighbours on one side and hold dozens on the other.
  const Surface surface = uneven_sheet(20);
  const VertexField field = noise(surface.positions.size());
  const std::vector<double> radii{0.04, 0.06, 0.08, 0.1, 0.2};
  const double falls[] = {1, 1.2, 1.5, 2, 2};
  const auto results = averages(surface, field, radii, 1, DistanceKind::window);
  const auto straight = averages(surface, field, radii, 1, DistanceKind::euclidean);
  for (std::size_t i = 0; i < radii.size(); ++i) {
    const VertexField expected = test::window_average(field, surface, radii[i], falls[i]);
    for (std::size_t v = 0; v < field.size(); ++v)
      EXPECT_NEAR(results[i].values()[v], expected.values()[v], 1e-5) << i << " " << v;
  }
  EXPECT_NE(results[0], straight[0]);
  EXPECT_EQ(results[4], straight[4]);  // no edge leaves the largest sphere
}

TEST(Neighborhood, WindowWithWeightsEqualsTheWords) {
  const Surface surface = uneven_sheet(20);
  const VertexField field = noise(surface.positions.size());
  VertexField weights(field.size());
  for (std::size_t v = 0; v < field.size(); ++v) weights.values()[v] = 1 + static_cast<float>(v % 7);
  const Context context;
  const double radii[] = {0.04, 0.08};
  const double falls[] = {1, 1.2};
  const auto results =
      gaussian_averages(surface, Adjacency(surface, context), {&field, 1}, radii,
                        {DistanceKind::window, 1, VertexWeight::one}, context, {&weights, 1})[0];
  for (std::size_t i = 0; i < 2; ++i) {
    const VertexField expected = test::window_average(field, surface, radii[i], falls[i], weights);
    for (std::size_t v = 0; v < field.size(); ++v)
      EXPECT_NEAR(results[i].values()[v], expected.values()[v], 1e-5) << i << " " << v;
  }
}

TEST(Neighborhood, FieldsTogetherAreAsEachAlone) {
  const Surface surface = uneven_sheet(12);
  const Context context;
  const Adjacency adjacency(surface, context);
  std::vector<VertexField> fields(3, noise(surface.positions.size()));
  for (float& x : fields[1].values()) x = x * x;
  for (float& x : fields[2].values()) x = 1 - x;
  const double sigmas[] = {0.05, 0.1};
  for (const DistanceKind kind : kKinds) {
    for (const VertexWeight weight : {VertexWeight::one, VertexWeight::area}) {
      const Neighborhood around{kind, 2, weight};
      const auto together = gaussian_averages(surface, adjacency, fields, sigmas, around, context);
      for (std::size_t i = 0; i < fields.size(); ++i)
        EXPECT_EQ(together[i],
                  gaussian_averages(surface, adjacency, {&fields[i], 1}, sigmas, around, context)[0]);
    }
  }
}

TEST(Neighborhood, DiffusionCountsVerticesAsTheOthersDo) {
  // Where the mesh is finer on one side, averages over vertices differ from averages over area; diffusion
  // gives either.
  const Surface surface = uneven_sheet(60);
  const Context context;
  const Adjacency adjacency(surface, context);
  VertexField field(surface.positions.size());
  for (std::size_t v = 0; v < field.size(); ++v) field.values()[v] = 10 * surface.positions[v].x;
  const double sigmas[] = {0.06};
  const auto average = [&](DistanceKind kind, VertexWeight weight) {
    return gaussian_averages(surface, adjacency, {&field, 1}, sigmas, {kind, 2, weight}, context)[0][0];
  };
  const auto difference = [&](const VertexField& a, const VertexField& b) {
    double sum = 0;  // but at the border, which heat does not cross and straight averages end at
    for (std::uint32_t v = 0; v < a.size(); ++v) {
      const Vec3d p = surface.position(v);
      if (std::max(std::abs(p.x - 0.5), std::abs(p.y - 0.5)) < 0.35)
        sum += std::abs(a.values()[v] - b.values()[v]);
    }
    return sum;
  };
  for (const VertexWeight weight : {VertexWeight::one, VertexWeight::area}) {
    const VertexWeight other = weight == VertexWeight::one ? VertexWeight::area : VertexWeight::one;
    const VertexField filtered = average(DistanceKind::diffusion, weight);
    EXPECT_LT(difference(filtered, average(DistanceKind::euclidean, weight)),
              0.3 * difference(filtered, average(DistanceKind::euclidean, other)));
  }
}

TEST(Neighborhood, DiffusionEqualsTheFormula) {
  // Uneven, but without obtuse angles: negative cotangents count as 0.
  Surface surface = surface_of(test::icosphere(2));
  for (Vec3f& p : surface.positions) p = p * (1 + 0.1f * p.x + 0.05f * p.y * p.z);
  const VertexField field = noise(surface.positions.size());
  const Context context;
  const Adjacency adjacency(surface, context);
  const double sigmas[] = {0.2, 0.5};
  for (const double cutoff : {1.0, 2.0}) {
    const auto results = gaussian_averages(surface, adjacency, {&field, 1}, sigmas,
                                           {DistanceKind::diffusion, cutoff, VertexWeight::area}, context)[0];
    for (std::size_t i = 0; i < 2; ++i) {
      const VertexField expected = test::spectral_average(field, surface, sigmas[i], cutoff);
      for (std::size_t v = 0; v < field.size(); ++v)
        EXPECT_NEAR(results[i].values()[v], expected.values()[v], 1e-4) << cutoff << " " << i << " " << v;
    }
  }
}

TEST(Neighborhood, DiffusionGivesNearlyTheSameOnAnEvenSurface) {
  // A smooth field of height 2, widths of several edges: what differs is that the sphere is curved, and how
  // few vertices a disc of a few edges holds. A fortieth of the height.
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
        EXPECT_NEAR(flow[i].values()[v], exact[i].values()[v], 0.05) << cutoff << " " << i << " " << v;
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
