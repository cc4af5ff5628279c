#include "fovea/texture/mip_map.h"

#include <gtest/gtest.h>

#include <cmath>

#include "fovea/base/srgb.h"

namespace fovea {
namespace {

/// Grey values of a row of texels.
Image8 row(const std::vector<int>& values) {
  Image8 image(static_cast<int>(values.size()), 1, 1, ColorEncoding::linear);
  for (std::size_t i = 0; i < values.size(); ++i) image.pixels[i] = static_cast<std::uint8_t>(values[i]);
  return image;
}

UvSlopes slope(double du) { return {{static_cast<float>(du), 0}, {0, 0}}; }

TEST(MipMap, LevelsAverageLight) {
  Image8 checker(2, 2, 3, ColorEncoding::srgb);
  for (int k = 0; k < 3; ++k) checker.at(0, 0)[k] = checker.at(1, 1)[k] = 255;
  const MipMap map(checker, ColorEncoding::srgb);
  ASSERT_EQ(map.level_count(), 2u);
  // Half the light is display value 188, not 128.
  EXPECT_EQ(to_display(map.texel(1, 0, 0).r), 188);
  EXPECT_EQ(map.texel(1, 0, 0).a, 1);
}

TEST(MipMap, OddTexelsAreShared) {
  // Five texels to two: each is 2.5 wide, the middle one gives half to both.
  const MipMap map(row({10, 20, 100, 200, 250}), ColorEncoding::linear);
  ASSERT_EQ(map.level_count(), 3u);
  EXPECT_NEAR(map.texel(1, 0, 0).r * 255, (10 + 20 + 50) / 2.5, 0.51);
  EXPECT_NEAR(map.texel(1, 1, 0).r * 255, (50 + 200 + 250) / 2.5, 0.51);
}

TEST(MipMap, WrapsAsTheSamplerSays) {
  const MipMap map(row({0, 100, 200, 255}), ColorEncoding::linear);
  Sampler sampler;
  sampler.mag_filter = 9728;
  const auto at = [&](float u, Wrap wrap) {
    sampler.wrap_u = wrap;
    return std::lround(map.sample({u, 0.5f}, {}, sampler).r * 255);
  };
  EXPECT_EQ(at(1.125f, Wrap::repeat), 0);
  EXPECT_EQ(at(-0.125f, Wrap::repeat), 255);
  EXPECT_EQ(at(1.125f, Wrap::mirror), 255);
  EXPECT_EQ(at(-0.375f, Wrap::mirror), 100);
  EXPECT_EQ(at(2.125f, Wrap::mirror), 0);
  EXPECT_EQ(at(5, Wrap::clamp), 255);
  EXPECT_EQ(at(-5, Wrap::clamp), 0);
}

TEST(MipMap, MixesNeighboursLinearly) {
  const MipMap map(row({0, 100, 200, 255}), ColorEncoding::linear);
  Sampler sampler;
  const auto at = [&](float u, Wrap wrap) {
    sampler.wrap_u = wrap;
    return map.sample({u, 0.5f}, {}, sampler).r * 255;
  };
  EXPECT_NEAR(at(0.375f, Wrap::repeat), 100, 1e-3);  // in the middle of a texel
  EXPECT_NEAR(at(0.5f, Wrap::repeat), 150, 1e-3);
  EXPECT_NEAR(at(0, Wrap::repeat), 127.5, 1e-3);
  EXPECT_NEAR(at(0, Wrap::clamp), 0, 1e-3);
  EXPECT_NEAR(at(0, Wrap::mirror), 0, 1e-3);
}

TEST(MipMap, TheLevelFollowsTheSlope) {
  // Levels of known grey: 16 texels, then 8, 4, 2, 1 averaged; a ramp keeps its mean but loses its range.
  std::vector<int> values;
  for (int i = 0; i < 16; ++i) values.push_back(i % 2 == 0 ? 0 : 255);
  const MipMap map(row(values), ColorEncoding::linear);
  const float u = 0.5f / 16;  // the middle of a black texel
  const auto at = [&](double texels) { return map.sample({u, 0.5f}, slope(texels / 16), {}).r * 255; };
  EXPECT_NEAR(at(0.9), 0, 1e-3);
  EXPECT_NEAR(at(2), 127.5, 0.6);                   // level 1: all texels alike
  EXPECT_NEAR(at(std::sqrt(2.0)), 127.5 / 2, 0.6);  // half-way between the two
}

TEST(MipMap, FiltersWithoutMipsUseTheImageItself) {
  std::vector<int> values(16, 0);
  for (std::size_t i = 1; i < 16; i += 2) values[i] = 255;
  const MipMap map(row(values), ColorEncoding::linear);
  Sampler sampler;
  sampler.min_filter = 9729;
  EXPECT_NEAR(map.sample({0.5f / 16, 0.5f}, slope(0.5), sampler).r, 0, 1e-6);
}

TEST(MipMap, AnisotropyKeepsWhatTheLongSlopeWouldBlur) {
  // Stripes along u, looked at with a long slope along u: one look blurs both ways.
  Image8 stripes(64, 64, 1, ColorEncoding::linear);
  for (int y = 0; y < 64; ++y) {
    for (int x = 0; x < 64; ++x) *stripes.at(x, y) = y % 2 == 0 ? 0 : 255;
  }
  const MipMap map(stripes, ColorEncoding::linear);
  const UvSlopes slopes{{8.0f / 64, 0}, {0, 0.5f / 64}};
  const Vec2f black{0.5f, 32.5f / 64};
  EXPECT_NEAR(map.sample(black, slopes, {}, 1).r, 0.5, 0.01);
  EXPECT_NEAR(map.sample(black, slopes, {}, 8).r, 0, 0.01);
}

TEST(MipMap, PutsUpWithCoordinatesOfNoUse) {
  const MipMap map(row({0, 255}), ColorEncoding::linear);
  for (const float u : {std::nanf(""), INFINITY, -INFINITY, 3e38f}) {
    const float value = map.sample({u, u}, {{u, u}, {u, u}}, {}).r;
    EXPECT_GE(value, 0);
    EXPECT_LE(value, 1);
  }
}

}  // namespace
}  // namespace fovea
