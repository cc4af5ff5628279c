#include "fovea/render/display_texture.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "fovea/base/random.h"
#include "fovea/base/srgb.h"
#include "fovea/model/wrap.h"

namespace fovea {
namespace {

constexpr Wrap kWraps[] = {Wrap::repeat, Wrap::clamp, Wrap::mirror};
constexpr Rgba kWhite{1, 1, 1, 1};
constexpr int kAll = 1 << 20;

int byte(PackedColor color, int channel) { return static_cast<int>(color >> (8 * channel) & 255); }

Sampler wrapped(Wrap u, Wrap v) {
  Sampler sampler;
  sampler.wrap_u = u;
  sampler.wrap_v = v;
  return sampler;
}

/// Display values of four channels.
Image8 noise(int width, int height) {
  Image8 image(width, height, 4, ColorEncoding::srgb);
  Random random(21);
  for (auto& p : image.pixels) p = static_cast<std::uint8_t>(random.below(256));
  return image;
}

/// Grey hills that go on over all sides, by at most 5 display values from a texel to the next.
Image8 hills(int width, int height) {
  Image8 image(width, height, 1, ColorEncoding::srgb);
  constexpr double kTurn = 6.283185307;
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const double grey =
          130 + 25 * std::cos(kTurn * (x + 0.5) / width) + 25 * std::cos(kTurn * (y + 0.5) / height);
      *image.at(x, y) = static_cast<std::uint8_t>(std::lround(grey));
    }
  }
  return image;
}

/// A row of grey display values.
Image8 row(const std::vector<int>& values) {
  Image8 image(static_cast<int>(values.size()), 1, 1, ColorEncoding::srgb);
  for (std::size_t i = 0; i < values.size(); ++i) image.pixels[i] = static_cast<std::uint8_t>(values[i]);
  return image;
}

Vec2f center(int x, int y, int width, int height) {
  return {(static_cast<float>(x) + 0.5f) / static_cast<float>(width),
          (static_cast<float>(y) + 0.5f) / static_cast<float>(height)};
}

/// The bilinear mix of display values in double precision, literal and slow.
double mixed(const MipMap& map, Vec2f uv, const Sampler& sampler, float Rgba::*channel) {
  const double x = double{uv.x} * map.width() - 0.5, y = double{uv.y} * map.height() - 0.5;
  double sum = 0;
  for (int j = 0; j < 2; ++j) {
    for (int i = 0; i < 2; ++i) {
      const double across = i == 0 ? 1 - (x - std::floor(x)) : x - std::floor(x);
      const double down = j == 0 ? 1 - (y - std::floor(y)) : y - std::floor(y);
      const int column =
          wrapped_texel(static_cast<std::int64_t>(std::floor(x)) + i, map.width(), sampler.wrap_u);
      const int line =
          wrapped_texel(static_cast<std::int64_t>(std::floor(y)) + j, map.height(), sampler.wrap_v);
      sum += across * down * to_display(map.texel(0, column, line).*channel);
    }
  }
  return sum;
}

TEST(DisplayTexture, TexelsAreWhatTheImageSays) {
  const Image8 image = noise(16, 8);
  const MipMap map(image, ColorEncoding::srgb);
  for (const Wrap wrap : kWraps) {
    const DisplayTexture texture(map, kWhite, wrapped(wrap, wrap), kAll);
    for (int y = 0; y < 8; ++y) {
      for (int x = 0; x < 16; ++x) {
        const PackedColor color = texture.at(0, center(x, y, 16, 8));
        for (int k = 0; k < 4; ++k) EXPECT_EQ(byte(color, k), image.at(x, y)[k]) << x << ", " << y;
      }
    }
  }
}

TEST(DisplayTexture, SmallerLevelsAreThoseOfTheMap) {
  const MipMap map(noise(16, 8), ColorEncoding::srgb);
  const DisplayTexture texture(map, kWhite, {}, kAll);
  ASSERT_EQ(map.level_count(), 5u);
  for (std::size_t level = 0; level < 5; ++level) {
    const int width = std::max(16 >> level, 1), height = std::max(8 >> level, 1);
    for (int y = 0; y < height; ++y) {
      for (int x = 0; x < width; ++x)
        EXPECT_EQ(texture.at(level, center(x, y, width, height)), packed(map.texel(level, x, y)));
    }
  }
}

TEST(DisplayTexture, BetweenTexelsValuesAreMixed) {
  for (const Wrap wrap : kWraps) {
    const DisplayTexture texture(MipMap(row({0, 100, 200, 40}), ColorEncoding::srgb), kWhite,
                                 wrapped(wrap, wrap), kAll);
    const auto at = [&](float texel) { return byte(texture.at(0, {texel / 4, 0.5f}), 0); };
    EXPECT_EQ(at(0.75f), 25);
    EXPECT_EQ(at(1), 50);
    EXPECT_EQ(at(1.75f), 125);
    EXPECT_EQ(at(3), 120);
  }
}

// texel |  0  |  1  |  2  |  3  |     what a look beyond the first and the last sees:
//       40   100   200   240          repeat: the other end; clamp, mirror: the same again
TEST(DisplayTexture, SeamsAreAsTheSamplerSays) {
  const MipMap map(row({40, 100, 200, 240}), ColorEncoding::srgb);
  const auto at = [&](float texel, Wrap wrap) {
    return byte(DisplayTexture(map, kWhite, wrapped(wrap, Wrap::clamp), kAll).at(0, {texel / 4, 0.5f}), 0);
  };
  for (const float turn : {-8.0f, 0.0f, 12.0f}) {
    EXPECT_EQ(at(turn, Wrap::repeat), 140);
    EXPECT_EQ(at(turn + 0.25f, Wrap::repeat), 90);
    EXPECT_EQ(at(turn - 0.25f, Wrap::repeat), 190);
    EXPECT_EQ(at(turn - 0.5f, Wrap::repeat), 240);
  }
  EXPECT_EQ(at(0, Wrap::clamp), 40);
  EXPECT_EQ(at(-3, Wrap::clamp), 40);
  EXPECT_EQ(at(4, Wrap::clamp), 240);
  EXPECT_EQ(at(99, Wrap::clamp), 240);
  for (const float turn : {-8.0f, 0.0f, 16.0f}) {
    EXPECT_EQ(at(turn, Wrap::mirror), 40);
    EXPECT_EQ(at(turn - 1.5f, Wrap::mirror), 100);
    EXPECT_EQ(at(turn + 4, Wrap::mirror), 240);
    EXPECT_EQ(at(turn + 5.5f, Wrap::mirror), 200);
  }
}

TEST(DisplayTexture, EachAxisWrapsAsItIsTold) {
  const MipMap map(noise(8, 8), ColorEncoding::srgb);
  const DisplayTexture texture(map, kWhite, wrapped(Wrap::repeat, Wrap::mirror), kAll);
  const Vec2f inside = center(2, 5, 8, 8);
  EXPECT_EQ(texture.at(0, {inside.x + 1, -inside.y}), texture.at(0, inside));
}

TEST(DisplayTexture, IsTheBilinearMixOfDisplayValues) {
  constexpr float Rgba::*kColors[] = {&Rgba::r, &Rgba::g, &Rgba::b};
  // Two mixes lose less than 1 each, and shares are rounded to 1/256 of at most 255 along either axis.
  constexpr double kTolerance = 4;
  const MipMap map(noise(13, 6), ColorEncoding::srgb);
  Random random(22);
  for (const Wrap wrap_u : kWraps) {
    for (const Wrap wrap_v : kWraps) {
      const Sampler sampler = wrapped(wrap_u, wrap_v);
      const DisplayTexture texture(map, kWhite, sampler, kAll);
      for (int i = 0; i < 2000; ++i) {
        const Vec2f uv{static_cast<float>(random.uniform(-3, 3)), static_cast<float>(random.uniform(-3, 3))};
        const PackedColor color = texture.at(0, uv);
        for (int k = 0; k < 3; ++k)
          EXPECT_NEAR(byte(color, k), mixed(map, uv, sampler, kColors[k]), kTolerance);
      }
    }
  }
}

TEST(DisplayTexture, LooksLikeTheMapWhereTheImageIsSmooth) {
  // Two mixes lose less than 1 each; what is compared is rounded to whole values at the texels and at the
  // end; and mixing display values instead of light is off by 0.1 over steps of 5, 0.4 over steps of 10.
  constexpr int kTolerance = 3;
  const MipMap map(hills(64, 32), ColorEncoding::srgb);
  Random random(23);
  for (const Wrap wrap : kWraps) {
    const Sampler sampler = wrapped(wrap, wrap);
    const DisplayTexture texture(map, kWhite, sampler, kAll);
    for (int i = 0; i < 2000; ++i) {
      const std::size_t level = i % 2;
      const Vec2f uv{static_cast<float>(random.uniform(-2, 2)), static_cast<float>(random.uniform(-2, 2))};
      const float texels = level == 0 ? 0.0f : 2.0f;  // to the next pixel
      const Rgba light = map.sample(uv, {{texels / 64, 0}, {0, texels / 32}}, sampler);
      EXPECT_NEAR(byte(texture.at(level, uv), 1), to_display(light.g), kTolerance) << level;
    }
  }
}

TEST(DisplayTexture, TheFactorDimsLightAndNotDisplayValues) {
  const DisplayTexture texture(MipMap(row({255, 255}), ColorEncoding::srgb), {0.5f, 1, 0, 0.5f}, {}, kAll);
  const PackedColor color = texture.at(0, {0.3f, 0.7f});
  EXPECT_EQ(byte(color, 0), 188) << "half the light is display value 188";
  EXPECT_EQ(byte(color, 1), 255);
  EXPECT_EQ(byte(color, 2), 0);
  EXPECT_EQ(byte(color, 3), 128) << "alpha is no light";
}

TEST(DisplayTexture, FactorsBeyondOneEndAtWhite) {
  const DisplayTexture texture(MipMap(row({128, 128}), ColorEncoding::srgb), {9, -1, 1, 3}, {}, kAll);
  EXPECT_EQ(texture.at(0, {0, 0}), 0xFF8000FFu);
}

TEST(DisplayTexture, ALevelHasTexelsAboutAsLargeAsPixels) {
  const DisplayTexture texture(MipMap(noise(64, 64), ColorEncoding::srgb), kWhite, {}, kAll);
  for (double area = 1; area < 64 * 64; area *= 1.01) {
    const double texel = std::pow(4.0, texture.level_for(static_cast<float>(area)));
    EXPECT_GE(texel, 0.49 * area);  // within a half and twice the pixel; areas are rounded
    EXPECT_LE(texel, 2.01 * area);
  }
  EXPECT_EQ(texture.level_for(4), 1u);
  EXPECT_EQ(texture.level_for(16), 2u);
}

TEST(DisplayTexture, LevelsEndAtBothEnds) {
  const DisplayTexture texture(MipMap(noise(64, 64), ColorEncoding::srgb), kWhite, {}, kAll);
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  for (const float texels : {0.0f, 0.3f, 1.0f, -5.0f, -kInfinity, std::nanf("")})
    EXPECT_EQ(texture.level_for(texels), 0u) << texels;
  for (const float texels : {4096.0f, 1e9f, 3e38f, kInfinity})
    EXPECT_EQ(texture.level_for(texels), 6u) << texels;
}

TEST(DisplayTexture, LargeLevelsAreLeftOut) {
  const MipMap map(noise(64, 16), ColorEncoding::srgb);
  const DisplayTexture all(map, kWhite, {}, kAll), some(map, kWhite, {}, 16);
  // The first level of 16 × 4 texels is the third of the map.
  EXPECT_EQ(some.level_for(1), 0u);
  EXPECT_EQ(some.level_for(16), 0u);
  EXPECT_EQ(some.level_for(64), 1u);
  EXPECT_EQ(some.full_width(), 64);
  EXPECT_EQ(some.full_height(), 16);
  Random random(24);
  for (int i = 0; i < 500; ++i) {
    const Vec2f uv{static_cast<float>(random.uniform()), static_cast<float>(random.uniform())};
    for (std::size_t level = 0; level < 5; ++level) EXPECT_EQ(some.at(level, uv), all.at(level + 2, uv));
  }
}

TEST(DisplayTexture, TheSmallestLevelStays) {
  const MipMap map(noise(8, 8), ColorEncoding::srgb);
  const DisplayTexture texture(map, kWhite, {}, 0);
  for (const float texels : {1.0f, 1e6f}) EXPECT_EQ(texture.level_for(texels), 0u);
  EXPECT_EQ(texture.at(0, {0.3f, 0.9f}), packed(map.texel(3, 0, 0)));
}

TEST(DisplayTexture, OneTexelIsAllThereIs) {
  Image8 image(1, 1, 4, ColorEncoding::srgb);
  for (int k = 0; k < 4; ++k) image.at(0, 0)[k] = static_cast<std::uint8_t>(50 * (k + 1));
  for (const Wrap wrap : kWraps) {
    const DisplayTexture texture(MipMap(image, ColorEncoding::srgb), kWhite, wrapped(wrap, wrap), kAll);
    EXPECT_EQ(texture.level_for(100), 0u);
    for (const float u : {-7.3f, -1.0f, 0.0f, 0.2f, 0.5f, 1.0f, 42.0f})
      EXPECT_EQ(texture.at(0, {u, -u}), 0xC8966432u);
  }
}

TEST(DisplayTexture, CoordinatesThatAreNoNumbersAreZero) {
  const MipMap map(noise(8, 4), ColorEncoding::srgb);
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  for (const Wrap wrap : kWraps) {
    const DisplayTexture texture(map, kWhite, wrapped(wrap, wrap), kAll);
    for (std::size_t level = 0; level < map.level_count(); ++level) {
      for (const float u : {std::nanf(""), kInfinity, -kInfinity, 3e38f, -3e38f, 1e6f, 1e-40f})
        EXPECT_EQ(texture.at(level, {u, u}), texture.at(level, {0, 0})) << u;
    }
  }
}

TEST(DisplayTexture, ANumberJustBelowZeroIsNextToTheSeam) {
  for (const Wrap wrap : kWraps) {
    const DisplayTexture texture(MipMap(noise(8, 4), ColorEncoding::srgb), kWhite, wrapped(wrap, wrap), kAll);
    const PackedColor below = texture.at(0, {-1e-12f, 0.125f}), at = texture.at(0, {0, 0.125f});
    for (int k = 0; k < 4; ++k) EXPECT_NEAR(byte(below, k), byte(at, k), 1);  // rounded from either side
  }
}

}  // namespace
}  // namespace fovea
