#include "fovea/lod/lod_chain_screen.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

namespace fovea {
namespace {

/// Half its height is as long as it is far away, so that a pixel is 0.002 of the distance.
LodScreen square_angle() {
  LodScreen screen;
  screen.fov_deg = 90;
  screen.width = 2000;
  screen.height = 1000;
  return screen;
}

TEST(LodScreen, CoverageIsRadiusOverHalfTheHeight) {
  const LodScreen screen = square_angle();
  EXPECT_NEAR(coverage_at(4, 2, screen), 0.5, 1e-12);
  EXPECT_NEAR(distance_at(0.5, 2, screen), 4, 1e-12);
  EXPECT_NEAR(coverage_at(1, 2, screen), 2, 1e-12);
  // At 60 degrees half the height is tan 30° of the distance.
  EXPECT_NEAR(distance_at(0.5, 1, LodScreen{}), 2 * std::sqrt(3.0), 1e-12);
}

TEST(LodScreen, LengthsCountAtTheNearSideOfTheSphere) {
  const LodScreen screen = square_angle();
  // Twelve away, the near side is ten away, where a pixel is 0.02 long.
  EXPECT_NEAR(pixels_at(12, 0.01, 2, screen), 0.5, 1e-12);
  EXPECT_NEAR(length_at(12, 2, screen), 0.02, 1e-12);
  EXPECT_NEAR(switch_distance(0.02, 2, screen), 12, 1e-12);
  EXPECT_EQ(pixels_at(1, 0.01, 2, screen), std::numeric_limits<double>::infinity());
  EXPECT_EQ(pixels_at(1, 0, 2, screen), 0);
  EXPECT_EQ(length_at(1, 2, screen), 0);
  EXPECT_EQ(switch_distance(0, 2, screen), 2);
}

TEST(LodScreen, AllowedPixelsScaleLengths) {
  LodScreen screen = square_angle();
  screen.pixel_error = 4;
  EXPECT_NEAR(length_at(12, 2, screen), 0.08, 1e-12);
  EXPECT_NEAR(switch_distance(0.08, 2, screen), 12, 1e-12);
  EXPECT_NEAR(pixels_at(12, 0.08, 2, screen), 4, 1e-12) << "pixels are pixels, whatever is allowed";
}

TEST(LodScreen, AreaIsThatOfADisc) {
  const LodScreen screen = square_angle();
  // A disc of 500 pixels across on 2000 × 1000.
  EXPECT_NEAR(area_of(0.5, screen), std::numbers::pi / 4 * 500 * 500 / 2e6, 1e-12);
  EXPECT_EQ(area_of(4, screen), 1);
  EXPECT_EQ(area_of(0, screen), 0);
}

}  // namespace
}  // namespace fovea
