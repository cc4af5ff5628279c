#include "fovea/surface/spectral_filter.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "fovea/base/random.h"
#include "fovea/surface/curvature.h"
#include "support/meshes.h"

namespace fovea {
namespace {

/// A Gaussian that hardly ends, exp(−½ σ² λ) on any surface.
Response wide(double sigma) { return gaussian_response(sigma, 6); }

VertexField spread(const Surface& surface, const VertexField& field, double sigma, int threads = 1) {
  Context context;
  context.threads = threads;
  const Adjacency adjacency(surface, context);
  const Response average = wide(sigma);
  return SpectralFilter(surface, adjacency, context).run({&field, 1}, {&average, 1}, context)[0][0];
}

/// The response at an eigenvalue, from its series up to 10⁴.
double value_at(const Response& response, double eigenvalue) {
  constexpr double kGreatest = 1e4;
  const std::vector<double> series = response(kGreatest);
  double sum = 0;
  for (std::size_t k = 0; k < series.size(); ++k)
    sum += series[k] * std::cos(static_cast<double>(k) * std::acos(2 * eigenvalue / kGreatest - 1));
  return sum;
}

VertexField white_noise(std::size_t count) {
  Random random(5);
  VertexField field(count);
  for (float& x : field.values()) x = static_cast<float>(random.uniform(-1, 1));
  return field;
}

TEST(SpectralFilter, OnAPlaneAPointBecomesAGaussian) {
  const Surface surface = surface_of(test::grid(100, 100));
  const std::uint32_t middle = 50 * 101 + 50;
  ASSERT_NEAR(surface.position(middle).x, 0.5, 1e-6);
  VertexField field(surface.positions.size());
  field.values()[middle] = 1;
  const double sigma = 0.06;
  const VertexField after = spread(surface, field, sigma);
  const double peak = 1e-4 / (2 * 3.14159265 * sigma * sigma);  // of one vertex's area
  for (std::uint32_t v = 0; v < surface.positions.size(); ++v) {
    const double r = length(surface.position(v) - surface.position(middle));
    // Six vertices to a width: the lattice is not a plane by some hundredths of the peak.
    EXPECT_NEAR(after.values()[v], peak * std::exp(-r * r / (2 * sigma * sigma)), 0.02 * peak) << r;
  }
}

TEST(SpectralFilter, KeepsConstantsAndBounds) {
  for (const test::NamedMesh& named : test::all_families()) {
    const Surface surface = surface_of(named.mesh);
    const std::size_t count = surface.positions.size();
    const double sigma = 0.14 * diagonal(surface);
    const VertexField even = spread(surface, VertexField(count, 3.0f), sigma);
    for (const float x : even.values()) EXPECT_NEAR(x, 3, 1e-4) << named.name;
    const VertexField before = white_noise(count), after = spread(surface, before, sigma);
    for (const float x : after.values()) EXPECT_LE(std::abs(x), 1 + 1e-4) << named.name;
  }
}

TEST(SpectralFilter, OnASphereHarmonicsFadeAtTheirRate) {
  // x, y, z are eigenfunctions of the Laplacian with eigenvalue −2. Of an icosphere with edges of 0.07 it is
  // less by about their square: some thousandths where σ is 1.2.
  const Surface surface = surface_of(test::icosphere(4));
  VertexField field(surface.positions.size());
  for (std::uint32_t v = 0; v < field.size(); ++v) field.values()[v] = surface.positions[v].z;
  for (const double sigma : {0.15, 0.5, 1.2}) {
    const VertexField after = spread(surface, field, sigma);
    for (std::uint32_t v = 0; v < field.size(); ++v)
      EXPECT_NEAR(after.values()[v], std::exp(-sigma * sigma) * surface.positions[v].z, 0.002);
  }
}

TEST(SpectralFilter, ResponsesShareTerms) {
  const Surface surface = surface_of(test::torus(40, 24));
  Context context;
  const Adjacency adjacency(surface, context);
  const SpectralFilter filter(surface, adjacency, context);
  const VertexField field = white_noise(surface.positions.size());
  const double sigmas[] = {0.09, 0.045, 0.2};
  const Response responses[] = {wide(sigmas[0]), wide(sigmas[1]), wide(sigmas[2])};
  const auto all = filter.run({&field, 1}, responses, context)[0];
  for (std::size_t i = 0; i < 3; ++i) {  // whatever the series are cut off for
    const VertexField alone = spread(surface, field, sigmas[i], 3);
    for (std::size_t v = 0; v < field.size(); ++v)
      EXPECT_NEAR(all[i].values()[v], alone.values()[v], 2e-5);  // what the series leaves out
  }
  EXPECT_EQ(spread(surface, field, 0.2, 1), spread(surface, field, 0.2, 3));
}

TEST(SpectralFilter, OnAPlaneAWaveKeepsItsResponse) {
  // cos(kx) under the average over a disc is itself times the response to k². Away from the border, on a grid
  // of eight vertices to the shortest wave: the lattice is not a plane by some hundredths.
  const Surface surface = surface_of(test::grid(100, 100));
  for (const double wave_number : {20.0, 40.0, 75.0}) {
    VertexField field(surface.positions.size());
    for (std::uint32_t v = 0; v < field.size(); ++v)
      field.values()[v] = static_cast<float>(std::cos(wave_number * surface.position(v).x));
    for (const double cutoff : {1.0, 2.0}) {
      const Context context;
      const Adjacency adjacency(surface, context);
      const Response average = gaussian_response(0.04, cutoff);
      const VertexField found =
          SpectralFilter(surface, adjacency, context).run({&field, 1}, {&average, 1}, context)[0][0];
      const double response = value_at(average, wave_number * wave_number);
      for (std::uint32_t v = 0; v < field.size(); ++v) {
        const Vec3d p = surface.position(v);
        if (std::max(std::abs(p.x - 0.5), std::abs(p.y - 0.5)) > 0.4) continue;
        EXPECT_NEAR(found.values()[v], response * static_cast<double>(field.values()[v]), 0.03);
      }
    }
  }
}

TEST(SpectralFilter, ResponsesAreTheirFormulas) {
  // The integral over the disc, by its words.
  const auto transform = [](double sigma, double cutoff, double eigenvalue) {
    constexpr int kSteps = 4000;
    double sum = 0, weights = 0;
    for (int i = 0; i < kSteps; ++i) {
      const double r = cutoff * sigma * (i + 0.5) / kSteps, w = r * std::exp(-r * r / (2 * sigma * sigma));
      sum += w * std::cyl_bessel_j(0.0, std::sqrt(eigenvalue) * r);
      weights += w;
    }
    return sum / weights;
  };
  for (const double eigenvalue : {0.0, 3.0, 100.0, 2500.0, 9999.0}) {
    for (const double cutoff : {1.0, 2.0, 3.0})
      EXPECT_NEAR(value_at(gaussian_response(0.1, cutoff), eigenvalue), transform(0.1, cutoff, eigenvalue),
                  1e-4)
          << cutoff << " " << eigenvalue;  // rings are a two hundredth of the radius apart
  }
  // A Gaussian that hardly ends transforms to one.
  for (const double eigenvalue : {10.0, 100.0, 400.0})
    EXPECT_NEAR(value_at(wide(0.1), eigenvalue), std::exp(-eigenvalue * 0.005), 1e-3);
}

TEST(SpectralFilter, FieldsTogetherAreAsEachAlone) {
  const Surface surface = surface_of(test::torus(40, 24));
  const Context context;
  const SpectralFilter filter(surface, Adjacency(surface, context), context);
  std::vector<VertexField> fields;
  for (int i = 0; i < 6; ++i) {
    fields.push_back(white_noise(surface.positions.size()));
    for (float& x : fields.back().values()) x = x * static_cast<float>(i + 1) + 1;
  }
  const Response responses[] = {wide(0.045), gaussian_response(0.1, 2)};
  const auto together = filter.run(fields, responses, context);
  ASSERT_EQ(together.size(), fields.size());
  for (std::size_t i = 0; i < fields.size(); ++i)
    EXPECT_EQ(together[i], filter.run({&fields[i], 1}, responses, context)[0]) << i;
}

}  // namespace
}  // namespace fovea
