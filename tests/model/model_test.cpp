#include "fovea/model/model.h"

#include <gtest/gtest.h>

#include <functional>
#include <limits>
#include <string>

#include "fovea/base/error.h"
#include "support/meshes.h"

namespace fovea::test {
namespace {

// A few multiplications of numbers of order 10.
constexpr double kTolerance = 1e-12;

Vec3d origin_of(const Mat4& m) { return transform_point(m, {0, 0, 0}); }

void expect_near(Vec3d a, Vec3d b) { EXPECT_NEAR(length(a - b), 0, kTolerance); }

Node node_at(Vec3d translation, std::vector<int> children = {}) {
  Node node;
  node.translation = translation;
  node.children = std::move(children);
  return node;
}

//   2 -> 1 -> 0: children before their parents
TEST(WorldTransforms, FollowTheHierarchyInAnyOrder) {
  Model model;
  model.nodes = {node_at({1, 0, 0}), node_at({0, 1, 0}, {0}), node_at({0, 0, 1}, {1})};
  model.nodes[2].scale = {2, 2, 2};
  const auto world = world_transforms(model);
  ASSERT_EQ(world.size(), 3u);
  expect_near(origin_of(world[2]), {0, 0, 1});
  expect_near(origin_of(world[1]), {0, 2, 1});
  expect_near(origin_of(world[0]), {2, 2, 1});
}

TEST(WorldTransforms, AMatrixReplacesTheThreeParts) {
  Model model;
  model.nodes = {node_at({1, 0, 0})};
  model.nodes[0].matrix = compose({0, 5, 0}, {}, {1, 1, 1});
  expect_near(origin_of(world_transforms(model)[0]), {0, 5, 0});
}

TEST(WorldTransforms, ACycleIsAnErrorNotALoop) {
  Model model;
  model.nodes = {node_at({}, {1}), node_at({}, {0})};
  EXPECT_THROW(world_transforms(model), Error);
}

TEST(MeshInstances, CountEachNodeThatShowsTheMesh) {
  Model model = model_of(tetrahedron());
  model.nodes.push_back(node_at({3, 0, 0}));
  model.nodes[1].mesh = 0;
  model.scenes[0].nodes = {0, 1};
  const auto instances = mesh_instances(model);
  ASSERT_EQ(instances[0].size(), 2u);
  expect_near(origin_of(instances[0][1]), {3, 0, 0});
}

TEST(MeshInstances, NodesOutsideOfTheSceneShowNothing) {
  Model model = model_of(tetrahedron());
  model.scenes[0].nodes.clear();
  EXPECT_TRUE(mesh_instances(model)[0].empty());
  EXPECT_TRUE(bounds(model).empty());
  model.scenes.clear();
  EXPECT_EQ(mesh_instances(model)[0].size(), 1u) << "without scenes every node counts";
}

TEST(MeshInstances, GpuInstancesMultiply) {
  Model model = model_of(tetrahedron());
  model.nodes[0].translation = {0, 10, 0};
  model.nodes[0].instances = {compose({1, 0, 0}, {}, {1, 1, 1}), compose({2, 0, 0}, {}, {1, 1, 1})};
  const auto instances = mesh_instances(model);
  ASSERT_EQ(instances[0].size(), 2u);
  expect_near(origin_of(instances[0][1]), {2, 10, 0});
}

TEST(MeshInstances, ASkinnedMeshStandsWhereItsJointsPutIt) {
  Model model = skinned_model(4);
  model.nodes[0].translation = {100, 0, 0};  // Ignored, as glTF says.
  model.nodes[1].translation = {0, 7, 0};    // The root joint.
  const auto instances = mesh_instances(model);
  ASSERT_EQ(instances[0].size(), 1u);
  expect_near(origin_of(instances[0][0]), {0, 7, 0});
}

TEST(Bounds, OfAllInstancesInTheWorld) {
  Model model = model_of(cube());
  model.nodes[0].translation = {5, 0, 0};
  model.nodes[0].scale = {2, 1, 1};
  const Box box = bounds(model);
  expect_near(box.low, {3, -1, -1});
  expect_near(box.high, {7, 1, 1});
}

TEST(Counts, StoredOnceDrawnAsOftenAsShown) {
  Model model = model_of(cube());
  model.nodes.push_back(model.nodes[0]);
  model.scenes[0].nodes = {0, 1};
  model.images.resize(2);
  model.images[0].bytes.resize(10);
  model.images[1].bytes.resize(5);
  const ModelCounts c = counts(model);
  EXPECT_EQ(c.triangles, 12u);
  EXPECT_EQ(c.triangles_drawn, 24u);
  EXPECT_EQ(c.vertices, 8u);
  EXPECT_EQ(c.split_vertices, 24u);
  EXPECT_EQ(c.image_bytes, 15u);
}

TEST(Counts, EmptyModel) {
  EXPECT_EQ(counts(Model{}).triangles, 0u);
  EXPECT_TRUE(bounds(Model{}).empty());
}

TEST(TriMesh, FindsLayersByMeaningAndSet) {
  TriMesh mesh = cube();
  ASSERT_NE(mesh.find(Semantic::uv), nullptr);
  EXPECT_EQ(mesh.find(Semantic::uv)->width, 2);
  EXPECT_EQ(mesh.find(Semantic::uv, 1), nullptr);
  EXPECT_EQ(mesh.find(Semantic::tangent), nullptr);
}

TEST(TriMesh, EveryFamilyKeepsTheInvariants) {
  for (const auto& [name, mesh] : all_families()) EXPECT_NO_THROW(check(mesh)) << name;
}

struct Damage {
  std::string name;
  std::function<void(TriMesh&)> apply;
};

TEST(TriMesh, CheckFindsEveryBrokenInvariant) {
  const std::vector<Damage> damages{
      {"position not finite", [](TriMesh& m) { m.positions[1].y = std::numeric_limits<float>::quiet_NaN(); }},
      {"vertex out of range", [](TriMesh& m) { m.triangles[0][1] = VertexId{m.vertex_count()}; }},
      {"no vertex", [](TriMesh& m) { m.triangles[0][1] = VertexId{}; }},
      {"vertex twice", [](TriMesh& m) { m.triangles[0][1] = m.triangles[0][0]; }},
      {"face_part size", [](TriMesh& m) { m.face_part.pop_back(); }},
      {"part out of range", [](TriMesh& m) { m.face_part[0] = 1; }},
      {"corner map size", [](TriMesh& m) { m.layers[0].corner_value.pop_back(); }},
      {"width", [](TriMesh& m) { m.layers[0].width = 0; }},
      {"values size", [](TriMesh& m) { m.layers[0].values.pop_back(); }},
      {"value out of range", [](TriMesh& m) { m.layers[0].corner_value[0] = ValueId{m.layers[0].size()}; }},
      {"value of two vertices",
       [](TriMesh& m) { m.layers[0].corner_value[0] = m.layers[0].corner_value[1]; }},
      {"morph size", [](TriMesh& m) { m.position_morphs[0].pop_back(); }},
      {"layer morph size", [](TriMesh& m) { m.find(Semantic::normal)->morphs[0].pop_back(); }},
  };
  for (const Damage& damage : damages) {
    TriMesh mesh = morph_strip(3);
    ASSERT_NO_THROW(check(mesh));
    damage.apply(mesh);
    try {
      check(mesh);
      ADD_FAILURE() << damage.name << ": not found";
    } catch (const Error& e) {
      EXPECT_EQ(e.kind(), ErrorKind::internal) << damage.name;
    }
  }
}

}  // namespace
}  // namespace fovea::test
