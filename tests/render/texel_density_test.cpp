#include "fovea/render/texel_density.h"

#include <gtest/gtest.h>

#include <cmath>

#include "support/meshes.h"
#include "support/textured.h"

namespace fovea {
namespace {

/// Densities go by 16 steps to an octave.
const double kStep = std::exp2(1.0 / 16);

void expect_about(double texels, double expected) {
  EXPECT_LE(texels, expected * (1 + 1e-9));
  EXPECT_GT(texels * kStep, expected * (1 - 1e-9));
}

/// A square of side 1 in front of the eye, which looks along −z; its image has 64 × 64 texels.
View onto_square(bool perspective) {
  View view;
  view.perspective = perspective;
  view.eye = {0.5, 0.5, 1};
  view.half_height = 0.5;
  return view;
}

std::vector<TexelDensity> seen(const Model& model, const View& view, int threads = 2) {
  Context context;
  context.threads = threads;
  const RenderScene scene = make_render_scene(model, rest_pose(model), context, nullptr, SceneTextures::none);
  return texel_densities(model, scene, std::vector{view, view}, 64, context);
}

TEST(TexelDensity, OfASquareThatFillsTheView) {
  for (const bool perspective : {false, true}) {
    const auto found = seen(test::textured(test::grid(3, 3), 1), onto_square(perspective));
    EXPECT_EQ(found[0].pixels(), 2u * 64 * 64);
    for (const double part : {0.0, 0.5, 0.99}) expect_about(found[0].quantile(part), 64);
  }
}

TEST(TexelDensity, SmallerOnThePictureIsDenser) {
  View view = onto_square(true);
  view.eye.z = 4;
  expect_about(seen(test::textured(test::grid(2, 2), 1), view)[0].quantile(0.5), 256);
}

TEST(TexelDensity, RepeatsCount) {
  Model model = test::textured(test::grid(1, 1), 2);
  model.materials[0].base_color->transform = TextureTransform{{}, 0.7, {3, 3}};
  model.materials[0].normal->transform = TextureTransform{{}, 0, {3, 2}};
  const auto found = seen(model, onto_square(false));
  expect_about(found[0].quantile(0.5), 192);
  expect_about(found[1].quantile(0.5), 128);  // along v, where there are fewer
}

TEST(TexelDensity, ForeshorteningAddsTexelsOneWayOnly) {
  View view = onto_square(false);
  view.half_height = 0.2;
  const double tilt = 1;
  view.back = {std::sin(tilt), 0, std::cos(tilt)};
  view.right = {std::cos(tilt), 0, -std::sin(tilt)};
  view.eye = Vec3d{0.5, 0.5, 0} + view.back;
  expect_about(seen(test::textured(test::grid(1, 1), 1), view)[0].quantile(0.5), 0.4 * 64);
}

TEST(TexelDensity, AnImageThatIsALineDoesNotCount) {
  Model model = test::textured(test::grid(1, 1), 1);
  model.materials[0].base_color->transform = TextureTransform{{}, 0, {1, 0}};
  const auto found = seen(model, onto_square(false));
  EXPECT_TRUE(found[0].is_used);
  EXPECT_EQ(found[0].pixels(), 0u);
}

TEST(TexelDensity, ImagesOfVariantsCountAndThoseOfNothingDoNot) {
  Model model = test::textured(test::grid(1, 1), 3);
  Material other;
  other.base_color = TextureRef{2, 0, {}};
  model.materials.push_back(other);
  EXPECT_FALSE(seen(model, onto_square(false))[2].is_used);
  model.meshes[0].surface.parts[0].json =
      R"({"extensions": {"KHR_materials_variants": {"mappings": [{"material": 1, "variants": [0]}]}}})";
  expect_about(seen(model, onto_square(false))[2].quantile(0.5), 64);
}

TEST(TexelDensity, IsTheSameForAnyNumberOfThreads) {
  const Model model = test::textured(test::wavy_grid(12, 12, 0.2), 1);
  const double one = seen(model, onto_square(true), 1)[0].quantile(0.3);
  EXPECT_EQ(seen(model, onto_square(true), 4)[0].quantile(0.3), one);
}

TEST(NeededScales, KeepATexelToThePixel) {
  std::vector<TexelDensity> densities(4);
  for (int i = 0; i < 1000; ++i) densities[0].add(i < 80 ? 16 : 512);
  for (int i = 0; i < 1000; ++i) densities[1].add(i < 120 ? 16 : 512);
  densities[0].is_used = densities[1].is_used = densities[2].is_used = true;
  const std::vector<double> scales = needed_scales(densities, 128);
  EXPECT_DOUBLE_EQ(scales[0], 0.25);  // 8 % of the pixels may be coarser
  EXPECT_DOUBLE_EQ(scales[1], 1);     // 12 % may not, and images are never enlarged
  EXPECT_DOUBLE_EQ(scales[2], kUnseenScale);
  EXPECT_DOUBLE_EQ(scales[3], 1);
}

TEST(NeededScales, AreHalvesOfHalves) {
  std::vector<TexelDensity> densities(1);
  densities[0].add(256);
  densities[0].is_used = true;
  EXPECT_DOUBLE_EQ(needed_scales(densities, 128)[0], 0.5);
  EXPECT_DOUBLE_EQ(needed_scales(densities, 145)[0], 0.5);  // 0.88 texels to a pixel
  EXPECT_DOUBLE_EQ(needed_scales(densities, 160)[0], 1);    // 0.8 would be too few
}

}  // namespace
}  // namespace fovea
