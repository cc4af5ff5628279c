#include "fovea/surface/pose.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "fovea/base/error.h"
#include "support/meshes.h"

namespace fovea {
namespace {

/// A square in one node that an animation moves.
Model moved(const std::string& path, std::vector<float> times, std::vector<float> values, int width,
            Interpolation interpolation) {
  Model model = test::model_of(test::grid(1, 1));
  AnimationSampler sampler;
  sampler.input = Accessor::from_floats(times, 1);
  sampler.output = Accessor::from_floats(values, width);
  sampler.interpolation = interpolation;
  Animation animation;
  animation.samplers = {sampler};
  animation.channels = {{0, 0, path, {}}};
  model.animations = {animation};
  return model;
}

double x_at(const Model& model, double time) { return pose_at(model, 0, time).node_world[0](0, 3); }

TEST(Pose, LinearKeysAreMixed) {
  const Model model =
      moved("translation", {1, 2, 4}, {0, 0, 0, 10, 0, 0, 20, 0, 0}, 3, Interpolation::linear);
  EXPECT_DOUBLE_EQ(x_at(model, 0), 0);
  EXPECT_DOUBLE_EQ(x_at(model, 1.25), 2.5);
  EXPECT_DOUBLE_EQ(x_at(model, 3), 15);
  EXPECT_DOUBLE_EQ(x_at(model, 99), 20);
  EXPECT_DOUBLE_EQ(duration_s(model.animations[0]), 4);
}

TEST(Pose, StepsHoldTheirKey) {
  const Model model = moved("translation", {1, 2}, {3, 0, 0, 10, 0, 0}, 3, Interpolation::step);
  EXPECT_DOUBLE_EQ(x_at(model, 1.99), 3);
  EXPECT_DOUBLE_EQ(x_at(model, 2), 10);
}

TEST(Pose, SplinesFollowTheirTangents) {
  // Keys 2 seconds apart with the values and slopes of t³: a cubic spline is t³ itself.
  const Model model = moved("translation", {1, 3},
                            {0, 0, 0, 1, 0, 0, 3, 0, 0,  // in-tangent, value, out-tangent
                             27, 0, 0, 27, 0, 0, 0, 0, 0},
                            3, Interpolation::cubic_spline);
  for (const double t : {1.0, 1.5, 2.0, 2.75, 3.0}) EXPECT_NEAR(x_at(model, t), t * t * t, 1e-9);
}

TEST(Pose, RotationsTakeTheShortWayAtEvenSpeed) {
  // A quarter turn about z, the second key given with the opposite sign.
  const auto h = static_cast<float>(std::sqrt(0.5));
  const Model model = moved("rotation", {0, 1}, {0, 0, 0, 1, 0, 0, -h, -h}, 4, Interpolation::linear);
  for (const double t : {0.0, 0.25, 0.5, 1.0}) {
    const Mat4 world = pose_at(model, 0, t).node_world[0];
    EXPECT_NEAR(std::atan2(world(1, 0), world(0, 0)), t * std::numbers::pi / 2, 1e-6);
  }
}

TEST(Pose, MorphTargetsMoveVerticesAndNormals) {
  Model model = test::model_of(test::morph_strip(4));
  model.meshes[0].morph_weights = {0.5, 0};
  const Pose pose = rest_pose(model);
  const PosedSurface surface = posed_surface(model, pose, instances(model, pose)[0]);
  const TriMesh& mesh = model.meshes[0].surface;
  for (std::size_t v = 0; v < mesh.vertex_count(); ++v) {
    const Vec3f expected = mesh.positions[v] + mesh.position_morphs[0][v] * 0.5f;
    EXPECT_LT(length(surface.positions[v] - expected), 1e-6f);
  }
  for (const Vec3f& n : surface.normals) EXPECT_NEAR(length(n), 1, 1e-5);
}

TEST(Pose, AnimatedWeightsReplaceTheMeshes) {
  Model model = test::model_of(test::morph_strip(4));
  Animation animation;
  AnimationSampler sampler;
  sampler.input = Accessor::from_floats({0, 1}, 1);
  sampler.output = Accessor::from_floats({0, 0, 1, 0.5f}, 1);
  animation.samplers = {sampler};
  animation.channels = {{0, 0, "weights", {}}};
  model.animations = {animation};
  EXPECT_EQ(pose_at(model, 0, 0.5).morph_weights[0], (std::vector<double>{0.5, 0.25}));
}

//   joint 1 at x = 0, joint 2 at the strip's middle: turning joint 2 bends the right half up
TEST(Pose, JointsBendTheSurface) {
  Model model = test::skinned_model(8);
  model.nodes[2].rotation = {0, 0, std::sqrt(0.5), std::sqrt(0.5)};  // a quarter turn about z
  const Pose pose = rest_pose(model);
  const PosedSurface surface = posed_surface(model, pose, instances(model, pose)[0]);
  const TriMesh& mesh = model.meshes[0].surface;
  for (std::size_t v = 0; v < mesh.vertex_count(); ++v) {
    const Vec3f p = mesh.positions[v];
    // The left end is held by the first joint, the right one turned by the second.
    const Vec3f expected = p.x == 0 ? p : Vec3f{4 - p.y, 4, 0};
    if (p.x == 0 || p.x == 8) {
      EXPECT_LT(length(surface.positions[v] - expected), 1e-5f);
    }
  }
}

// Files may store joints as signed bytes or floats, and any weight.
TEST(Pose, JointsThatAreNotThereAndWeightsThatAreNoneMoveNothing) {
  Model model = test::skinned_model(4);
  const Pose pose = rest_pose(model);
  const std::vector<Vec3f> at_rest = posed_surface(model, pose, instances(model, pose)[0]).positions;
  TriMesh& mesh = model.meshes[0].surface;
  AttributeLayer &joints = *mesh.find(Semantic::joints), &weights = *mesh.find(Semantic::weights);
  for (std::size_t v = 0; v < joints.size(); ++v) {
    joints.value(ValueId{v})[2] = v % 2 == 0 ? -128.0f : 1e30f;
    joints.value(ValueId{v})[3] = 0;
  }
  for (std::size_t v = 0; v < weights.size(); ++v) {
    weights.value(ValueId{v})[2] = 1;
    weights.value(ValueId{v})[3] = std::nanf("");
  }
  EXPECT_EQ(posed_surface(model, pose, instances(model, pose)[0]).positions, at_rest);
}

TEST(Pose, ASkinnedMeshIsPlacedByItsJointsAlone) {
  Model model = test::skinned_model(4);
  const Pose before = rest_pose(model);
  const PosedSurface rest = posed_surface(model, before, instances(model, before)[0]);
  model.nodes[0].translation = {100, 0, 0};
  const Pose after = rest_pose(model);
  EXPECT_EQ(posed_surface(model, after, instances(model, after)[0]).positions, rest.positions);
}

TEST(Pose, NormalsStayUprightUnderUnevenScale) {
  Model model = test::model_of(test::wavy_grid(8, 8, 0.1));
  model.nodes[0].scale = {1, 3, -2};
  const Pose pose = rest_pose(model);
  const PosedSurface surface = posed_surface(model, pose, instances(model, pose)[0]);
  EXPECT_TRUE(surface.mirrored);
  const TriMesh& mesh = model.meshes[0].surface;
  const AttributeLayer& normal = *mesh.find(Semantic::normal);
  for (std::size_t f = 0; f < mesh.face_count(); ++f) {
    Vec3f p[3], mean;
    for (int k = 0; k < 3; ++k) {
      const CornerId c = corner(FaceId{f}, k);
      p[k] = surface.positions[mesh.vertex(c).index()];
      mean += surface.normals[normal.corner_value[c.index()].index()] / 3;
    }
    // The instance mirrors: the triangles' order turns, their outside does not.
    const Vec3f face = -normalized(cross(p[1] - p[0], p[2] - p[0]));
    EXPECT_GT(dot(face, normalized(mean)), 0.95f);
  }
}

TEST(Pose, InstancesOfANodeAreAllShown) {
  Model model = test::model_of(test::grid(1, 1));
  model.nodes[0].translation = {0, 5, 0};
  model.nodes[0].instances = {compose({1, 0, 0}, {}, {1, 1, 1}), compose({2, 0, 0}, {}, {1, 1, 1})};
  const auto shown = instances(model, rest_pose(model));
  ASSERT_EQ(shown.size(), 2u);
  EXPECT_EQ(transform_point(shown[1].world, {}), (Vec3d{2, 5, 0}));
}

TEST(Pose, PointsAreWhereTheSurfaceHasThem) {
  Model model = test::skinned_model(8);
  TriMesh& mesh = model.meshes[0].surface;
  mesh.position_morphs = {std::vector<Vec3f>(mesh.vertex_count(), Vec3f{0, 0.5f, 1})};
  model.meshes[0].morph_weights = {0.5};
  const Pose pose = pose_at(model, 0, 0.7);
  const Instance instance = instances(model, pose)[0];
  const std::vector<CornerId> corners = first_corners(mesh);
  ASSERT_EQ(corners.size(), mesh.vertex_count());
  for (std::size_t v = 0; v < corners.size(); ++v) EXPECT_EQ(mesh.vertex(corners[v]), VertexId{v});
  EXPECT_EQ(posed_points(model, pose, instance, corners), posed_surface(model, pose, instance).positions);
}

TEST(Pose, VerticesWithoutTrianglesGoWithTheInstance) {
  Model model = test::model_of(test::grid(1, 1));
  model.meshes[0].surface.positions.emplace_back(1.0f, 2.0f, 3.0f);
  model.nodes[0].translation = {0, 5, 0};
  EXPECT_FALSE(first_corners(model.meshes[0].surface)[4].valid());
  const Pose pose = rest_pose(model);
  EXPECT_EQ(posed_surface(model, pose, instances(model, pose)[0]).positions[4], (Vec3f{1, 7, 3}));
}

TEST(Pose, UnknownAnimationsAreRefused) {
  EXPECT_THROW(pose_at(test::model_of(test::grid(1, 1)), 0, 0), Error);
}

TEST(Pose, SamplersThatAreTooShortLeaveTheNodeAtRest) {
  const Model model = moved("translation", {0, 1}, {7, 0, 0}, 3, Interpolation::linear);
  EXPECT_DOUBLE_EQ(x_at(model, 0.5), 0);
}

}  // namespace
}  // namespace fovea
