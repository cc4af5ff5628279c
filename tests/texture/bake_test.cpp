#include "fovea/texture/bake.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "fovea/texture/tangent_frame.h"
#include "support/meshes.h"
#include "support/pictures.h"
#include "support/textured.h"

namespace fovea {
namespace {

using Kind = TexelMeaning::Kind;

std::vector<AtlasFace> faces_of(const Model& model) { return atlas_faces(model, find_atlases(model).at(0)); }

/// Where triangles are after all coordinates have moved.
std::vector<AtlasFace> moved(std::vector<AtlasFace> faces, const std::function<Vec2d(Vec2d)>& f) {
  for (AtlasFace& face : faces)
    for (Vec2d& uv : face.uv) uv = f(uv);
  return faces;
}

Vec2d quarter_turn(Vec2d uv) { return {1 - uv.y, uv.x}; }

Image8 bake(const Image8& image, Kind kind, const Model& model, const std::vector<AtlasFace>& from,
            const std::vector<AtlasFace>& to, int width, int height, int threads = 1) {
  Context context;
  context.threads = threads;
  const MipMap map = mip_map(image, {kind});
  const BakeSource source{&image, &map, {kind}};
  return baked({&source, 1}, texel_origins(to, from, tangent_turns(model, from, to), width, height, context),
               texel_slopes(to, from, width, height), context)[0];
}

TEST(Baked, WithoutMovesTheImageIsWhatItWas) {
  const Model model = test::textured(test::grid(3, 2), 1);
  const Image8 image = test::pattern(64, 64);
  const std::vector<AtlasFace> faces = faces_of(model);
  EXPECT_EQ(bake(image, Kind::color, model, faces, faces, 64, 64).pixels, image.pixels);
}

TEST(Baked, TexelsGoWithTheirTriangles) {
  const Model model = test::textured(test::grid(3, 2), 1);
  const Image8 image = test::pattern(48, 32);
  const std::vector<AtlasFace> faces = faces_of(model);
  const Image8 turned = bake(image, Kind::data, model, faces, moved(faces, quarter_turn), 32, 48);
  for (int y = 0; y < 32; ++y) {
    for (int x = 0; x < 48; ++x) {
      for (int k = 0; k < 3; ++k) ASSERT_EQ(turned.at(31 - y, x)[k], image.at(x, y)[k]) << x << ' ' << y;
    }
  }
}

TEST(Baked, NormalsTurnWithTheTangentsTheyAreSeenFrom) {
  Model model = test::textured(test::grid(3, 2), 2);
  Image8 image(8, 8, 3, ColorEncoding::linear);
  for (int y = 0; y < 8; ++y)
    for (int x = 0; x < 8; ++x) image.at(x, y)[0] = 255, image.at(x, y)[1] = image.at(x, y)[2] = 128;
  const std::vector<AtlasFace> from = faces_of(model), to = moved(from, quarter_turn);
  // Coordinates of the grid are (x, y): u runs to the right, v, which runs down in images, up the surface; so
  // bitangents, which run up in images, are -y. After the turn u' = 1 - v runs along -y and v' = u along x.
  // A normal along x is one along the new -v', that is minus the bitangent.
  const Image8 turned = bake(image, Kind::normal, model, from, to, 8, 8);
  EXPECT_NEAR(turned.at(3, 3)[0], 128, 1);
  EXPECT_NEAR(turned.at(3, 3)[1], 0, 1);
  // With tangents of its own the mesh keeps its frames.
  AttributeLayer tangents;
  tangents.semantic = Semantic::tangent;
  tangents.width = 4;
  tangents.values = {1, 0, 0, 1};
  tangents.corner_value.assign(std::size_t{3} * from.size(), ValueId{0});
  model.meshes[0].surface.layers.push_back(tangents);
  EXPECT_EQ(bake(image, Kind::normal, model, from, to, 8, 8).at(3, 3)[0], 255);
}

TEST(TangentTurns, AreThoseOfTheCoordinates) {
  const Model model = test::textured(test::grid(3, 2), 2);
  const std::vector<AtlasFace> from = faces_of(model);
  for (const double angle : {0.0, 0.3, -1.2}) {
    const auto turned = moved(from, [&](Vec2d uv) {
      return Vec2d{std::cos(angle) * uv.x - std::sin(angle) * uv.y,
                   std::sin(angle) * uv.x + std::cos(angle) * uv.y};
    });
    for (const auto& turn : tangent_turns(model, from, turned)) {
      // u' alone grows along (cos, -sin) in (u, v), and bitangents are -v.
      for (const float t : turn) EXPECT_NEAR(static_cast<double>(t), angle, 1e-6);
    }
  }
}

TEST(Baked, SmallerPlacesAreFiltered) {
  // Stripes of a texel each become their mean as light where a texel shows four of them.
  const Model model = test::textured(test::grid(1, 1), 1);
  Image8 image(64, 64, 1, ColorEncoding::srgb);
  for (int y = 0; y < 64; ++y)
    for (int x = 0; x < 64; ++x) *image.at(x, y) = x % 2 == 0 ? 0 : 255;
  const std::vector<AtlasFace> from = faces_of(model), to = moved(from, [](Vec2d uv) {
                                                         return Vec2d{uv.x / 4, uv.y};
                                                       });
  const Image8 baked = bake(image, Kind::color, model, from, to, 64, 64);
  for (int x = 1; x < 15; ++x) EXPECT_NEAR(*baked.at(x, 32), 188, 2);
}

TEST(Baked, GoesOnBeyondTriangles) {
  const Model model = test::textured(test::grid(1, 1), 1);
  Image8 image(16, 16, 3, ColorEncoding::srgb);
  std::ranges::fill(image.pixels, std::uint8_t{90});
  const std::vector<AtlasFace> from = faces_of(model), to = moved(from, [](Vec2d uv) {
                                                         return Vec2d{0.4 + uv.x / 5, 0.4 + uv.y / 5};
                                                       });
  for (const std::uint8_t x : bake(image, Kind::color, model, from, to, 32, 32).pixels) EXPECT_EQ(x, 90);
}

TEST(Baked, ThreadsDoNotMatter) {
  const Model model = test::textured(test::grid(9, 7), 1);
  const Image8 image = test::pattern(150, 130);
  const std::vector<AtlasFace> from = faces_of(model), to = moved(from, [](Vec2d uv) {
                                                         return Vec2d{uv.x * uv.x, std::sqrt(uv.y)};
                                                       });
  EXPECT_EQ(bake(image, Kind::color, model, from, to, 200, 100, 1).pixels,
            bake(image, Kind::color, model, from, to, 200, 100, 4).pixels);
}

TEST(FillBetween, LeavesWhatTrianglesCoverAndWhatIsMixedIntoIt) {
  const Model model = test::textured(test::grid(1, 1), 1);
  const std::vector<AtlasFace> half = moved(faces_of(model), [](Vec2d uv) { return Vec2d{uv.x / 2, uv.y}; });
  Image8 image = test::pattern(32, 32);
  for (int y = 0; y < 32; ++y) {
    for (int x = 0; x < 17; ++x) std::fill_n(image.at(x, y), 3, static_cast<std::uint8_t>(x < 16 ? 50 : 90));
  }
  fill_between(image, half, Context());
  for (int y = 0; y < 32; ++y) {
    for (int x = 0; x < 32; ++x) EXPECT_EQ(*image.at(x, y), x < 16 ? 50 : 90) << x << ' ' << y;
  }
}

TEST(FillBetween, SeveralOfAnySizesAreFilledAsEachAlone) {
  const Model model = test::small_charts(256);
  const std::vector<AtlasFace> faces = faces_of(model);
  Image8 grey(256, 256, 1, ColorEncoding::linear);
  for (std::size_t i = 0; i < grey.pixels.size(); ++i) grey.pixels[i] = static_cast<std::uint8_t>(i * 7);
  const std::vector<Image8> painted{test::pattern(256, 256), test::pattern(300, 200), grey};
  std::vector<Image8> together = painted;
  fill_between(together, faces, Context());
  for (std::size_t i = 0; i < painted.size(); ++i) {
    Image8 alone = painted[i];
    fill_between(alone, faces, Context());
    EXPECT_EQ(together[i].pixels, alone.pixels) << i;
    EXPECT_NE(alone.pixels, painted[i].pixels) << i;
  }
}

}  // namespace
}  // namespace fovea
