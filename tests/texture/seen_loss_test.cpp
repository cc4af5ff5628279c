#include "fovea/texture/seen_loss.h"

#include <gtest/gtest.h>

#include <cmath>

#include "fovea/texture/bake.h"
#include "support/meshes.h"
#include "support/pictures.h"
#include "support/textured.h"

namespace fovea {
namespace {

constexpr TexelMeaning kColor{TexelMeaning::Kind::color};

/// White squares of `cell` texels on black.
Image8 checks(int size, int cell) {
  Image8 image = test::even(size, 0);
  for (int y = 0; y < size; ++y)
    for (int x = 0; x < size; ++x)
      if ((x / cell + y / cell) % 2 == 0)
        for (int k = 0; k < 3; ++k) image.at(x, y)[k] = 255;
  return image;
}

std::vector<AtlasFace> seen_faces(const Model& model) {
  return atlas_faces(model, find_atlases(model).at(0));
}

SeenLoss loss_of(const Model& model, const Image8& image, const std::vector<VertexField>& field = {}) {
  return {model, seen_faces(model), {mip_map(image, kColor)}, {kColor}, field};
}

TEST(SeenLoss, IsThatOfShownValues) {
  const Model model = test::textured(test::grid(3, 3), 1);
  const Image8 was = test::even(16, 100), is[] = {test::even(4, 110)};
  const PictureLosses found = loss_of(model, was).of(seen_faces(model), {}, is, {});
  for (std::size_t i = 0; i < kPictureSizes.size(); ++i) {
    EXPECT_NEAR(found.color[i], 3 * std::pow(10.0 / 255, 2), 1e-6);
    EXPECT_NEAR(found.all[i], found.color[i], 1e-9);
    EXPECT_NEAR(found.distance[i], std::sqrt(3.0) * 10 / 255, 1e-6);
  }
}

TEST(SeenLoss, IsNothingForTheSameImages) {
  const Model model = test::textured(test::grid(3, 3), 1);
  const Image8 image = checks(64, 4);
  const PictureLosses found = loss_of(model, image).of(seen_faces(model), {}, {&image, 1}, {});
  for (std::size_t i = 0; i < kPictureSizes.size(); ++i) EXPECT_EQ(found.all[i], 0);
}

TEST(SeenLoss, PicturesThatAreSmallSeeNoFineDetail) {
  // 4096 texels along a square whose diagonal has 512 to 2048 pixels: checks of two texels show as
  // grey in the smaller pictures, whatever the texture.
  const Model model = test::textured(test::grid(1, 1), 1);
  const Image8 fine = checks(4096, 2), grey[] = {test::even(64, 188)};
  const PictureLosses found = loss_of(model, fine).of(seen_faces(model), {}, grey, {});
  EXPECT_LT(found.color[0], 1e-4);
  EXPECT_LT(found.color[1], 1e-4);
  const Image8 coarse = checks(4096, 256);
  EXPECT_GT(loss_of(model, coarse).of(seen_faces(model), {}, grey, {}).color[0], 0.5);
}

TEST(SeenLoss, TrianglesThatAreLinesInTheTextureCount) {
  // The lower row of cells shows but a line of the texture; it is half of the surface.
  Model model = test::textured(test::grid(1, 2), 1);
  AttributeLayer& uv = model.meshes[0].surface.layers[0];
  for (std::size_t i = 0; i < uv.size(); ++i)
    uv.values[2 * i + 1] = std::max(0.0f, 2 * uv.values[2 * i + 1] - 1);
  Image8 image = test::even(64, 50);
  Image8 other[] = {test::even(64, 50)};
  for (int x = 0; x < 64; ++x)
    for (int k = 0; k < 3; ++k) other[0].at(x, 0)[k] = 150;
  const PictureLosses found = loss_of(model, image).of(seen_faces(model), {}, other, {});
  EXPECT_GT(found.color[2], 0.5 * 3 * std::pow(100.0 / 255, 2));
}

TEST(SeenLoss, CountsWhatIsLookedAt) {
  const Model model = test::textured(test::grid(2, 1), 1);
  const Image8 was = test::even(64, 100);
  Image8 is[] = {test::even(64, 100)};
  for (int y = 0; y < 64; ++y)
    for (int x = 0; x < 28; ++x)
      for (int k = 0; k < 3; ++k) is[0].at(x, y)[k] = 140;
  const auto& positions = model.meshes[0].surface.positions;
  std::vector<VertexField> left{VertexField(positions.size())}, right = left;
  for (std::size_t v = 0; v < positions.size(); ++v) {
    const VertexId id{static_cast<std::uint32_t>(v)};
    left[0][id] = positions[v].x < 0.5f ? 1.0f : 0.0f;
    right[0][id] = positions[v].x > 0.5f ? 1.0f : 0.0f;
  }
  const auto loss = [&](const std::vector<VertexField>& field) {
    return loss_of(model, was, field).of(seen_faces(model), {}, is, {}).color[1];
  };
  EXPECT_GT(loss(left), 5 * loss(right));
}

TEST(SeenLoss, NormalsThatTurnWithTheirFramesAreTheSame) {
  const Model model = test::textured(test::grid(1, 1), 1);
  Image8 was(8, 8, 3, ColorEncoding::linear), turned[] = {was};
  for (std::size_t i = 0; i < was.pixels.size(); i += 3) {
    was.pixels[i] = 255, was.pixels[i + 1] = 128, was.pixels[i + 2] = 128;
    turned[0].pixels[i] = 128, turned[0].pixels[i + 1] = 0, turned[0].pixels[i + 2] = 128;
  }
  const TexelMeaning normal{TexelMeaning::Kind::normal};
  const std::vector<AtlasFace> faces = seen_faces(model);
  const SeenLoss loss(model, faces, {mip_map(was, normal)}, {normal}, {});
  const float quarter = 1.5707964f;
  const std::vector<std::array<float, 3>> turns(faces.size(), {quarter, quarter, quarter});
  EXPECT_LT(loss.of(faces, turns, turned, {}).all[0], 1e-4);
  EXPECT_GT(loss.of(faces, {}, turned, {}).all[0], 0.1);
}

TEST(PictureLosses, AreWorseIfAnythingIs) {
  PictureLosses plain, other;
  plain.all = plain.color = plain.distance = {0.1, 0.1, 0.1};
  other = plain;
  EXPECT_FALSE(other.is_worse_somewhere(plain));
  other.all = {0.01, 0.01, 0.01};
  other.color[2] = 0.11;
  EXPECT_TRUE(other.is_worse_somewhere(plain));
  EXPECT_LT(other.mean(), plain.mean());
  // Less than half a step of a byte is nothing.
  plain = other = {};
  other.color[0] = 1e-6;
  EXPECT_FALSE(other.is_worse_somewhere(plain));
}

}  // namespace
}  // namespace fovea
