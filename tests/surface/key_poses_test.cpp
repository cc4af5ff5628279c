#include "fovea/surface/key_poses.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <numbers>
#include <set>

#include "fovea/io/read.h"
#include "fovea/surface/rigid_distance.h"
#include "oracle/pose_oracle.h"
#include "support/meshes.h"
#include "support/reading.h"

namespace fovea {
namespace {

using ::testing::ElementsAre;

std::vector<KeyPose> poses_of(const Model& model, std::int64_t count = 8, int threads = 1) {
  Context context;
  context.threads = threads;
  return key_poses(model, {count}, context);
}

std::vector<std::string> names_of(const std::vector<KeyPose>& poses) {
  std::vector<std::string> names;
  for (const KeyPose& pose : poses) names.push_back(pose.name);
  return names;
}

/// Steps, so that what is between keys is what is at the key before.
Animation animation_of(int node, const std::string& path, const std::vector<float>& times,
                       const std::vector<float>& values, int width) {
  AnimationSampler sampler;
  sampler.input = Accessor::from_floats(times, 1);
  sampler.output = Accessor::from_floats(values, width);
  sampler.interpolation = Interpolation::step;
  Animation animation;
  animation.samplers = {sampler};
  animation.channels = {{0, node, path, {}}};
  return animation;
}

/// Turns a node about z by an angle at each time.
Animation turning(int node, const std::vector<float>& times, const std::vector<double>& angles_deg) {
  std::vector<float> rotations;
  for (const double angle : angles_deg) {
    const double half = angle * std::numbers::pi / 360;
    rotations.insert(rotations.end(),
                     {0, 0, static_cast<float>(std::sin(half)), static_cast<float>(std::cos(half))});
  }
  return animation_of(node, "rotation", times, rotations, 4);
}

/// A strip along x whose second joint, at the middle, bends.
Model bending(const std::vector<float>& times, const std::vector<double>& angles_deg) {
  Model model = test::skinned_model(8);
  model.animations = {turning(2, times, angles_deg)};
  return model;
}

TEST(KeyPoses, TheTypicalOneFirstThenTheFarthest) {
  // 54 is in the middle, 115 farther from it than 0.
  const Model model = bending({0, 1, 2, 3, 4}, {48, 0, 54, 115, 54});
  const std::vector<KeyPose> poses = poses_of(model, 3);
  EXPECT_THAT(names_of(poses), ElementsAre("animation 0 at 2 s", "animation 0 at 3 s", "animation 0 at 1 s"));
  EXPECT_EQ(poses[0].distance_rel, 0);
  EXPECT_GT(poses[1].distance_rel, poses[2].distance_rel);
  EXPECT_EQ(poses[1].pose.node_world, pose_at(model, 0, 3).node_world);
}

TEST(KeyPoses, EqualTheOracle) {
  const std::vector<float> times = {0, 0.5, 1, 2, 2.5, 3, 7, 8, 9};
  Model model = bending(times, {10, 140, -35, 60, 61, 0, 90, 15, -70});
  // A second mesh that morphs, at times of its own: the union of the keys counts.
  TriMesh strip = test::morph_strip(6);
  const Model other = test::model_of(strip);
  model.meshes.push_back(other.meshes[0]);
  Node node;
  node.mesh = 1;
  node.translation = {0, 0, 4};
  model.scenes[0].nodes.push_back(static_cast<int>(model.nodes.size()));
  model.nodes.push_back(node);
  Animation weights = animation_of(3, "weights", {0, 1.5f, 9}, {0, 0, 1, 0, -0.5f, 1}, 1);
  model.animations[0].samplers.push_back(weights.samplers[0]);
  model.animations[0].channels.push_back({1, 3, "weights", {}});
  for (AnimationSampler& sampler : model.animations[0].samplers)
    sampler.interpolation = Interpolation::linear;

  // Ten keys in all: sevenths of each of the nine times between them make 64 candidates.
  const std::vector<double> keys = {0, 0.5, 1, 1.5, 2, 2.5, 3, 7, 8, 9};
  std::vector<double> all;
  for (std::size_t k = 0; k + 1 < keys.size(); ++k) {
    for (int i = 0; i < 7; ++i) all.push_back(keys[k] + (keys[k + 1] - keys[k]) * i / 7);
  }
  all.push_back(9);
  std::vector<std::vector<Vec3d>> points;
  for (const double t : all) points.push_back(test::shown_points(model, pose_at(model, 0, t)));
  const std::vector<std::vector<double>> distances = test::all_distances(points);
  const double diagonal = bounds(model).diagonal();
  for (const std::size_t count : {1u, 4u, 64u}) {
    const std::vector<std::size_t> expected = test::farthest_points(distances, count, 1e-3 * diagonal);
    const std::vector<KeyPose> found = poses_of(model, static_cast<std::int64_t>(count));
    ASSERT_EQ(found.size(), expected.size());
    for (std::size_t k = 0; k < found.size(); ++k) {
      EXPECT_EQ(found[k].pose.node_world, pose_at(model, 0, all[expected[k]]).node_world) << found[k].name;
      double nearest = k == 0 ? 0 : std::numeric_limits<double>::infinity();
      for (std::size_t i = 0; i < k; ++i) nearest = std::min(nearest, distances[expected[i]][expected[k]]);
      EXPECT_NEAR(found[k].distance_rel, nearest / diagonal, 1e-7);
    }
  }
}

TEST(KeyPoses, AModelThatOnlyMovesHasOne) {
  Model model = test::model_of(test::cube());
  model.animations = {turning(0, {0, 1, 2}, {0, 90, 170}),
                      animation_of(0, "translation", {0, 1}, {0, 0, 0, 50, 60, 70}, 3)};
  EXPECT_EQ(poses_of(model).size(), 1u);
  // Neither does a skinned one whose first joint carries all.
  Model skinned = test::skinned_model(8);
  skinned.animations = {turning(1, {0, 1, 2}, {0, 90, 170})};
  EXPECT_EQ(poses_of(skinned).size(), 1u);
}

TEST(KeyPoses, WithoutAnimationsEveryTargetAlone) {
  // The second target moves texture coordinates only: it shows what rest shows.
  Model model = test::model_of(test::morph_strip(6));
  model.meshes[0].morph_weights = {0.25, 0.5};
  std::vector<KeyPose> poses = poses_of(model);
  ASSERT_THAT(names_of(poses), ElementsAre("rest", "target 0 of mesh 0", "target 1 of mesh 0"));
  EXPECT_EQ(poses[0].pose.morph_weights[0], (std::vector<double>{0.25, 0.5}));
  EXPECT_EQ(poses[1].pose.morph_weights[0], (std::vector<double>{1, 0}));
  model.meshes[0].morph_weights = {};
  EXPECT_THAT(names_of(poses_of(model)), ElementsAre("rest", "target 0 of mesh 0"));
}

TEST(KeyPoses, TargetsThatAnAnimationDrivesAreNotTakenAlone) {
  Model model = test::model_of(test::morph_strip(6));
  model.animations = {animation_of(0, "weights", {0, 1}, {0, 0, 0.5f, 1}, 1)};
  EXPECT_THAT(names_of(poses_of(model)), ElementsAre("animation 0 at 0 s", "animation 0 at 1 s"));
}

TEST(KeyPoses, TargetsThatNoAnimationDrivesAre) {
  Model model = bending({0, 1}, {0, 90});
  const Model other = test::model_of(test::morph_strip(6));
  model.meshes.push_back(other.meshes[0]);
  Node node;
  node.mesh = 1;
  model.scenes[0].nodes.push_back(static_cast<int>(model.nodes.size()));
  model.nodes.push_back(node);
  EXPECT_THAT(
      names_of(poses_of(model)),
      ::testing::UnorderedElementsAre("animation 0 at 0 s", "animation 0 at 1 s", "target 0 of mesh 1"));
}

TEST(KeyPoses, AnimationsOfWhatIsNotSeenDoNotCount) {
  Model model = test::model_of({test::cube(), test::grid(2, 2)});
  model.scenes[0].nodes = {0, 2};  // the second mesh is in no scene, the third node shows nothing
  model.nodes.emplace_back();
  model.animations = {turning(1, {0, 1}, {0, 90}),
                      turning(2, {0, 1}, {0, 90}),
                      animation_of(0, "pointer", {0, 1}, {0, 1}, 1),
                      {}};
  EXPECT_THAT(names_of(poses_of(model)), ElementsAre("rest"));
}

TEST(KeyPoses, WhatIsAboveAJointOrMeshCounts) {
  // A cube beside another in a node that turns.
  Model model = test::model_of({test::cube(), test::cube()});
  Node above;
  above.children = {1};
  above.translation = {5, 0, 0};
  model.nodes.push_back(above);
  model.scenes[0].nodes = {0, 2};
  model.animations = {turning(2, {0, 1}, {0, 45})};
  EXPECT_EQ(poses_of(model).size(), 2u);
}

TEST(KeyPoses, WhatHappensBetweenTwoKeysIsSeen) {
  Model model = bending({0, 1}, {0, 120});
  model.animations[0].samplers[0].interpolation = Interpolation::linear;
  const std::vector<KeyPose> poses = poses_of(model, 3);
  ASSERT_EQ(poses.size(), 3u);
  EXPECT_GT(poses[1].distance_rel, 0.4 *
                                       rigid_distance(test::shown_points(model, pose_at(model, 0, 0)),
                                                      test::shown_points(model, pose_at(model, 0, 1))) /
                                       bounds(model).diagonal());
  EXPECT_THAT(names_of({poses[1], poses[2]}),
              ::testing::UnorderedElementsAre("animation 0 at 0 s", "animation 0 at 1 s"));
}

TEST(KeyPoses, ManyKeysAreThinnedEvenly) {
  std::vector<float> times;
  std::vector<double> angles;
  for (int i = 0; i <= 1000; ++i) {
    times.push_back(static_cast<float>(i) / 100);
    angles.push_back(0.15 * i);
  }
  const std::vector<KeyPose> poses = poses_of(bending(times, angles), 64);
  // 64 times from 0 to 10 seconds; none as near to another as a thousandth of the diagonal.
  EXPECT_EQ(poses.size(), 64u);
  const std::set<std::string> names = [&] {
    const std::vector<std::string> list = names_of(poses);
    return std::set<std::string>(list.begin(), list.end());
  }();
  EXPECT_EQ(names.size(), 64u);
  EXPECT_TRUE(names.contains("animation 0 at 0 s"));
  EXPECT_TRUE(names.contains("animation 0 at 10 s"));
  EXPECT_TRUE(names.contains("animation 0 at 0.15873 s"));
}

TEST(KeyPoses, AnimationsShareByTheirDuration) {
  std::vector<float> long_times, short_times;
  std::vector<double> up, down;
  for (int i = 0; i <= 1000; ++i) {
    long_times.push_back(static_cast<float>(i) / 100);
    short_times.push_back(static_cast<float>(i) / 1000);
    up.push_back(0.15 * i);
    down.push_back(-0.15 * i);
  }
  Model model = bending(long_times, up);
  model.animations.push_back(turning(2, short_times, down));
  int of_first = 0, of_second = 0;
  for (const std::string& name : names_of(poses_of(model, 64))) ++(name[10] == '0' ? of_first : of_second);
  EXPECT_NEAR(of_first, 57, 1);  // ten elevenths
  EXPECT_NEAR(of_second, 6, 1);
}

TEST(KeyPoses, MoreAnimationsThanCandidatesAreThinnedToo) {
  Model model = test::skinned_model(8);
  model.animations.clear();
  for (int i = 0; i < 200; ++i) model.animations.push_back(turning(2, {1}, {0.7 * i}));
  const std::vector<KeyPose> poses = poses_of(model, 64);
  EXPECT_EQ(poses.size(), 64u);
  EXPECT_TRUE(
      std::all_of(poses.begin(), poses.end(), [](const KeyPose& p) { return p.name.ends_with("at 1 s"); }));
}

TEST(KeyPoses, PosesThatAreNoNumbersAreLeftOut) {
  constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
  Model model = test::skinned_model(8);
  model.animations = {
      animation_of(2, "translation", {0, 1, 2, 3}, {4, 0, 0, 5, 0, 0, 4, 0, 0, kNan, 0, 0}, 3)};
  EXPECT_THAT(names_of(poses_of(model)), ElementsAre("animation 0 at 0 s", "animation 0 at 1 s"));
  model.animations = {animation_of(2, "translation", {0}, {kNan, 0, 0}, 3)};
  EXPECT_THAT(names_of(poses_of(model)), ElementsAre("rest"));
}

TEST(KeyPoses, ThereIsAlwaysOne) {
  EXPECT_THAT(names_of(poses_of(Model())), ElementsAre("rest"));
  EXPECT_THAT(names_of(poses_of(test::model_of(test::empty_mesh()))), ElementsAre("rest"));
  for (const test::NamedMesh& named : test::all_families())
    EXPECT_FALSE(poses_of(test::model_of(named.mesh)).empty()) << named.name;
}

TEST(KeyPoses, ASampleOfALargeMeshWillDo) {
  // 40401 vertices in rows of 201, whose last quarter the target lifts.
  Model model = test::model_of(test::grid(200, 200));
  TriMesh& mesh = model.meshes[0].surface;
  std::vector<Vec3f>& lift = mesh.position_morphs.emplace_back();
  for (const Vec3f& p : mesh.positions) lift.emplace_back(0.0f, 0.0f, p.x > 0.75f ? 2 * (p.x - 0.75f) : 0.0f);
  const std::vector<KeyPose> poses = poses_of(model);
  ASSERT_EQ(poses.size(), 2u);
  const double expected = test::rigid_distance(test::shown_points(model, poses[0].pose),
                                               test::shown_points(model, poses[1].pose));
  EXPECT_NEAR(poses[1].distance_rel * bounds(model).diagonal(), expected, 0.02 * expected);
}

TEST(KeyPoses, AllInstancesAreSeen) {
  // Each mesh alone only moves; the two together change.
  Model model = test::model_of({test::cube(), test::cube()});
  model.nodes[1].instances = {compose({5, 0, 0}, {}, {1, 1, 1}), compose({0, 5, 0}, {}, {1, 1, 1})};
  model.animations = {turning(0, {0, 1}, {0, 45})};
  EXPECT_EQ(poses_of(model).size(), 2u);
}

TEST(KeyPoses, TheSameForAnyNumberOfThreads) {
  const Model model = bending({0, 1, 2, 3, 4}, {0, 20, 50, 80, 120});
  const std::vector<KeyPose> one = poses_of(model, 8, 1), three = poses_of(model, 8, 3);
  EXPECT_EQ(names_of(one), names_of(three));
  for (std::size_t k = 0; k < one.size(); ++k) EXPECT_EQ(one[k].distance_rel, three[k].distance_rel);
}

TEST(KeyPoses, CountsOutOfRangeAreRefused) {
  const Model model = test::model_of(test::cube());
  for (const std::int64_t count : {0, 65})
    test::expect_error([&] { poses_of(model, count); }, ErrorKind::usage, "", "key-poses");
}

// --- All of the motion -----------------------------------------------------------------------------------

std::vector<std::string> motion_names(const Model& model, double step_s, std::size_t most = 1000) {
  std::vector<std::string> names;
  for (const PoseSource& source : motion_poses(model, step_s, most)) names.push_back(source.name);
  return names;
}

TEST(MotionPoses, AreKeysAndWhatIsBetween) {
  const Model model = bending({0, 1, 1.1F, 2}, {0, 20, 50, 80});
  EXPECT_EQ(motion_names(model, 0.5),
            (std::vector<std::string>{"animation 0 at 0 s", "animation 0 at 0.5 s", "animation 0 at 1 s",
                                      "animation 0 at 1.5 s", "animation 0 at 2 s"}));
  EXPECT_EQ(motion_names(model, 5).size(), 2u);  // the first and the last
  const auto poses = motion_poses(model, 0.5, 1000);
  EXPECT_EQ(poses[1].pose(), pose_at(model, 0, 0.5));
}

TEST(MotionPoses, AreNoMoreThanAsked) {
  const Model model = bending({0, 10}, {0, 80});
  EXPECT_EQ(motion_names(model, 0.01).size(), 1000u);
  EXPECT_EQ(motion_names(model, 0.01, 7).size(), 7u);
}

TEST(MotionPoses, OfWhatDoesNotMoveThereAreNone) {
  EXPECT_TRUE(motion_names(test::model_of(test::cube()), 0.1).empty());
}

TEST(KeyPoses, OfRealModels) {
  for (const char* name : {"CesiumMan.glb", "Fox.glb", "KayKitKnight.glb", "MorphStressTest.glb"}) {
    const auto path = test::corpus_file(std::string("animated/") + name);
    if (!path) GTEST_SKIP() << "FOVEA_DATA is not set";
    Context context;
    const Model model = read_model(*path, {}, context);
    const std::vector<KeyPose> poses = poses_of(model);
    EXPECT_EQ(poses.size(), 8u) << name;
    std::vector<std::vector<Vec3d>> points;
    for (const KeyPose& pose : poses) {
      std::size_t animation = 0;
      double time_s = 0;
      ASSERT_EQ(std::sscanf(pose.name.c_str(), "animation %zu at %lf s", &animation, &time_s), 2)
          << pose.name;
      ASSERT_LT(animation, model.animations.size());
      EXPECT_LE(time_s, duration_s(model.animations[animation]) + 1e-4);
      points.push_back(test::shown_points(model, pose.pose));
    }
    const double diagonal = bounds(model).diagonal();
    for (std::size_t k = 1; k < poses.size(); ++k) {
      EXPECT_GT(poses[k].distance_rel, 0.03) << name;
      EXPECT_TRUE(k == 1 || poses[k].distance_rel <= poses[k - 1].distance_rel) << name;
      for (std::size_t i = 0; i < k; ++i) {
        EXPECT_GT(rigid_distance(points[i], points[k]), 0.95 * poses[k].distance_rel * diagonal)
            << poses[i].name << ", " << poses[k].name;
      }
    }
  }
}

}  // namespace
}  // namespace fovea
