#include "fovea/sample/height_map.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace fovea::sample {
namespace {

template <class F>
HeightMap map_of(int size, F&& height) {
  HeightMap map(size);
  for (int y = 0; y < size; ++y) {
    for (int x = 0; x < size; ++x) map.at(x, y) = height(x, y);
  }
  return map;
}

TEST(HeightMap, ReadsAPlaneExactlyAwayFromTheRim) {
  const HeightMap map = map_of(11, [](int x, int y) { return 2.0 * x - y; });
  // The cubic reproduces planes; at the rim it lacks a neighbour.
  for (const double x : {0.15, 0.5, 0.83}) {
    EXPECT_NEAR(map.read(x, 0.4), 20 * x - 4, 1e-12);
    EXPECT_NEAR(map.read_linear(x, 0.4), 20 * x - 4, 1e-12);
  }
}

TEST(HeightMap, OutsideIsTheRim) {
  const HeightMap map = map_of(5, [](int x, int y) { return x + 10.0 * y; });
  EXPECT_EQ(map.read(-1, -1), 0.0);
  EXPECT_NEAR(map.read(2, 2), 44.0, 1e-12);
  // The last cell is read just short of its end.
  EXPECT_NEAR(map.read_linear(2, 2), 44.0, 1e-4);
}

TEST(HeightMap, BlurKeepsAConstantAndFlattensAPeak) {
  const HeightMap flat = blur(map_of(9, [](int, int) { return 3.0; }), 2);
  EXPECT_NEAR(flat.at(0, 8), 3.0, 1e-12);
  const HeightMap peak = blur(map_of(21, [](int x, int y) { return x == 10 && y == 10 ? 1.0 : 0.0; }), 2);
  // The square of sides 5, twice: 5 of 25 overlaps in each direction.
  EXPECT_NEAR(peak.at(10, 10), 1.0 / 25, 1e-12);
  EXPECT_NEAR(peak.at(10, 3), 0.0, 1e-12);
}

TEST(HeightMap, AWallCastsItsShadowAwayFromTheSun) {
  const HeightMap map = map_of(101, [](int x, int) { return x == 50 ? 0.2 : 0.0; });
  const HeightMap light = cast_light(map, 1, 0, 1);  // From the east at 45 degrees.
  EXPECT_EQ(light.at(80, 50), 1.0) << "the sunny side";
  EXPECT_EQ(light.at(45, 50), 0.0) << "a wall of 20 cells throws a shadow of 20";
  EXPECT_EQ(light.at(20, 50), 1.0) << "beyond it";
}

TEST(HeightMap, RainCarriesGroundDownhill) {
  HeightMap map = map_of(65, [](int x, int y) {
    return 0.5 - 0.5 * std::hypot(x - 32.0, y - 32.0) / 45 + 0.01 * std::sin(x * 0.9) * std::cos(y * 0.7);
  });
  const double top = map.at(32, 32);
  const HeightMap flow = erode(map, 4000, 1);
  EXPECT_LT(map.at(32, 32), top);
  double most = 0;
  for (int y = 0; y < 65; ++y) {
    for (int x = 0; x < 65; ++x) {
      ASSERT_TRUE(std::isfinite(map.at(x, y)));
      most = std::max(most, flow.at(x, y));
    }
  }
  EXPECT_GT(most, 50.0) << "water gathers in gullies";
}

TEST(HeightMap, MountainsAreSeededAndBounded) {
  const HeightMap a = make_mountains(33, 1), b = make_mountains(33, 2);
  double low = 9, high = -9, difference = 0;
  for (int y = 0; y < 33; ++y) {
    for (int x = 0; x < 33; ++x) {
      low = std::min(low, a.at(x, y));
      high = std::max(high, a.at(x, y));
      difference = std::max(difference, std::abs(a.at(x, y) - b.at(x, y)));
    }
  }
  EXPECT_GE(low, 0.0);
  EXPECT_LE(high, 1.2);
  EXPECT_GT(high - low, 0.3);
  EXPECT_GT(difference, 0.1);
}

}  // namespace
}  // namespace fovea::sample
