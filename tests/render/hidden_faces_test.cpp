#include "fovea/render/hidden_faces.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "fovea/base/error.h"
#include "support/meshes.h"

namespace fovea {
namespace {

/// A ball of radius 1 and one of radius 0.5 inside it.
Model ball_in_ball() { return test::model_of({test::icosphere(2), test::scaled(test::icosphere(2), 0.5f)}); }

Model with_material(Model model, const Material& material) {
  for (Mesh& mesh : model.meshes) {
    for (Part& part : mesh.surface.parts) part.material = 0;
  }
  model.materials = {material};
  return model;
}

std::vector<std::vector<FaceId>> hidden(const Model& model, const ViewOptions& views = {}, int threads = 2) {
  Context context;
  context.threads = threads;
  return hidden_faces(model, views, context);
}

TEST(HiddenFaces, AreThoseInsideAndNoOthers) {
  const auto found = hidden(ball_in_ball());
  EXPECT_TRUE(found[0].empty());
  EXPECT_EQ(found[1].size(), test::icosphere(2).face_count());
  EXPECT_TRUE(std::is_sorted(found[1].begin(), found[1].end()));
}

TEST(HiddenFaces, AreTheSameForAnyNumberOfThreads) {
  EXPECT_EQ(hidden(ball_in_ball(), {}, 1), hidden(ball_in_ball(), {}, 3));
}

TEST(HiddenFaces, NothingHidesBehindWhatLetsLightThrough) {
  Material blend, mask, glass, solid;
  blend.alpha_mode = AlphaMode::blend;
  mask.alpha_mode = AlphaMode::mask;
  glass.json = R"({"extensions":{"KHR_materials_transmission":{"transmissionFactor":1}}})";
  for (const Material& material : {blend, mask, glass}) {
    const auto found = hidden(with_material(ball_in_ball(), material));
    EXPECT_TRUE(found[0].empty());
    EXPECT_TRUE(found[1].empty());
  }
  EXPECT_FALSE(hidden(with_material(ball_in_ball(), solid))[1].empty());
}

/// The outer ball turned inside out: from outside one looks through its backs at its far side.
TEST(HiddenFaces, OneLooksThroughBacksUnlessBothSidesShow) {
  Model room = ball_in_ball();
  for (auto& t : room.meshes[0].surface.triangles) std::swap(t[1], t[2]);
  for (AttributeLayer& layer : room.meshes[0].surface.layers) {
    for (std::size_t c = 0; c < layer.corner_value.size(); c += 3)
      std::swap(layer.corner_value[c + 1], layer.corner_value[c + 2]);
  }
  EXPECT_TRUE(hidden(room)[1].empty());
  Material both;
  both.double_sided = true;
  EXPECT_FALSE(hidden(with_material(room, both))[1].empty());
}

TEST(HiddenFaces, AStripThatShowsSavesALargeFace) {
  // A floor of two triangles; a slab just above it leaves only the border free.
  //
  //      ________slab________
  //   ___________floor___________
  TriMesh floor = test::scaled(test::grid(1, 1), 10), slab = test::scaled(test::grid(1, 1), 9.6f);
  for (Vec3f& p : slab.positions) p = p + Vec3f{0.2f, 0.2f, 0.01f};
  const auto found = hidden(test::model_of({floor, slab}));
  EXPECT_TRUE(found[0].empty()) << "samples lie closer than the border is wide";
  EXPECT_TRUE(found[1].empty());
}

TEST(HiddenFaces, WhatIsShownAsAPointIsKept) {
  Model model = test::model_of(test::cube());
  model.nodes[0].scale = {0, 0, 0};
  EXPECT_TRUE(hidden(model)[0].empty());
}

TEST(HiddenFaces, MeshesThatNothingShowsHaveNone) {
  Model model = ball_in_ball();
  model.nodes[1].mesh = -1;
  EXPECT_TRUE(hidden(model)[1].empty());
}

TEST(HiddenFaces, WithoutCamerasThereAreNone) {
  ViewOptions cameras;
  cameras.set = ViewSet::cameras;
  EXPECT_THROW(hidden(ball_in_ball(), cameras), Error);
}

/// A camera above a cube sees its top alone, whatever its frame leaves out.
TEST(HiddenFaces, ACameraSeesWhatFacesIt) {
  Model model = test::model_of(test::cube());
  Camera camera;
  camera.perspective = true;
  camera.yfov_rad = 0.1;
  model.cameras.push_back(camera);
  Node node;
  node.camera = 0;
  node.translation = Vec3d{0, 0, 20};
  model.nodes.push_back(node);
  model.scenes[0].nodes.push_back(static_cast<int>(model.nodes.size()) - 1);
  ViewOptions cameras;
  cameras.set = ViewSet::cameras;
  const auto found = hidden(model, cameras);
  EXPECT_EQ(found[0].size(), 10u);
}

}  // namespace
}  // namespace fovea
