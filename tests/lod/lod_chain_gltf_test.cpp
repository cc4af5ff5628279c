#include "fovea/lod/lod_chain_gltf.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <nlohmann/json.hpp>

#include "fovea/io/gltf_read.h"
#include "fovea/io/gltf_write.h"
#include "fovea/surface/pose.h"
#include "lod_chains.h"
#include "support/corner_soup.h"
#include "support/meshes.h"
#include "support/reading.h"
#include "support/textured.h"

namespace fovea {
namespace {

using Json = nlohmann::json;

LodChain gltf_chain_of(const Model& model, LodChainOptions options = test::quick_chain()) {
  Context context;
  return make_lod_chain(model, options, {}, context);
}

Model merged(const LodChain& chain, double vanish = 0) {
  Context context;
  return with_lods(chain, vanish, context);
}

std::vector<int> levels_of(const Node& node) {
  return Json::parse(node.json)["extensions"]["MSFT_lod"]["ids"].get<std::vector<int>>();
}
std::vector<double> coverage_of(const Node& node) {
  return Json::parse(node.json)["extras"]["MSFT_screencoverage"].get<std::vector<double>>();
}

/// The file's JSON as it is written.
Json written(const Model& model) {
  Context context;
  const GltfOutput output = write_gltf(model, false, "m", {}, context);
  return Json::parse(test::text_of(output.files.front().bytes));
}

AnimationChannel channel(int node, const char* path) { return {0, node, path, {}}; }

Animation moving(std::vector<AnimationChannel> channels, int width) {
  AnimationSampler sampler;
  sampler.input = Accessor::from_floats({0, 1}, 1);
  sampler.output =
      Accessor::from_floats(std::vector<float>(2 * static_cast<std::size_t>(width), 0.5f), width);
  Animation animation;
  animation.samplers = {sampler};
  animation.channels = std::move(channels);
  return animation;
}

TEST(LodGltf, TheNodeNamesItsLevels) {
  Model model = test::model_of(test::icosphere(3));
  model.nodes[0].translation = {1, 2, 3};
  model.nodes[0].name = "ball";
  model.nodes[0].json = R"({"extras":{"mine":1}})";
  const LodChain chain = gltf_chain_of(model);
  const Model all = merged(chain);
  ASSERT_EQ(all.nodes.size(), 4U);
  EXPECT_EQ(levels_of(all.nodes[0]), (std::vector<int>{1, 2, 3}));
  EXPECT_EQ(Json::parse(all.nodes[0].json)["extras"]["mine"], 1);
  EXPECT_EQ(all.scenes[0].nodes, model.scenes[0].nodes) << "levels are in no scene";
  for (std::size_t i = 1; i < 4; ++i) {
    EXPECT_EQ(all.nodes[i].name, "ball_LOD" + std::to_string(i));
    EXPECT_EQ(all.nodes[i].translation, model.nodes[0].translation);
    const std::size_t mesh = static_cast<std::size_t>(all.nodes[i].mesh);
    EXPECT_EQ(all.meshes[mesh].surface.face_count(), chain.levels[i].triangles);
  }
  const Json json = written(all);
  EXPECT_EQ(json["extensionsUsed"], Json({"MSFT_lod"}));
  EXPECT_FALSE(json.contains("extensionsRequired"));
}

/// Of a primitive, as the .gltf's buffer has them.
std::vector<std::uint32_t> indices_of(const Json& json, const Json& primitive,
                                      const std::vector<std::byte>& buffer) {
  const Json& accessor = json["accessors"][primitive["indices"].get<std::size_t>()];
  const Json& view = json["bufferViews"][accessor["bufferView"].get<std::size_t>()];
  const std::size_t size = accessor["componentType"] == 5123 ? 2 : 4;
  std::vector<std::uint32_t> indices(accessor["count"].get<std::size_t>(), 0);
  for (std::size_t i = 0; i < indices.size(); ++i)
    std::memcpy(&indices[i], buffer.data() + view.value("byteOffset", std::size_t{0}) + i * size, size);
  return indices;
}

TEST(LodGltf, LevelsMayShareTheirVertices) {
  for (Model model : {test::textured(test::torus(32, 16), 1), test::model_of(test::two_part_grid(16, 16)),
                      test::skinned_model(64), test::model_of(test::morph_strip(60))}) {
    LodChainOptions options = test::quick_chain();
    options.simplify.placement = Placement::half_edge;
    options.textures_follow = false;
    for (Vec3f& p : model.meshes[0].surface.positions) p.z += 0.1f * std::sin(7 * p.x) * std::sin(5 * p.y);
    const LodChain chain = gltf_chain_of(model, options);
    ASSERT_GE(chain.levels.size(), 3U);
    Context context;
    std::vector<int> level_of;
    const Model all = with_lods(chain, 0, context, &level_of);
    const GltfOutput output = write_gltf(all, false, "m", {}, context, level_of);
    const Json json = Json::parse(test::text_of(output.files[0].bytes));
    const Json& meshes = json["meshes"];
    ASSERT_EQ(meshes.size(), chain.levels.size());
    for (std::size_t p = 0; p < meshes[0]["primitives"].size(); ++p) {
      std::uint32_t before = kInvalid;
      for (const Json& mesh : meshes) {
        const Json& primitive = mesh["primitives"][p];
        EXPECT_EQ(primitive["attributes"], meshes[0]["primitives"][p]["attributes"]);
        EXPECT_EQ(primitive.value("targets", Json()), meshes[0]["primitives"][p].value("targets", Json()));
        std::vector<std::uint32_t> indices = indices_of(json, primitive, output.files[1].bytes);
        std::ranges::sort(indices);
        EXPECT_LT(indices.back(), before) << "a level uses a beginning";
        before = indices.back();
      }
    }
    // And each says what it said before.
    const GltfOutput glb = write_gltf(all, true, "m", {}, context, level_of);
    const Model again = read_gltf(glb.files[0].bytes, ".", "m.glb", ReadOptions{}, context);
    for (std::size_t m = 0; m < all.meshes.size(); ++m)
      EXPECT_EQ(test::corner_soup(again.meshes[m].surface), test::corner_soup(all.meshes[m].surface)) << m;
    EXPECT_LT(output.bytes.geometry, write_gltf(all, false, "m", {}, context).bytes.geometry);
  }
}

TEST(LodGltf, SharedVerticesHaveOneGrid) {
  LodChainOptions options = test::quick_chain();
  options.simplify.placement = Placement::half_edge;
  const LodChain chain = gltf_chain_of(test::model_of(test::icosphere(3)), options);
  Context context;
  std::vector<int> level_of;
  const Model all = with_lods(chain, 0, context, &level_of);
  WriteOptions write;
  write.quantize = true;
  write.compression = GeometryCompression::meshopt;
  const GltfOutput output = write_gltf(all, false, "m", write, context, level_of);
  const Json json = Json::parse(test::text_of(output.files[0].bytes));
  for (const Json& mesh : json["meshes"])
    EXPECT_EQ(mesh["primitives"][0]["attributes"], json["meshes"][0]["primitives"][0]["attributes"]);
}

TEST(LodGltf, VerticesOfMeshesThatAreNotThereAreRefused) {
  const Model model = test::model_of({test::cube(), test::tetrahedron()});
  Context context;
  for (const std::vector<int>& wrong : {std::vector<int>{-1, 1}, {-1, 2}, {0, -1}})
    test::expect_error([&] { write_gltf(model, true, "m", {}, context, wrong); }, ErrorKind::usage,
                       "/meshes/");
  // Meshes of other attributes keep their own vertices.
  const std::vector<int> other{-1, 0};
  const Json json =
      Json::parse(test::text_of(write_gltf(model, false, "m", {}, context, other).files[0].bytes));
  EXPECT_NE(json["meshes"][0]["primitives"][0]["attributes"],
            json["meshes"][1]["primitives"][0]["attributes"]);
}

TEST(LodGltf, CoverageHasOneMoreAndFalls) {
  const LodChain chain = gltf_chain_of(test::model_of(test::icosphere(3)));
  const double vanish = chain.levels.back().coverage / 2;
  const Model all = merged(chain, vanish);
  const std::vector<double> coverage = coverage_of(all.nodes[0]);
  ASSERT_EQ(coverage.size(), 4U);
  for (std::size_t i = 0; i < 3; ++i)
    EXPECT_NEAR(coverage[i], area_of(chain.levels[i + 1].coverage, chain.screen), 1e-6);
  EXPECT_NEAR(coverage[3], area_of(vanish, chain.screen), 1e-9);
  EXPECT_TRUE(std::ranges::is_sorted(coverage, std::greater{}));
  EXPECT_EQ(coverage_of(merged(chain).nodes[0]).back(), 0);
  test::expect_error([&] { merged(chain, 0.9); }, ErrorKind::usage, "--vanish");
}

TEST(LodGltf, LevelsShareTheSkin) {
  const Model model = test::skinned_model(64);
  const Model all = merged(gltf_chain_of(model));
  EXPECT_EQ(all.skins.size(), 1U);
  for (const int level : levels_of(all.nodes[0])) {
    EXPECT_EQ(all.nodes[static_cast<std::size_t>(level)].skin, 0);
    EXPECT_EQ(all.animations[0].channels.size(), model.animations[0].channels.size());
  }
}

TEST(LodGltf, WhatMovesANodeMovesItsLevels) {
  Model model = test::model_of(test::icosphere(3));
  model.nodes[0].name = "ball";
  model.nodes[0].scale = {2, 2, 2};
  model.animations = {moving({channel(0, "translation")}, 3)};
  const Model all = merged(gltf_chain_of(model));
  // The node keeps its transform and its animation, and its mesh goes to a child that names the levels.
  EXPECT_EQ(all.animations[0].channels.size(), 1U);
  EXPECT_EQ(all.animations[0].channels[0].node, 0);
  EXPECT_EQ(all.nodes[0].mesh, -1);
  ASSERT_EQ(all.nodes[0].children.size(), 1U);
  const Node& shown = all.nodes[static_cast<std::size_t>(all.nodes[0].children[0])];
  EXPECT_EQ(shown.name, "ball_LOD0");
  for (const int level : levels_of(shown)) {
    const Node& node = all.nodes[static_cast<std::size_t>(level)];
    EXPECT_EQ(node.local(), Mat4{}) << "below the same parent they have the same transform";
    EXPECT_EQ(shown.local(), Mat4{});
    EXPECT_TRUE(node.children.empty());
  }
  const Pose pose = pose_at(all, 0, 0.5);
  const std::vector<Instance> shown_now = instances(all, pose);
  ASSERT_EQ(shown_now.size(), 1U);
  EXPECT_EQ(transform_point(shown_now[0].world, {1, 0, 0}), (Vec3d{2.5, 0.5, 0.5}));
}

TEST(LodGltf, MorphWeightsOfLevelsFollow) {
  Model model = test::model_of(test::morph_strip(60));
  model.animations = {moving({channel(0, "weights")}, 2)};
  LodChainOptions options = test::quick_chain();
  options.levels = 3;
  const LodChain chain = gltf_chain_of(model, options);
  const Model all = merged(chain);
  const std::vector<int> levels = levels_of(all.nodes[0]);
  ASSERT_EQ(all.animations[0].channels.size(), 1 + levels.size());
  for (std::size_t i = 0; i < levels.size(); ++i) {
    EXPECT_EQ(all.animations[0].channels[i + 1].node, levels[i]);
    EXPECT_EQ(all.animations[0].channels[i + 1].sampler, 0);
  }
  // Also where the node's transform is animated, and the mesh has moved to a child.
  model.animations = {moving({channel(0, "translation"), channel(0, "weights")}, 3)};
  const Model moved = merged(gltf_chain_of(model, options));
  const int child = moved.nodes[0].children.at(0);
  EXPECT_EQ(moved.animations[0].channels[0].node, 0);
  EXPECT_EQ(moved.animations[0].channels[1].node, child);
  EXPECT_EQ(moved.animations[0].channels.size(),
            2 + levels_of(moved.nodes[static_cast<std::size_t>(child)]).size());
}

TEST(LodGltf, ChildrenStayWithTheNode) {
  Model model = test::model_of({test::icosphere(3), test::torus(24, 12)});
  model.nodes[0].children = {1};
  model.scenes[0].nodes = {0};
  const Model all = merged(gltf_chain_of(model));
  EXPECT_EQ(all.nodes[0].mesh, -1);
  ASSERT_EQ(all.nodes[0].children.size(), 2U);
  EXPECT_EQ(all.nodes[0].children[0], 1);
  EXPECT_EQ(levels_of(all.nodes[1]).size(), 3U) << "a leaf names its levels itself";
}

TEST(LodGltf, InstancesGoWithTheMesh) {
  Model model = test::model_of(test::icosphere(3));
  model.nodes[0].instances = {compose({1, 0, 0}, {}, {1, 1, 1}), compose({9, 0, 0}, {}, {1, 1, 1})};
  model.animations = {moving({channel(0, "scale")}, 3)};
  const Model all = merged(gltf_chain_of(model));
  EXPECT_TRUE(all.nodes[0].instances.empty());
  const Node& shown = all.nodes[static_cast<std::size_t>(all.nodes[0].children.at(0))];
  EXPECT_EQ(shown.instances, model.nodes[0].instances);
  for (const int level : levels_of(shown))
    EXPECT_EQ(all.nodes[static_cast<std::size_t>(level)].instances, model.nodes[0].instances);
  const Json json = written(all);
  EXPECT_FALSE(json["nodes"][0].contains("extensions"));
  EXPECT_TRUE(json["nodes"][1]["extensions"].contains("EXT_mesh_gpu_instancing"));
}

TEST(LodGltf, LevelsShareImagesThatAreTheSame) {
  const Model model = test::textured(test::wavy_grid(16, 16, 0.1), 2);
  LodChainOptions options = test::quick_chain();
  options.textures_follow = false;
  const Model kept = merged(gltf_chain_of(model, options));
  EXPECT_EQ(kept.images, model.images);
  EXPECT_EQ(kept.materials.size(), model.materials.size());

  options.textures_follow = true;
  options.screen.height = 64;
  options.screen.pixel_error = 4;
  options.coverages = {0.4, 0.2};
  const LodChain chain = gltf_chain_of(model, options);
  const Model all = merged(chain);
  ASSERT_EQ(chain.levels.size(), 3U);
  const std::vector<int> levels = levels_of(all.nodes[0]);
  for (std::size_t i = 0; i < levels.size(); ++i) {
    const Mesh& mesh =
        all.meshes[static_cast<std::size_t>(all.nodes[static_cast<std::size_t>(levels[i])].mesh)];
    const Material& material = all.materials[static_cast<std::size_t>(mesh.surface.parts[0].material)];
    const Texture& texture = all.textures[static_cast<std::size_t>(material.base_color->texture)];
    EXPECT_EQ(all.images[static_cast<std::size_t>(texture.image)].bytes,
              chain.levels[i + 1].model.images[0].bytes);
  }
  EXPECT_EQ(all.images[0], model.images[0]);
}

TEST(LodGltf, MaterialsOfVariantsAndExtensionsFollowTheirImages) {
  Model model = test::textured(test::wavy_grid(16, 16, 0.1), 1);
  Material other = model.materials[0];
  other.base_color.reset();
  other.json = R"({"extensions":{"KHR_materials_sheen":{"sheenColorTexture":{"index":0}}}})";
  model.materials.push_back(other);
  model.meshes[0].surface.parts[0].json =
      R"({"extensions":{"KHR_materials_variants":{"mappings":[{"material":1,"variants":[0]}]}}})";
  LodChainOptions options = test::quick_chain();
  options.screen.height = 64;
  options.screen.pixel_error = 4;
  options.coverages = {0.2};
  const Model all = merged(gltf_chain_of(model, options));
  const Node& level = all.nodes[static_cast<std::size_t>(levels_of(all.nodes[0]).at(0))];
  const Part& part = all.meshes[static_cast<std::size_t>(level.mesh)].surface.parts[0];
  const int material =
      Json::parse(part.json)["extensions"]["KHR_materials_variants"]["mappings"][0]["material"].get<int>();
  EXPECT_GE(material, 2);
  EXPECT_GE(part.material, 2);
  const Json json = Json::parse(all.materials[static_cast<std::size_t>(material)].json);
  EXPECT_EQ(json["extensions"]["KHR_materials_sheen"]["sheenColorTexture"]["index"], 1);
  EXPECT_EQ(model.materials[1].json, all.materials[1].json);
}

TEST(LodGltf, AModelWithoutScenesGetsOneWithoutTheLevels) {
  Model model = test::model_of(test::icosphere(3));
  model.scenes.clear();
  model.default_scene = -1;
  const Model all = merged(gltf_chain_of(model));
  ASSERT_EQ(all.scenes.size(), 1U);
  EXPECT_EQ(all.scenes[0].nodes, std::vector<int>{0});
  EXPECT_EQ(counts(all).triangles_drawn, 1280U);
}

TEST(LodGltf, MeshesThatDoNotChangeAreShared) {
  // The second mesh has one triangle, which stays.
  const Model model = test::model_of({test::icosphere(3), test::single_triangle()});
  LodChainOptions options = test::quick_chain();
  options.levels = 3;
  const Model all = merged(gltf_chain_of(model, options));
  EXPECT_EQ(all.meshes.size(), 4U);
  EXPECT_TRUE(all.nodes[1].json.empty());
}

}  // namespace
}  // namespace fovea
