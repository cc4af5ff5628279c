#include "fovea/surface/diffusion.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "fovea/base/random.h"
#include "fovea/surface/curvature.h"
#include "support/meshes.h"

namespace fovea {
namespace {

VertexField flow(const Surface& surface, const VertexField& field, double time, int threads = 1) {
  Context context;
  context.threads = threads;
  const Adjacency adjacency(surface, context);
  const double times[] = {time};
  return HeatFlow(surface, adjacency, context).run({&field, 1}, times, context)[0][0];
}

VertexField noise(std::size_t count) {
  Random random(5);
  VertexField field(count);
  for (float& x : field.values()) x = static_cast<float>(random.uniform(-1, 1));
  return field;
}

TEST(HeatFlow, OnAPlaneAPointBecomesAGaussian) {
  const Surface surface = surface_of(test::grid(100, 100));
  const std::uint32_t middle = 50 * 101 + 50;
  ASSERT_NEAR(surface.position(middle).x, 0.5, 1e-6);
  VertexField field(surface.positions.size());
  field.values()[middle] = 1;
  const double sigma = 0.06;
  const VertexField spread = flow(surface, field, sigma * sigma / 2);
  const double peak = 1e-4 / (2 * 3.14159265 * sigma * sigma);  // the heat of one vertex's area
  for (std::uint32_t v = 0; v < surface.positions.size(); ++v) {
    const double r = length(surface.position(v) - surface.position(middle));
    // Six vertices to a width: the lattice is not a plane by some hundredths of the peak.
    EXPECT_NEAR(spread.values()[v], peak * std::exp(-r * r / (2 * sigma * sigma)), 0.02 * peak) << r;
  }
}

TEST(HeatFlow, KeepsConstantsAndBounds) {
  for (const test::NamedMesh& named : test::all_families()) {
    const Surface surface = surface_of(named.mesh);
    const std::size_t count = surface.positions.size();
    const double time = 0.01 * diagonal(surface) * diagonal(surface);
    const VertexField even = flow(surface, VertexField(count, 3.0f), time);
    for (const float x : even.values()) EXPECT_NEAR(x, 3, 1e-4) << named.name;
    const VertexField before = noise(count), after = flow(surface, before, time);
    for (const float x : after.values()) EXPECT_LE(std::abs(x), 1 + 1e-4) << named.name;
  }
}

TEST(HeatFlow, OnASphereHarmonicsFadeAtTheirRate) {
  // x, y, z are eigenfunctions of the Laplacian with eigenvalue −2. Of an icosphere with edges of 0.07 it is
  // less by about their square: some thousandths at time 0.7.
  const Surface surface = surface_of(test::icosphere(4));
  VertexField field(surface.positions.size());
  for (std::uint32_t v = 0; v < field.size(); ++v) field.values()[v] = surface.positions[v].z;
  for (const double time : {0.01, 0.1, 0.7}) {
    const VertexField after = flow(surface, field, time);
    for (std::uint32_t v = 0; v < field.size(); ++v)
      EXPECT_NEAR(after.values()[v], std::exp(-2 * time) * surface.positions[v].z, 0.002);
  }
}

TEST(HeatFlow, TimesAddUp) {
  const Surface surface = surface_of(test::torus(40, 24));
  Context context;
  const Adjacency adjacency(surface, context);
  const HeatFlow heat(surface, adjacency, context);
  const VertexField field = noise(surface.positions.size());
  const double times[] = {0.001, 0.004, 0.02};
  const auto all = heat.run({&field, 1}, times, context)[0];
  for (std::size_t i = 0; i < 3; ++i) {  // whatever the series are cut off for
    const VertexField alone = flow(surface, field, times[i], 3);
    for (std::size_t v = 0; v < field.size(); ++v)
      EXPECT_NEAR(all[i].values()[v], alone.values()[v], 2e-5);  // what the series leaves out
  }
  EXPECT_EQ(flow(surface, field, 0.02, 1), flow(surface, field, 0.02, 3));
}

TEST(HeatFlow, FieldsFlowTogetherAsEachAlone) {
  const Surface surface = surface_of(test::torus(40, 24));
  const Context context;
  const HeatFlow heat(surface, Adjacency(surface, context), context);
  std::vector<VertexField> fields;
  for (int i = 0; i < 6; ++i) {
    fields.push_back(noise(surface.positions.size()));
    for (float& x : fields.back().values()) x = x * static_cast<float>(i + 1) + 1;
  }
  const double times[] = {0.001, 0.01};
  const auto together = heat.run(fields, times, context);
  ASSERT_EQ(together.size(), fields.size());
  for (std::size_t i = 0; i < fields.size(); ++i)
    EXPECT_EQ(together[i], heat.run({&fields[i], 1}, times, context)[0]) << i;
}

}  // namespace
}  // namespace fovea
