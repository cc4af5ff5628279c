#include "fovea/texture/resize.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "fovea/base/error.h"
#include "fovea/base/random.h"
#include "fovea/base/srgb.h"
#include "fovea/model/wrap.h"
#include "support/pictures.h"
#include "support/reading.h"

namespace fovea {
namespace {

using Kind = TexelMeaning::Kind;

Image8 resize(const Image8& image, int width, int height, const TexelMeaning& meaning = {},
              Wrap wrap = Wrap::repeat, int threads = 1) {
  Context context;
  context.threads = threads;
  return resized(image, width, height, meaning, wrap, wrap, context);
}

Image8 filled(int width, int height, const std::vector<std::uint8_t>& texel) {
  Image8 image(width, height, static_cast<int>(texel.size()), ColorEncoding::srgb);
  for (std::size_t i = 0; i < image.pixels.size(); ++i) image.pixels[i] = texel[i % texel.size()];
  return image;
}

Image8 noise(int width, int height, int channels) {
  Image8 image(width, height, channels, ColorEncoding::srgb);
  Random random(7);
  for (std::uint8_t& x : image.pixels) x = static_cast<std::uint8_t>(256 * random.uniform());
  return image;
}

int largest_difference(const Image8& a, const Image8& b) {
  EXPECT_EQ(a.pixels.size(), b.pixels.size());
  int most = 0;
  for (std::size_t i = 0; i < a.pixels.size(); ++i)
    most = std::max(most, std::abs(a.pixels[i] - b.pixels[i]));
  return most;
}

// The definition, texel by texel, in double precision: data of any number of channels.
Image8 lanczos_by_definition(const Image8& image, int width, int height, Wrap wrap) {
  const auto kernel = [](double x) {
    if (x == 0) return 1.0;
    if (std::abs(x) >= 3) return 0.0;
    const double t = std::numbers::pi * x;
    return 3 * std::sin(t) * std::sin(t / 3) / (t * t);
  };
  const double sx = static_cast<double>(image.width) / width, sy = static_cast<double>(image.height) / height;
  const double wx = std::max(sx, 1.0), wy = std::max(sy, 1.0);
  Image8 result(width, height, image.channels, image.encoding);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const double cx = (x + 0.5) * sx - 0.5, cy = (y + 0.5) * sy - 0.5;
      for (int k = 0; k < image.channels; ++k) {
        double sum = 0, weights = 0;
        for (int j = static_cast<int>(cy - 3 * wy) - 1; j <= cy + 3 * wy + 1; ++j) {
          for (int i = static_cast<int>(cx - 3 * wx) - 1; i <= cx + 3 * wx + 1; ++i) {
            const double w = kernel((i - cx) / wx) * kernel((j - cy) / wy);
            sum += w * image.at(wrapped_texel(i, image.width, wrap), wrapped_texel(j, image.height, wrap))[k];
            weights += w;
          }
        }
        result.at(x, y)[k] = static_cast<std::uint8_t>(std::clamp(sum / weights, 0.0, 255.0) + 0.5);
      }
    }
  }
  return result;
}

TEST(Resize, SameSizeIsTheSameImage) {
  const Image8 image = noise(7, 5, 4);
  EXPECT_EQ(resize(image, 7, 5, {Kind::normal, true, 0.5}).pixels, image.pixels);
}

TEST(Resize, IsTheDefinition) {
  for (const Wrap wrap : {Wrap::repeat, Wrap::mirror, Wrap::clamp}) {
    for (const auto& [width, height] : {std::pair{10, 7}, {3, 40}, {64, 1}}) {
      const Image8 image = noise(23, 18, 3);
      // Rounding of floats may tip a value that is nearly half-way.
      EXPECT_LE(largest_difference(resize(image, width, height, {Kind::data}, wrap),
                                   lanczos_by_definition(image, width, height, wrap)),
                1);
    }
  }
}

TEST(Resize, WhatIsEvenStaysEven) {
  for (const TexelMeaning& meaning : {TexelMeaning{}, {Kind::data}, {Kind::color, true}}) {
    for (const int size : {1, 3, 16, 61}) {
      const std::vector<std::uint8_t> texel{200, 90, 3, 77};
      EXPECT_EQ(
          largest_difference(resize(filled(20, 12, texel), size, size, meaning), filled(size, size, texel)),
          0);
    }
  }
}

// Half the texels black, half white: half the light, which displays as 188; as data, 127.5.
TEST(Resize, ColorsAreMixedAsLight) {
  Image8 image(64, 64, 1, ColorEncoding::srgb);
  for (int y = 0; y < 64; ++y)
    for (int x = 0; x < 64; ++x) *image.at(x, y) = (x + y) % 2 == 0 ? 0 : 255;
  EXPECT_NEAR(*resize(image, 8, 8).at(3, 3), to_display(0.5f), 1);
  EXPECT_NEAR(*resize(image, 8, 8, {Kind::data}).at(3, 3), 128, 1);
}

TEST(Resize, NormalsKeepTheirLength) {
  const Image8 map = resize(noise(40, 40, 3), 9, 13, {Kind::normal});
  for (std::size_t i = 0; i < map.pixels.size(); i += 3) {
    double sum = 0;
    for (std::size_t k = 0; k < 3; ++k) sum += std::pow(map.pixels[i + k] / 127.5 - 1, 2);
    EXPECT_NEAR(std::sqrt(sum), 1, 0.01);  // a step of a byte is 0.008
  }
}

// A white disc on black that does not show: no grey rim where it does.
TEST(Resize, WhatDoesNotShowDoesNotBleed) {
  Image8 image(64, 64, 4, ColorEncoding::srgb);
  for (int y = 0; y < 64; ++y) {
    for (int x = 0; x < 64; ++x) {
      const bool in = (x - 31) * (x - 31) + (y - 31) * (y - 31) < 400;
      std::fill_n(image.at(x, y), 4, static_cast<std::uint8_t>(in ? 255 : 0));
    }
  }
  const Image8 small = resize(image, 16, 16, {Kind::color, true});
  for (std::size_t i = 0; i < small.pixels.size(); i += 4) {
    if (small.pixels[i + 3] > 25) {
      EXPECT_GE(small.pixels[i], 250);
    }
  }
}

// Thin leaves: averages alone would let nearly nothing pass.
TEST(Resize, MasksKeepTheirCoverage) {
  const auto passing = [](const Image8& image) {
    double count = 0;
    for (std::size_t i = 3; i < image.pixels.size(); i += 4) count += image.pixels[i] >= 128;
    return count * 4 / static_cast<double>(image.pixels.size());
  };
  Image8 image = filled(128, 128, {10, 200, 30, 0});
  for (int y = 0; y < 128; ++y)
    for (int x = 0; x < 128; ++x) image.at(x, y)[3] = (137 * x + 61 * y) % 1000 < 190 ? 255 : 0;
  const TexelMeaning mask{Kind::color, true, 0.5};
  const Image8 averaged = resize(image, 16, 16, {Kind::color, true}), kept = resize(image, 16, 16, mask);
  EXPECT_LT(passing(averaged), 0.6 * passing(image));
  // Equal values of alpha pass together or not at all.
  EXPECT_NEAR(passing(kept), passing(image), 0.06);
}

TEST(Resize, RepeatingTexturesStaySeamless) {
  const Image8 image = noise(32, 32, 3);
  Image8 shifted = image;
  for (int y = 0; y < 32; ++y)
    for (int x = 0; x < 32; ++x) std::copy_n(image.at((x + 12) % 32, (y + 4) % 32), 3, shifted.at(x, y));
  const Image8 small = resize(image, 16, 16), small_shifted = resize(shifted, 16, 16);
  for (int y = 0; y < 16; ++y)
    for (int x = 0; x < 16; ++x)
      for (int k = 0; k < 3; ++k)
        EXPECT_NEAR(small_shifted.at(x, y)[k], small.at((x + 6) % 16, (y + 2) % 16)[k], 1);
}

TEST(Resize, ThreadsDoNotMatter) {
  const Image8 image = test::pattern(301, 203);
  EXPECT_EQ(resize(image, 77, 90, {}, Wrap::clamp, 4).pixels,
            resize(image, 77, 90, {}, Wrap::clamp, 1).pixels);
}

TEST(Resize, NoTexelsAreRefused) {
  test::expect_error([] { resize(noise(4, 4, 3), 0, 4); }, ErrorKind::usage, "");
}

}  // namespace
}  // namespace fovea
