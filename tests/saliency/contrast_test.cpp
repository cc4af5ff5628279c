#include "fovea/saliency/contrast.h"

#include <gtest/gtest.h>

#include <cmath>

#include "fovea/base/random.h"
#include "oracle/saliency_oracle.h"
#include "support/meshes.h"

namespace fovea {
namespace {

VertexField noise(std::size_t count, std::uint64_t seed) {
  Random random(seed);
  VertexField field(count);
  for (float& x : field.values()) x = static_cast<float>(random.uniform(3, 8));
  return field;
}

TEST(CenterSurround, EqualsTheFormula) {
  const Surface surface = surface_of(test::torus(24, 12));
  const std::size_t count = surface.positions.size();
  const VertexField signals[] = {noise(count, 1), noise(count, 2), noise(count, 3)},
                    weights[] = {{}, noise(count, 4), {}};
  // Out of order, and widths that pairs share.
  const ScalePair pairs[] = {{0.2, 0.4}, {0.1, 0.2}, {0.3, 0.25}};
  const auto distance = [&](std::uint32_t a, std::uint32_t b) {
    return length(surface.position(a) - surface.position(b));
  };
  const Context context;
  const auto found = center_surround(surface, Adjacency(surface, context), signals, pairs,
                                     {DistanceKind::euclidean, 2, VertexWeight::one}, context, weights);
  ASSERT_EQ(found.size(), 3u);
  for (std::size_t i = 0; i < 3; ++i) {
    ASSERT_EQ(found[i].size(), 3u);
    for (std::size_t k = 0; k < 3; ++k) {
      const auto average = [&](double sigma) {
        return test::gaussian_average(signals[i], sigma, 2, distance, weights[i]);
      };
      const VertexField center = average(pairs[k].center), surround = average(pairs[k].surround);
      for (std::size_t v = 0; v < count; ++v)
        EXPECT_NEAR(found[i][k].values()[v], std::abs(center.values()[v] - surround.values()[v]), 1e-5)
            << i << " " << k;
    }
  }
}

TEST(PromotePeaks, MultipliesByWhatTheHighestPeakIsAboveTheOthers) {
  //  A strip of five squares; peaks of height 1, 0.5 and 0.25 on its lower side.
  const Surface surface = surface_of(test::grid(6, 1));
  VertexField field(14, 0.0f);
  field.values()[0] = 2;
  field.values()[2] = 1;
  field.values()[5] = 0.5f;
  const Adjacency adjacency(surface, Context());
  const VertexField promoted = promote_peaks(field, adjacency);
  const double factor = (1 - 0.375) * (1 - 0.375);  // the others: 0.5 and 0.25
  EXPECT_NEAR(promoted.values()[0], factor, 1e-6);
  EXPECT_NEAR(promoted.values()[2], 0.5 * factor, 1e-6);
  EXPECT_NEAR(promoted.values()[5], 0.25 * factor, 1e-6);
  EXPECT_EQ(promoted.values()[13], 0);
}

TEST(PromotePeaks, OnePeakStaysAndNoneIsNothing) {
  const Surface surface = surface_of(test::grid(6, 1));
  const Adjacency adjacency(surface, Context());
  VertexField field(14, 1.0f);
  const VertexField even = promote_peaks(field, adjacency);
  for (const float x : even.values()) EXPECT_EQ(x, 0);
  field.values()[3] = 5;
  EXPECT_EQ(promote_peaks(field, adjacency).values()[3], 1);
  EXPECT_TRUE(promote_peaks(VertexField(), Adjacency(Surface(), Context())).empty());
}

TEST(PromotePeaks, EqualsTheWords) {
  const Surface surface = surface_of(test::icosphere(3));
  const VertexField field = noise(surface.positions.size(), 2);
  const VertexField promoted = promote_peaks(field, Adjacency(surface, Context())),
                    expected = test::promoted(field, surface);
  for (std::size_t v = 0; v < field.size(); ++v)
    EXPECT_NEAR(promoted.values()[v], expected.values()[v], 1e-6);
}

}  // namespace
}  // namespace fovea
