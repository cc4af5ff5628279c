#include "fovea/budget/wavelet.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "fovea/base/error.h"
#include "fovea/base/random.h"
#include "fovea/model/image_error.h"
#include "support/pictures.h"

namespace fovea {
namespace {

std::vector<float> noise(std::size_t count, std::uint64_t seed) {
  Random random(seed);
  std::vector<float> values(count);
  for (float& v : values) v = static_cast<float>(random.uniform(-128, 128));
  return values;
}

/// One number for all squares of an image.
ResolutionMap even_map(int width, int height, float pixels) {
  ResolutionMap map;
  map.columns = (width + ResolutionMap::kCell - 1) / ResolutionMap::kCell;
  map.rows = (height + ResolutionMap::kCell - 1) / ResolutionMap::kCell;
  map.pixels_per_texel.assign(static_cast<std::size_t>(map.columns * map.rows), pixels);
  return map;
}

TEST(Wavelet, TransformsAnySizeAndBack) {
  for (const auto& [width, height] :
       {std::array{1, 1}, {1, 9}, {2, 2}, {5, 3}, {64, 48}, {33, 17}, {100, 1}}) {
    const int levels = std::max(2, wavelet_levels(width, height));
    const std::vector<float> original = noise(static_cast<std::size_t>(width * height), 1);
    std::vector<float> plane = original;
    transform(plane, width, height, levels);
    double squares = 0, coefficients = 0;
    for (std::size_t i = 0; i < plane.size(); ++i) {
      squares += static_cast<double>(original[i]) * static_cast<double>(original[i]);
      coefficients += static_cast<double>(plane[i]) * static_cast<double>(plane[i]);
    }
    if (width > 30 && height > 10) {
      EXPECT_NEAR(coefficients / squares, 1, 0.15) << "nearly orthonormal";
    }
    inverse_transform(plane, width, height, levels);
    for (std::size_t i = 0; i < plane.size(); ++i)
      EXPECT_NEAR(plane[i], original[i], 1e-3) << width << " " << height;
  }
}

TEST(Wavelet, CubicsLeaveNoDetail) {
  // The filters of 9 and 7 taps have four vanishing moments; mirrored borders are no cubics.
  constexpr int kSize = 64;
  std::vector<float> plane(kSize);
  for (int i = 0; i < kSize; ++i) {
    const double x = (i - 30) / 16.0;
    plane[static_cast<std::size_t>(i)] = static_cast<float>(3 + x - 2 * x * x + x * x * x);
  }
  transform(plane, kSize, 1, 1);
  for (int i = kSize / 2 + 3; i < kSize - 3; ++i) EXPECT_NEAR(plane[static_cast<std::size_t>(i)], 0, 1e-4);
}

TEST(Wavelet, FineStepsGiveTheImageBack) {
  const Image8 color = test::pattern(75, 50);
  EXPECT_LE(mean_squared_error(reconstructed(wavelet_image(color, 0.25f)), color), 0.1);
  double before = 0;
  for (const float step : {2.0f, 8.0f, 32.0f}) {
    const double error = mean_squared_error(reconstructed(wavelet_image(color, step)), color);
    EXPECT_GT(error, before);
    // Most coefficients of a busy picture err by at most two thirds of a step.
    EXPECT_LT(error, step * step / 4);
    before = error;
  }
  Image8 alpha(20, 10, 4, ColorEncoding::linear);
  for (std::size_t i = 0; i < alpha.pixels.size(); ++i)
    alpha.pixels[i] = static_cast<std::uint8_t>(i * 7 % 256);
  EXPECT_LE(mean_squared_error(reconstructed(wavelet_image(alpha, 0.25f)), alpha), 0.1);
  EXPECT_EQ(reconstructed(wavelet_image(alpha, 0.25f)).encoding, ColorEncoding::linear);
  EXPECT_THROW(wavelet_image(color, 0), Error);
}

TEST(Wavelet, CodesCoefficientsExactly) {
  for (const Image8& image :
       {test::pattern(75, 50), test::pattern(1, 1), test::pattern(130, 3), Image8(40, 30, 1, {})}) {
    for (const float step : {1.0f, 10.0f, 1000.0f}) {
      const WaveletImage wavelets = wavelet_image(image, step);
      EXPECT_EQ(decode_wavelets(encode(wavelets)), wavelets);
    }
  }
  // Any integers at all.
  WaveletImage wild = wavelet_image(test::pattern(37, 53), 1);
  Random random(1);
  for (auto& plane : wild.planes) {
    for (std::int32_t& v : plane) {
      const auto magnitude = static_cast<std::int32_t>(std::exp2(random.uniform(0, 29)));
      v = random.below(3) == 0 ? 0 : random.below(2) == 0 ? magnitude : -magnitude;
    }
  }
  EXPECT_EQ(decode_wavelets(encode(wild)), wild);
}

TEST(Wavelet, CodeIsSmall) {
  // A black image is 64 times one number, plainly told, and nothing else.
  EXPECT_LT(encode(wavelet_image(Image8(1024, 1024, 3, {}), 8)).size(), 200u);
  // Noise of one bit per coefficient takes about that.
  WaveletImage coin = wavelet_image(Image8(256, 256, 1, {}), 8);
  Random random(3);
  for (std::int32_t& v : coin.planes[0]) v = random.below(2) == 0 ? 0 : 1;
  // Half of the coefficients have a sign too.
  EXPECT_NEAR(static_cast<double>(encode(coin).size()), 1.5 * 256 * 256 / 8, 0.03 * 1.5 * 256 * 256 / 8);
}

TEST(Wavelet, DamagedCodesAreErrors) {
  const WaveletImage wavelets = wavelet_image(test::pattern(40, 30), 4);
  const std::vector<std::uint8_t> bytes = encode(wavelets);
  for (std::size_t size = 0; size < bytes.size(); size += 7)
    EXPECT_THROW(decode_wavelets(std::span(bytes).first(size)), Error) << size;
  std::vector<std::uint8_t> longer = bytes;
  longer.push_back(0);
  EXPECT_THROW(decode_wavelets(longer), Error);
  EXPECT_THROW(decode_wavelets(bytes, 1000), Error) << "40 x 30 are more";
  Random random(9);
  for (int i = 0; i < 300; ++i) {
    std::vector<std::uint8_t> damaged = bytes;
    damaged[random.below(static_cast<std::uint32_t>(bytes.size()))] =
        static_cast<std::uint8_t>(random.below(256));
    try {
      reconstructed(decode_wavelets(damaged, 10'000));
    } catch (const Error&) {
    }
  }
}

TEST(Wavelet, PruningKeepsWhatIsSeen) {
  const Image8 image = test::pattern(128, 96);
  const WaveletImage wavelets = wavelet_image(image, 2);
  // A texel to a pixel shows all; from twice as far the finest level goes, then the next.
  const ResolutionMap map = even_map(128, 96, 1);
  EXPECT_EQ(pruned(wavelets, map, 1).image, wavelets);
  EXPECT_EQ(pruned(wavelets, map, 1).kept, 128u * 96);
  EXPECT_EQ(pruned(wavelets, map, 1.01).kept, 64u * 48);
  EXPECT_EQ(pruned(wavelets, map, 2.01).kept, 32u * 24);
  EXPECT_EQ(pruned(wavelets, even_map(128, 96, 0), 0).kept, 8u * 6) << "the smooth part stays";
}

TEST(Wavelet, PruningIsNestedAndSavesBytes) {
  const WaveletImage wavelets = wavelet_image(test::pattern(200, 120), 4);
  ResolutionMap map = even_map(200, 120, 1);
  for (std::size_t i = 0; i < map.pixels_per_texel.size(); ++i)
    map.pixels_per_texel[i] = static_cast<float>(std::exp2(-static_cast<double>(i % 25) / 4));
  PrunedWavelets before = pruned(wavelets, map, 0);
  for (double octaves = 0.5; octaves < 8; octaves += 0.5) {
    const PrunedWavelets now = pruned(wavelets, map, octaves);
    EXPECT_LE(now.kept, before.kept);
    EXPECT_LE(encode(now.image).size(), encode(before.image).size() + 8);
    for (std::size_t i = 0; i < now.image.planes[0].size(); ++i) {
      if (now.image.planes[0][i] != 0) {
        EXPECT_EQ(now.image.planes[0][i], before.image.planes[0][i]);
      }
    }
    before = now;
  }
}

}  // namespace
}  // namespace fovea
