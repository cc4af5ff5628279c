#include "fovea/saliency/texture_signals.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "fovea/base/random.h"
#include "oracle/texture_oracle.h"
#include "support/pictures.h"
#include "support/reading.h"

namespace fovea {
namespace {

constexpr Wrap kWraps[] = {Wrap::repeat, Wrap::mirror, Wrap::clamp};

Sampler wrapping(Wrap u, Wrap v) {
  Sampler sampler;
  sampler.wrap_u = u;
  sampler.wrap_v = v;
  return sampler;
}

Image8 constant(int width, int height, std::vector<std::uint8_t> texel) {
  Image8 image(width, height, static_cast<int>(texel.size()), ColorEncoding::srgb);
  for (std::size_t i = 0; i < image.pixels.size(); ++i) image.pixels[i] = texel[i % texel.size()];
  return image;
}

Image8 noise(int width, int height, int channels) {
  Image8 image(width, height, channels, ColorEncoding::srgb);
  Random random(5);
  for (std::uint8_t& x : image.pixels) x = static_cast<std::uint8_t>(random.below(256));
  return image;
}

TextureSignals signals(const Image8& image, const Sampler& sampler = {}, TextureSignalOptions options = {},
                       int threads = 1) {
  Context context;
  context.threads = threads;
  return texture_signals(image, sampler, options, context);
}

TEST(ColorSignals, AreThoseOfThePaper) {
  EXPECT_NEAR(color_signals(0.9f, 0.3f, 0.6f).intensity, 0.6, 1e-6);
  EXPECT_NEAR(color_signals(0.9f, 0.3f, 0.6f).opponency, 0.6 / 0.9 + 0.3 / 0.9, 1e-6);
  EXPECT_NEAR(color_signals(0.2f, 0.8f, 0.1f).opponency, -0.6 / 0.8 - 0.1 / 0.8, 1e-6);
  EXPECT_EQ(color_signals(0.5f, 0.5f, 0.5f).opponency, 0);
  EXPECT_EQ(color_signals(1, 0, 1).opponency, 2);
  EXPECT_EQ(color_signals(0, 1, 0).opponency, -1);
  // Too dark to have a colour.
  EXPECT_EQ(color_signals(0.009f, 0, 0).opponency, 0);
  EXPECT_EQ(color_signals(0.011f, 0, 0).opponency, 1);
  EXPECT_EQ(color_signals(0, 0, 0).opponency, 0);
}

TEST(TextureSignals, OneRedTexelByHand) {
  // 255 0 0 in the middle of black: after 1 2 1 there is 1/4 of it in its place, 1/8 beside it, 1/16 on the
  // diagonals.
  Image8 image = constant(5, 5, {0, 0, 0});
  image.at(2, 2)[0] = 255;
  const TextureSignals found = signals(image);
  EXPECT_FLOAT_EQ(*found.intensity.at(2, 2), 1.0f / 12);
  EXPECT_FLOAT_EQ(*found.intensity.at(1, 2), 1.0f / 24);
  EXPECT_FLOAT_EQ(*found.intensity.at(3, 3), 1.0f / 48);
  EXPECT_EQ(*found.intensity.at(0, 2), 0);
  EXPECT_EQ(*found.opponency.at(3, 3), 1);
  EXPECT_EQ(*found.opponency.at(0, 0), 0);
}

TEST(TextureSignals, AConstantSaysNothing) {
  for (const std::vector<std::uint8_t>& texel : {std::vector<std::uint8_t>{200, 100, 50},
                                                 {200, 100, 50, 7},
                                                 {90},
                                                 {90, 3},
                                                 {255, 255, 255},
                                                 {0, 0, 0}}) {
    const TextureSignals found = signals(constant(20, 13, texel));
    for (const float x : found.entropy.pixels) EXPECT_EQ(x, 0);
    for (const float x : found.intensity.pixels) EXPECT_EQ(x, found.intensity.pixels[0]);
    for (const float x : found.opponency.pixels) EXPECT_EQ(x, found.opponency.pixels[0]);
    const bool grey = texel.size() < 3 || texel[0] == texel[2];
    EXPECT_NEAR(found.intensity.pixels[0], grey ? texel[0] / 255.0 : 350 / 765.0, 1e-6);
    EXPECT_NEAR(found.opponency.pixels[0], grey ? 0 : 0.5 - 0.25, 1e-6);
  }
}

TEST(TextureSignals, ACheckerboardIsOneBit) {
  // Squares of 16 texels and windows of 63: of black and white nearly as many, few greys between them.
  Image8 image(256, 256, 1, ColorEncoding::srgb);
  for (int y = 0; y < 256; ++y) {
    for (int x = 0; x < 256; ++x) *image.at(x, y) = (x / 16 + y / 16) % 2 == 0 ? 255 : 0;
  }
  TextureSignalOptions options;
  options.entropy_window = 63;
  options.entropy_bins = 2;
  const TextureSignals found = signals(image, {}, options);
  for (const float x : found.entropy.pixels) EXPECT_NEAR(x, 1, 0.01);
  // In the middle of a square of its own a small window sees one colour, at its edge half of each.
  options.entropy_window = 9;
  const TextureSignals small = signals(image, {}, options);
  EXPECT_EQ(*small.entropy.at(40, 24), 0);
  EXPECT_NEAR(*small.entropy.at(48, 24), 1, 0.01);
}

TEST(TextureSignals, SlidingIsCounting) {
  Sampler sampler;
  for (const auto& [width, height, channels] :
       {std::array{23, 17, 3}, {1, 1, 4}, {2, 30, 2}, {31, 1, 1}, {40, 40, 4}}) {
    for (const Wrap u : kWraps) {
      for (const Wrap v : kWraps) {
        sampler = wrapping(u, v);
        TextureSignalOptions options;
        options.entropy_window = u == v ? 9 : 5;
        options.entropy_bins = v == Wrap::clamp ? 256 : 32;
        const Image8 image = noise(width, height, channels);
        const TextureSignals found = signals(image, sampler, options);
        for (int y = 0; y < height; y += 3) {
          for (int x = 0; x < width; x += 2) {
            EXPECT_NEAR(*found.entropy.at(x, y), test::counted_entropy(image, sampler, options, x, y), 1e-5);
            const auto [r, g, b] = test::smooth_color(image, sampler, x, y);
            const ColorSignals color =
                color_signals(static_cast<float>(r), static_cast<float>(g), static_cast<float>(b));
            EXPECT_NEAR(*found.intensity.at(x, y), color.intensity, 1e-6);
            EXPECT_NEAR(*found.opponency.at(x, y), color.opponency, 1e-4);
          }
        }
      }
    }
  }
}

TEST(TextureSignals, WhatRepeatsHasNoBorder) {
  const Image8 tile = noise(16, 8, 3);
  Image8 tiles(48, 24, 3, ColorEncoding::srgb);
  for (int y = 0; y < 24; ++y) {
    for (int x = 0; x < 48; ++x) std::copy_n(tile.at(x % 16, y % 8), 3, tiles.at(x, y));
  }
  const TextureSignals one = signals(tile), all = signals(tiles, wrapping(Wrap::clamp, Wrap::clamp));
  for (int y = 0; y < 8; ++y) {
    for (int x = 0; x < 16; ++x) {
      EXPECT_EQ(*one.intensity.at(x, y), *all.intensity.at(16 + x, 8 + y));
      EXPECT_EQ(*one.entropy.at(x, y), *all.entropy.at(16 + x, 8 + y));
    }
  }
}

TEST(TextureSignals, ASmoothedImageIsExact) {
  const Image8 image = noise(9, 6, 3);
  const Sampler sampler = wrapping(Wrap::clamp, Wrap::repeat);
  const Image<std::uint16_t> smooth = smoothed(image, sampler, Context());
  for (int y = 0; y < 6; ++y) {
    for (int x = 0; x < 9; ++x) {
      const std::array<double, 3> color = test::smooth_color(image, sampler, x, y);
      for (int k = 0; k < 3; ++k)
        EXPECT_EQ(smooth.at(x, y)[k], std::lround(color[static_cast<std::size_t>(k)] * kSmoothUnit));
    }
  }
}

TEST(TextureSignals, AFactorMultipliesLight) {
  const Image8 image = constant(2, 2, {255, 128, 10, 9});
  const Image8 half = with_factor(image, {0.5, 1, 0}, Context());
  EXPECT_EQ(half.channels, 3);
  EXPECT_EQ(half.at(1, 1)[0], 188);  // half the light of white
  EXPECT_EQ(half.at(1, 1)[1], 128);
  EXPECT_EQ(half.at(1, 1)[2], 0);
}

TEST(TextureSignals, RefusesOptionsOutOfRange) {
  for (const auto& [window, bins] : {std::array{1, 32}, {8, 32}, {65, 32}, {9, 1}, {9, 257}, {-3, 32}}) {
    TextureSignalOptions options;
    options.entropy_window = window;
    options.entropy_bins = bins;
    test::expect_error([&] { signals(constant(3, 3, {1}), {}, options); }, ErrorKind::usage, "");
  }
}

TEST(TextureSignals, TheSameBitsForAnyNumberOfThreads) {
  const Image8 image = test::pattern(150, 203);
  const TextureSignals one = signals(image, {}, {}, 1), three = signals(image, {}, {}, 3);
  EXPECT_EQ(one.intensity.pixels, three.intensity.pixels);
  EXPECT_EQ(one.opponency.pixels, three.opponency.pixels);
  EXPECT_EQ(one.entropy.pixels, three.entropy.pixels);
}

}  // namespace
}  // namespace fovea
