#include "fovea/budget/seen_detail.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "support/meshes.h"
#include "support/textured.h"

namespace fovea {
namespace {

/// A square of side 1 in front of the eye, which looks along −z; its image has 64 × 64 texels.
View onto_square(double distance) {
  View view;
  view.eye = {0.5, 0.5, distance};
  view.half_height = 0.5;
  return view;
}

ResolutionMap seen(const Model& model, const std::vector<View>& views, int size) {
  Context context;
  const RenderScene scene = make_render_scene(model, rest_pose(model), context);
  return texel_resolution(scene, 0, views, size, context);
}

TEST(SeenDetail, PixelsPerTexel) {
  const Model model = test::textured(test::grid(4, 4), 1);
  const ResolutionMap map = seen(model, {onto_square(1)}, 128);
  EXPECT_EQ(map.columns, 8);
  EXPECT_EQ(map.rows, 8);
  for (const float pixels : map.pixels_per_texel) EXPECT_NEAR(pixels, 2, 1e-4);
  // From twice as far half of it, and the nearest of all views counts.
  for (const float pixels : seen(model, {onto_square(2)}, 128).pixels_per_texel) EXPECT_NEAR(pixels, 1, 1e-4);
  for (const float pixels : seen(model, {onto_square(2), onto_square(1)}, 128).pixels_per_texel)
    EXPECT_NEAR(pixels, 2, 1e-4);
}

TEST(SeenDetail, OutOfSightIsZero) {
  const Model model = test::textured(test::grid(8, 8), 1);
  View corner = onto_square(0.25);  // sees the middle quarter of each side
  for (const float pixels : seen(model, {corner}, 64).pixels_per_texel)
    EXPECT_TRUE(pixels == 0 || pixels > 3.9f);
  EXPECT_EQ(seen(model, {corner}, 64).pixels_per_texel[0], 0);
  EXPECT_GT(seen(model, {corner}, 64).pixels_per_texel[27], 0);
  // From behind.
  View behind = onto_square(-1);
  behind.right = {-1, 0, 0};
  behind.back = {0, 0, -1};
  for (const float pixels : seen(model, {behind}, 64).pixels_per_texel) EXPECT_EQ(pixels, 0);
}

TEST(SeenDetail, HiddenIsZero) {
  // A square before most of a larger one, which has the first image.
  Model model = test::textured(test::grid(16, 16), 2);
  TriMesh before = test::grid(1, 1);
  for (Vec3f& p : before.positions) p = {0.125f + 0.75f * p.x, 0.125f + 0.75f * p.y, 0.01f};
  Model both = test::model_of({test::grid(16, 16), before});
  both.materials = model.materials;
  both.images = model.images;
  both.textures = model.textures;
  both.samplers = model.samplers;
  both.materials.resize(2);
  both.materials[0].normal.reset();
  both.materials[1].base_color = model.materials[0].normal;
  both.meshes[0].surface.parts[0].material = 0;
  both.meshes[1].surface.parts[0].material = 1;
  const ResolutionMap map = seen(both, {onto_square(1)}, 256);
  EXPECT_GT(map.pixels_per_texel[0], 3);
  EXPECT_EQ(map.pixels_per_texel[3 * 8 + 3], 0) << "in the middle";
}

TEST(SeenDetail, HeightsMoveMostFromTheSide) {
  const Model model = test::textured(test::wavy_grid(8, 8, 0.01), 1);
  const HeightFieldSearch search = find_height_field(model);
  ASSERT_TRUE(search.field) << search.why_not;
  EXPECT_EQ(search.field->up, 2);
  Context context;
  const RenderScene scene = make_render_scene(model, rest_pose(model), context);
  const auto total = [&](double angle_deg) {
    const double angle = angle_deg * 3.14159265358979 / 180;
    const View view = view_from({0.5, 0.5 - 4 * std::sin(angle), 4 * std::cos(angle)}, {0.5, 0.5, 0}, 20);
    double sum = 0;
    for (const float w : height_weights(*search.field, scene, std::vector{view}, 128, context))
      sum += static_cast<double>(w) * static_cast<double>(w);
    return sum;
  };
  // As many pixels as are covered (cos), each moved by as many pixels as a unit upright takes (sin).
  const double unit = 128 / (2 * std::tan(10 * 3.14159265358979 / 180)) / 4;
  for (const double angle : {20.0, 40.0, 60.0}) {
    const double a = angle * 3.14159265358979 / 180;
    EXPECT_NEAR(total(angle) / (unit * unit * std::cos(a) * unit * unit * std::sin(a) * std::sin(a)), 1, 0.15)
        << angle;
  }
  View away = view_from({0.5, 0.5, 4}, {0.5, 0.5, 8}, 20);
  for (const float w : height_weights(*search.field, scene, std::vector{away}, 64, context)) EXPECT_EQ(w, 0);
}

}  // namespace
}  // namespace fovea
