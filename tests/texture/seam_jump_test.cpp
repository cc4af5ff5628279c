#include "fovea/texture/seam_jump.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "fovea/io/image_codec.h"
#include "support/meshes.h"
#include "support/reading.h"
#include "support/textured.h"

namespace fovea {
namespace {

/// The mesh with that picture as its base colour.
Model painted(TriMesh mesh, const Image8& image) {
  Model model = test::textured(std::move(mesh), 1);
  model.images[0].bytes = encode_png(image);
  return model;
}

/// Grey from 0 on the left to 255 on the right.
Image8 ramp(int width) {
  Image8 image(width, 4, 3, ColorEncoding::srgb);
  for (int y = 0; y < 4; ++y)
    for (int x = 0; x < width; ++x)
      std::fill_n(image.at(x, y), 3, static_cast<std::uint8_t>(255 * x / (width - 1)));
  return image;
}

SeamJump jump(const Model& model) {
  Context context;
  return seam_jump(model, context);
}

TEST(SeamJump, OneColorHasNone) {
  Image8 image(16, 16, 3, ColorEncoding::srgb);
  std::ranges::fill(image.pixels, std::uint8_t{70});
  const SeamJump found = jump(painted(test::cube(), image));
  EXPECT_EQ(found.edges, 12U) << "every side is a chart";
  EXPECT_NEAR(found.length, 24, 1e-6);
  EXPECT_NEAR(found.mean, 0, 1e-12);
  EXPECT_NEAR(found.largest, 0, 1e-12);
}

TEST(SeamJump, IsThatOfTheColorsOnBothSides) {
  // The line at u = 0 is that at u = 1. With clamping these are the first and the last column; with repeats
  // both look at the mean of the two.
  Model model = painted(test::open_cylinder(8, 3), ramp(64));
  EXPECT_NEAR(jump(model).mean, 0, 1e-6);
  model.samplers.push_back(
      {.wrap_u = Wrap::clamp, .wrap_v = Wrap::clamp, .mag_filter = {}, .min_filter = {}, .json = {}});
  model.textures[0].sampler = 0;
  const SeamJump found = jump(model);
  EXPECT_EQ(found.edges, 3U);
  EXPECT_NEAR(found.length, 2, 1e-6);
  EXPECT_NEAR(found.mean, 1, 1e-6);
  EXPECT_NEAR(found.largest, 1, 1e-6);
  // Where only one channel differs it is a third.
  Image8 red = ramp(64);
  for (int y = 0; y < red.height; ++y)
    for (int x = 0; x < red.width; ++x) red.at(x, y)[1] = red.at(x, y)[2] = 9;
  model.images[0].bytes = encode_png(red);
  EXPECT_NEAR(jump(model).mean, 1.0 / 3, 1e-6);
}

TEST(SeamJump, IsMeasuredAsTheSceneShowsIt) {
  Model model = painted(test::open_cylinder(8, 3), ramp(64));
  model.nodes[0].scale = {3, 3, 3};
  EXPECT_NEAR(jump(model).length, 6, 1e-5);
  model.scenes[0].nodes.clear();
  EXPECT_EQ(jump(model).edges, 0U) << "nothing shows it";
}

TEST(SeamJump, WhereTheTextureGoesOnThereIsNoSeam) {
  EXPECT_EQ(jump(painted(test::grid(4, 3), ramp(32))).edges, 0U);
  EXPECT_EQ(jump(test::model_of(test::cube())).edges, 0U) << "no texture";
}

TEST(SeamJump, BetweenMaterialsIsNone) {
  Model model = painted(test::two_part_grid(4, 2), ramp(32));
  model.materials[1].base_color = model.materials[0].base_color;
  EXPECT_EQ(jump(model).edges, 0U);
}

TEST(SeamJump, ImagesThatCannotBeDecodedAreReported) {
  Model model = painted(test::cube(), ramp(8));
  model.images[0].bytes = {1, 2, 3};
  Context context;
  EXPECT_EQ(seam_jump(model, context).edges, 0U);
  EXPECT_EQ(test::told(context, "image-not-shown"), 1U);
}

}  // namespace
}  // namespace fovea
