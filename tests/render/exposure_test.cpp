#include "fovea/render/exposure.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "support/meshes.h"

namespace fovea {
namespace {

std::vector<VertexField> seen(const Model& model, ViewSet set = ViewSet::dodecahedron, int threads = 2) {
  Context context;
  context.threads = threads;
  const Pose pose = rest_pose(model);
  const RenderScene scene = make_render_scene(model, pose, context);
  ViewOptions options;
  options.set = set;
  const std::vector<View> views = views_of(options, model, pose, scene.sphere);
  return exposure(scene, model.meshes.size(), views, 256, context);
}

TEST(Exposure, OfAConvexSolidHalfOfEverythingIsSeen) {
  const VertexField field = seen(test::model_of(test::icosphere(2)))[0];
  for (const float x : field.values()) EXPECT_NEAR(x, 0.5f, 0.05f) << "pixels of outlines";
}

TEST(Exposure, WhatIsInsideIsNotSeen) {
  TriMesh inner = test::icosphere(2);
  for (Vec3f& p : inner.positions) p = p * 0.5f;
  const auto fields = seen(test::model_of({test::icosphere(2), inner}));
  EXPECT_EQ(*std::max_element(fields[1].values().begin(), fields[1].values().end()), 0.0f);
  EXPECT_GT(*std::min_element(fields[0].values().begin(), fields[0].values().end()), 0.4f);
}

TEST(Exposure, WhatIsHalfHiddenIsSeenLess) {
  // A wall before the left half of a sheet, as a camera above sees it.
  TriMesh sheet = test::grid(20, 20), wall = test::grid(2, 2);
  for (Vec3f& p : wall.positions) p = {0.5f * p.x, p.y, 0.1f};
  const VertexField field = seen(test::model_of({sheet, wall}), ViewSet::octahedron)[0];
  double left = 0, right = 0;
  for (std::size_t v = 0; v < field.size(); ++v) {
    const float x = sheet.positions[v].x, value = field.values()[v];
    if (x < 0.35f) left += static_cast<double>(value);
    if (x > 0.65f) right += static_cast<double>(value);
  }
  EXPECT_LT(left, 0.3 * right);
}

TEST(Exposure, VerticesWithoutAPixelGetTheMean) {
  // The left half of the sheet is a thousand times finer than a pixel.
  TriMesh mesh = test::grid(40, 40);
  TriMesh dust = test::grid(4, 4);
  for (Vec3f& p : dust.positions) p = p * 1e-4f;
  const auto fields = seen(test::model_of({mesh, dust}), ViewSet::octahedron);
  for (const float x : fields[1].values()) EXPECT_EQ(x, fields[1].values()[0]);
}

TEST(Exposure, IsTheSameForAnyNumberOfThreads) {
  const Model model = test::model_of(test::torus(24, 12));
  EXPECT_EQ(seen(model, ViewSet::dodecahedron, 1), seen(model, ViewSet::dodecahedron, 3));
}

TEST(Exposure, MeshesThatAreNotShownHaveNoField) {
  Model model = test::model_of({test::cube(), test::cube()});
  model.nodes[1].mesh = -1;
  const auto fields = seen(model);
  EXPECT_EQ(fields[0].size(), 8u);
  EXPECT_TRUE(fields[1].empty());
}

}  // namespace
}  // namespace fovea
