#include "fovea/surface/scene_surface.h"

#include <gtest/gtest.h>

#include "support/meshes.h"

namespace fovea {
namespace {

TEST(SceneSurface, HoldsEveryMeshOnceWhereItIsLargest) {
  Model model = test::model_of({test::single_triangle(), test::cube()});
  // The triangle a second time, twice as large and moved.
  Node large;
  large.mesh = 0;
  large.scale = {2, 2, 2};
  large.translation = {10, 0, 0};
  model.nodes.push_back(large);
  model.scenes[0].nodes.push_back(static_cast<int>(model.nodes.size()) - 1);
  const SceneSurface scene = scene_surface(model, rest_pose(model));
  EXPECT_EQ(scene.first_vertex, (std::vector<std::uint32_t>{0, 3, 11}));
  EXPECT_EQ(scene.first_triangle, (std::vector<std::uint32_t>{0, 1, 13}));
  for (std::uint32_t v = 0; v < 3; ++v) {
    const Vec3f own = model.meshes[0].surface.positions[v];
    EXPECT_EQ(scene.surface.positions[v], (own * 2.0f + Vec3f{10, 0, 0}));
  }
  for (std::size_t t = 1; t < 13; ++t) {
    for (const std::uint32_t v : scene.surface.triangles[t]) EXPECT_GE(v, 3u);
  }
}

TEST(SceneSurface, AMirroredMeshStillLooksOutward) {
  Model model = test::model_of(test::cube());
  model.nodes[0].scale = {-1, 1, 1};
  const Surface surface = scene_surface(model, rest_pose(model)).surface;
  for (const auto& t : surface.triangles) {
    const Vec3d a = surface.position(t[0]), b = surface.position(t[1]), c = surface.position(t[2]);
    EXPECT_GT(dot(cross(b - a, c - a), a + b + c), 0);
  }
}

TEST(SceneSurface, WhatNothingShowsHasNoTriangles) {
  Model model = test::model_of({test::single_triangle(), test::cube()});
  model.scenes[0].nodes = {1};
  const SceneSurface scene = scene_surface(model, rest_pose(model));
  EXPECT_EQ(scene.first_vertex, (std::vector<std::uint32_t>{0, 3, 11}));
  EXPECT_EQ(scene.first_triangle, (std::vector<std::uint32_t>{0, 0, 12}));
}

TEST(SceneSurface, FieldsAreSplitAndJoined) {
  const Model model = test::model_of({test::single_triangle(), test::cube()});
  const SceneSurface scene = scene_surface(model, rest_pose(model));
  VertexField field(11);
  for (std::size_t v = 0; v < 11; ++v) field.values()[v] = static_cast<float>(v);
  const std::vector<VertexField> fields = split(scene, field);
  ASSERT_EQ(fields.size(), 2u);
  EXPECT_EQ(fields[0].size(), 3u);
  EXPECT_EQ(fields[1].values()[0], 3);
  EXPECT_EQ(joined(fields), field);
}

}  // namespace
}  // namespace fovea
