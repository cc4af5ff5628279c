#include "fovea/budget/camera_sights.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <vector>

#include "fovea/io/image_codec.h"
#include "support/meshes.h"
#include "support/pictures.h"
#include "support/textured.h"

namespace fovea {
namespace {

/// In front of the middle of a square of side 1, seeing `seen` of its sides; from behind if below 0.
View onto_middle(double seen) {
  View view;
  view.eye = {0.5, 0.5, seen};
  view.half_height = 0.5;
  if (seen < 0) {
    view.right = {-1, 0, 0};
    view.back = {0, 0, -1};
  }
  return view;
}

ImageViewers sights_by(const Model& model, const std::vector<View>& views, int size) {
  Context context;
  const RenderScene scene = make_render_scene(model, rest_pose(model), context);
  return camera_sights(model, scene, views, size, context);
}

TEST(CameraSights, EachPixelLooksWhereItIsShown) {
  const Model model = test::textured(test::grid(4, 4), 1);
  const Atlas atlas = find_atlases(model).front();
  const ImageViewers viewers = sights_by(model, {onto_middle(0.25)}, 64);
  const std::vector<ImageSights::Sight> sights = viewers.sights(atlas);
  ASSERT_EQ(sights.size(), 64u * 64u);
  for (std::size_t i = 0; i < sights.size(); ++i) {
    const double x = 0.375 + 0.25 * (static_cast<double>(i % 64) + 0.5) / 64;
    EXPECT_NEAR(sights[i].uv.x, x, 1e-6);
    EXPECT_NEAR(std::abs(sights[i].uv.y - 0.5),
                std::abs(0.25 * ((static_cast<double>(i / 64) + 0.5) / 64 - 0.5)), 1e-6);
    EXPECT_NEAR(sights[i].slopes.dx.x, 0.25 / 64, 1e-7);
    EXPECT_NEAR(sights[i].slopes.dx.y, 0, 1e-7);
    EXPECT_NEAR(std::abs(sights[i].slopes.dy.y), 0.25 / 64, 1e-7);
  }
}

TEST(CameraSights, AWideCameraLooksToBothSides) {
  const Model model = test::textured(test::grid(4, 4), 1);
  View wide = onto_middle(0.25);
  wide.aspect = 2;
  const std::vector<ImageSights::Sight> sights =
      sights_by(model, {wide}, 64).sights(find_atlases(model).front());
  ASSERT_EQ(sights.size(), 128u * 64u);
  for (std::size_t i = 0; i < 128; ++i)
    EXPECT_NEAR(sights[i].uv.x, 0.25 + 0.5 * (static_cast<double>(i) + 0.5) / 128, 1e-6);
}

TEST(CameraSights, FewerLooksOfManyPixels) {
  const Model model = test::textured(test::grid(4, 4), 1);
  const ImageViewers viewers = sights_by(model, {onto_middle(1), onto_middle(0.5)}, 512);
  const std::size_t looks = viewers.sights(find_atlases(model).front()).size();
  EXPECT_LE(looks, 32768u);
  EXPECT_GT(looks, 16000u);
}

TEST(CameraSights, NobodyLooksFromBehind) {
  const Model model = test::textured(test::grid(4, 4), 1);
  EXPECT_TRUE(sights_by(model, {onto_middle(-1)}, 64).sights(find_atlases(model).front()).empty());
}

/// Mean difference over squares of 8 texels a side that `is_in` their column and row.
template <class IsIn>
double difference(const Image8& a, const Image8& b, IsIn&& is_in) {
  double sum = 0, count = 0;
  for (int y = 0; y < a.height; ++y) {
    for (int x = 0; x < a.width; ++x) {
      if (!is_in(x / 8, y / 8)) continue;
      for (int c = 0; c < a.channels; ++c) {
        sum += std::abs(static_cast<int>(a.at(x, y)[c]) - static_cast<int>(b.at(x, y)[c]));
        ++count;
      }
    }
  }
  return sum / count;
}

TEST(CameraSights, WhatNoPictureShowsIsSmooth) {
  Model model = test::textured(test::grid(16, 16), 1);
  const Image8 picture = test::pattern(128, 128);
  model.images[0].bytes = encode_png(picture);
  const ImageViewers viewers = sights_by(model, {onto_middle(0.25)}, 64);  // two pixels to a texel
  const Image8 shown = viewers.shown(0, picture);
  const auto is_middle = [](int x, int y) { return x >= 6 && x < 10 && y >= 6 && y < 10; };
  const auto is_rim = [](int x, int y) { return x < 2 || y < 2 || x >= 14 || y >= 14; };
  EXPECT_LT(difference(shown, picture, is_middle), 0.5) << "in steps of a byte";
  EXPECT_GT(difference(shown, picture, is_rim), 10);
  EXPECT_EQ(viewers.shown(7, picture).pixels, picture.pixels) << "of no picture";
}

}  // namespace
}  // namespace fovea
