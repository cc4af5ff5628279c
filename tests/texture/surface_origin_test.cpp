#include "fovea/texture/surface_origin.h"

#include <gtest/gtest.h>

#include <cmath>

#include "fovea/texture/rebake.h"
#include "support/meshes.h"
#include "support/pictures.h"
#include "support/textured.h"

namespace fovea {
namespace {

/// An original and what it was simplified to by hand, each with one atlas.
struct Pair {
  Model original, simplified;
  Atlas original_atlas = find_atlases(original).at(0), atlas = find_atlases(simplified).at(0);
};

/// A bumpy square over [0, 1]² and a flat one whose coordinates were fitted badly: u = 0.1 + 0.8 x.
Pair bumpy(int images = 1) {
  Pair pair{test::textured(test::wavy_grid(24, 24, 0.04), images), test::textured(test::grid(1, 1), images)};
  AttributeLayer& uv = *pair.simplified.meshes[0].surface.find(Semantic::uv);
  for (std::size_t i = 0; i < uv.values.size(); i += 2) uv.values[i] = 0.1f + 0.8f * uv.values[i];
  return pair;
}

SurfaceOrigin origin_of(const Pair& pair) {
  return {pair.original, pair.original_atlas, pair.simplified, pair.atlas};
}

TEST(SurfaceOrigins, LieAlongTheNormalOfTheSimplerSurface) {
  const Pair pair = bumpy();
  const SurfaceOrigin origin = origin_of(pair);
  const TexelOrigins found = origin.origins(50, 40, Context());
  for (int y = 0; y < 40; ++y) {
    for (int x = 0; x < 50; ++x) {
      const std::size_t i = found.index(x, y);
      const double u = (x + 0.5) / 50;
      const double wanted = (u - 0.1) / 0.8;
      // A column beyond on either side is read by filters.
      ASSERT_EQ(found.drawn[i] != 0, u > 0.08 && u < 0.92) << x;
      if (wanted < 0 || wanted > 1) continue;
      const bool still = std::abs(wanted - u) * 50 < 0.5;
      EXPECT_NEAR(static_cast<double>(found.texels[i].uv.x), still ? u : wanted, 1e-5);
      EXPECT_NEAR(static_cast<double>(found.texels[i].uv.y), (y + 0.5) / 40, 1e-5);
    }
  }
}

TEST(SurfaceOrigins, ImagesShowTheOriginalAtTheNearestPlace) {
  const Pair pair = bumpy();
  AtlasRebake rebake(pair.original, pair.original_atlas, pair.simplified, pair.atlas);
  Image8 ramp(200, 100, 3, ColorEncoding::linear);
  for (int y = 0; y < 100; ++y) {
    for (int x = 0; x < 200; ++x) {
      ramp.at(x, y)[0] = static_cast<std::uint8_t>(x);
      ramp.at(x, y)[1] = static_cast<std::uint8_t>(2 * y);
    }
  }
  const Image8 baked = rebake.baked(ramp, {TexelMeaning::Kind::data}, Context());
  for (int y = 1; y < 99; ++y) {
    for (int x = 22; x < 178; ++x) {
      const double wanted = 200 * ((x + 0.5) / 200 - 0.1) / 0.8 - 0.5;
      EXPECT_NEAR(baked.at(x, y)[0], wanted, 1.01) << x;
      EXPECT_EQ(baked.at(x, y)[1], 2 * y);
    }
  }
  // Nothing covers what is farther out, and the image goes on there as it was.
  EXPECT_EQ(baked.at(5, 50)[0], 5);
  EXPECT_GT(rebake.moved_texels(), 0.8);
}

TEST(SurfaceOrigins, UnchangedSurfacesChangeNothing) {
  const Model model = test::textured(test::wavy_grid(9, 7, 0.1), 2);
  const Atlas atlas = find_atlases(model).at(0);
  AtlasRebake rebake(model, atlas, model, atlas);
  const Image8 image = test::pattern(64, 48);
  EXPECT_EQ(rebake.baked(image, {TexelMeaning::Kind::color}, Context()).pixels, image.pixels);
  EXPECT_EQ(rebake.moved_texels(), 0);
}

/// Front at z = 0 with u below ½, back at z = -thickness with u above ½.
Model wall(double thickness, double shift) {
  test::PartBuilder builder(0, true, true);
  for (const bool front : {true, false}) {
    const auto z = static_cast<float>(front ? shift : shift - thickness);
    const auto corner = [&](float x, float y) {
      return builder.vertex({x, y, z}, {front ? 0.45f * x : 1 - 0.45f * x, y}, {0, 0, front ? 1.0f : -1.0f});
    };
    const std::uint32_t a = corner(0, 0), b = corner(1, 0), c = corner(1, 1), d = corner(0, 1);
    if (front) {
      builder.quad(a, b, c, d);
    } else {
      builder.quad(a, d, c, b);
    }
  }
  return test::textured(test::weld_part(builder.part()), 1);
}

TEST(SurfaceOrigins, ThinWallsDoNotShowTheirBacks) {
  // The simpler wall has moved by twice its thickness: its front lies behind the original's back.
  Pair pair{wall(0.01, 0), wall(0.01, -0.02)};
  AttributeLayer& uv = *pair.simplified.meshes[0].surface.find(Semantic::uv);
  for (std::size_t i = 1; i < uv.values.size(); i += 2) uv.values[i] = 0.1f + 0.8f * uv.values[i];
  AtlasRebake rebake(pair.original, pair.original_atlas, pair.simplified, pair.atlas);
  Image8 halves(64, 64, 3, ColorEncoding::srgb);
  for (int y = 0; y < 64; ++y)
    for (int x = 0; x < 64; ++x) halves.at(x, y)[0] = x < 32 ? 0 : 255;
  const Image8 baked = rebake.baked(halves, {TexelMeaning::Kind::color}, Context());
  EXPECT_GT(rebake.moved_texels(), 0.5);
  for (int y = 8; y < 56; ++y) {
    for (int x = 1; x < 28; ++x) {
      EXPECT_EQ(baked.at(x, y)[0], 0);
      EXPECT_EQ(baked.at(63 - x, y)[0], 255);
    }
  }
}

TEST(SurfaceOrigins, HalvesThatShareTexelsGetTheMean) {
  // Two flat squares beside each other lie in the whole image; one was moved by a tenth along u.
  const auto model = [](float shift) {
    test::PartBuilder builder(0, true, true);
    for (const float x : {0.0f, 2.0f}) {
      const float by = x == 0 ? shift : 0;
      const std::uint32_t a = builder.vertex({x + by, 0, 0}, {0, 0}),
                          b = builder.vertex({x + 1 + by, 0, 0}, {1, 0}),
                          c = builder.vertex({x + 1 + by, 1, 0}, {1, 1}),
                          d = builder.vertex({x + by, 1, 0}, {0, 1});
      builder.quad(a, b, c, d);
    }
    return test::textured(test::weld_part(builder.part()), 1);
  };
  Pair pair{model(0), model(0.02f)};
  const SurfaceOrigin origin = origin_of(pair);
  const TexelOrigins found = origin.origins(100, 100, Context());
  EXPECT_NEAR(static_cast<double>(found.texels[found.index(50, 50)].uv.x), 0.505 + 0.01, 1e-5);
  // Farther apart they keep what they had.
  Pair far{model(0), model(0.2f)};
  const SurfaceOrigin other = origin_of(far);
  const TexelOrigins stay = other.origins(100, 100, Context());
  EXPECT_NEAR(static_cast<double>(stay.texels[stay.index(50, 50)].uv.x), 0.505, 1e-6);
}

TEST(SurfaceOrigins, NormalMapsTurnWithTheFrames) {
  // The original's coordinates are turned by a quarter against those of the simpler surface.
  Pair pair = bumpy();
  pair.original = test::textured(test::grid(4, 4), 1);
  pair.simplified = test::textured(test::grid(1, 1), 1);
  AttributeLayer& uv = *pair.simplified.meshes[0].surface.find(Semantic::uv);
  for (std::size_t i = 0; i < uv.values.size(); i += 2) {
    const float u = uv.values[i];
    uv.values[i] = 1 - uv.values[i + 1];
    uv.values[i + 1] = u;
  }
  Image8 along(32, 32, 3, ColorEncoding::linear);
  for (int y = 0; y < 32; ++y)
    for (int x = 0; x < 32; ++x) along.at(x, y)[0] = 255, along.at(x, y)[1] = along.at(x, y)[2] = 128;
  AtlasRebake rebake(pair.original, pair.original_atlas, pair.simplified, pair.atlas);
  const Image8 turned = rebake.baked(along, {TexelMeaning::Kind::normal}, Context());
  // As in bake_test.cpp: what ran along x now runs against the bitangent.
  EXPECT_NEAR(turned.at(16, 9)[0], 128, 1);
  EXPECT_NEAR(turned.at(16, 9)[1], 0, 1);
}

TEST(SurfaceOrigins, ThreadsDoNotMatter) {
  const Pair pair = bumpy();
  AtlasRebake one(pair.original, pair.original_atlas, pair.simplified, pair.atlas),
      three(pair.original, pair.original_atlas, pair.simplified, pair.atlas);
  Context single, several;
  single.threads = 1;
  several.threads = 3;
  const Image8 image = test::pattern(150, 130);
  EXPECT_EQ(one.baked(image, {}, single).pixels, three.baked(image, {}, several).pixels);
}

}  // namespace
}  // namespace fovea
