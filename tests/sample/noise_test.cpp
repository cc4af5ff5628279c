#include "fovea/sample/noise.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "fovea/base/random.h"

namespace fovea::sample {
namespace {

Vec3d random_point(Random& random) {
  return {random.uniform(-50, 50), random.uniform(-50, 50), random.uniform(-50, 50)};
}

TEST(GradientNoise, IsZeroOnTheLattice) {
  for (int i = -3; i <= 3; ++i) {
    EXPECT_EQ(gradient_noise(Vec2d{i * 1.0, 2.0 - i}, 1), 0.0);
    EXPECT_EQ(gradient_noise(Vec3d{i * 1.0, 2.0 - i, 5.0}, 1), 0.0);
  }
}

TEST(GradientNoise, StaysInItsRangeAndFillsIt) {
  Random random(1);
  double low = 0, high = 0;
  for (int i = 0; i < 20000; ++i) {
    const Vec3d p = random_point(random);
    const double a = gradient_noise(p, 7), b = gradient_noise(Vec2d{p.x, p.y}, 7);
    low = std::min({low, a, b});
    high = std::max({high, a, b});
  }
  EXPECT_GE(low, -1.1);
  EXPECT_LE(high, 1.1);
  EXPECT_LT(low, -0.6);
  EXPECT_GT(high, 0.6);
}

TEST(GradientNoise, IsContinuousAcrossCells) {
  constexpr double kStep = 1e-7;
  for (double y = 0.05; y < 3; y += 0.31) {
    // The slope of the noise is below 10.
    EXPECT_NEAR(gradient_noise(Vec2d{1 - kStep, y}, 3), gradient_noise(Vec2d{1 + kStep, y}, 3), 20 * kStep);
    EXPECT_NEAR(gradient_noise(Vec3d{y, 1 - kStep, y}, 3), gradient_noise(Vec3d{y, 1 + kStep, y}, 3),
                20 * kStep);
  }
}

TEST(GradientNoise, SeedsDiffer) {
  EXPECT_NE(gradient_noise(Vec2d{0.3, 0.4}, 1), gradient_noise(Vec2d{0.3, 0.4}, 2));
  EXPECT_EQ(gradient_noise(Vec2d{0.3, 0.4}, 1), gradient_noise(Vec2d{0.3, 0.4}, 1));
}

TEST(FractalNoise, OneOctaveIsTheNoiseAndNoneIsZero) {
  EXPECT_EQ(fractal_noise(Vec2d{0.3, 0.4}, 0, 1), 0.0);
  EXPECT_NE(fractal_noise(Vec2d{0.3, 0.4}, 1, 1), fractal_noise(Vec2d{0.3, 0.4}, 5, 1));
}

TEST(RidgedNoise, IsNotNegativeAndBounded) {
  Random random(2);
  for (int i = 0; i < 2000; ++i) {
    const double x = ridged_noise({random.uniform(-9, 9), random.uniform(-9, 9)}, 8, 3);
    ASSERT_GE(x, 0.0);
    ASSERT_LE(x, 1.0);
  }
}

TEST(CellNoise, NearestBeforeSecondAndBounded) {
  Random random(3);
  for (int i = 0; i < 2000; ++i) {
    const Cell cell = cell_noise({random.uniform(-9, 9), random.uniform(-9, 9)}, 4);
    ASSERT_LE(cell.nearest, cell.second);
    ASSERT_LE(cell.nearest, std::sqrt(2.0)) << "there is a point in the place's own square";
  }
}

}  // namespace
}  // namespace fovea::sample
