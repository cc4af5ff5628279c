#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "fovea/base/error.h"
#include "io/gltf_written.h"
#include "support/corner_soup.h"
#include "support/meshes.h"

namespace fovea {
namespace {

using nlohmann::json;
using test::Written;

/// One triangle with an attribute whose three values are given.
Model triangle_with(Semantic semantic, int width, std::vector<float> values, Storage storage = {}) {
  test::PartBuilder builder(-1, false);
  for (const Vec3f p : {Vec3f{0, 0, 0}, Vec3f{1, 0, 0}, Vec3f{0, 1, 0}}) builder.vertex(p);
  builder.triangle(0, 1, 2);
  VertexArray array;
  array.semantic = semantic;
  array.width = width;
  array.storage = storage;
  array.values = std::move(values);
  builder.part().attributes.push_back(array);
  return test::model_of(test::weld_part(builder.part()));
}

/// One triangle with joints and weights; every vertex has the same `sets` × 4 influences.
Model triangle_with_skin(const std::vector<float>& joints, const std::vector<float>& weights,
                         Storage storage = {}, Storage joint_storage = {ComponentType::u8, false}) {
  test::PartBuilder builder(-1, false);
  for (const Vec3f p : {Vec3f{0, 0, 0}, Vec3f{1, 0, 0}, Vec3f{0, 1, 0}}) builder.vertex(p);
  builder.triangle(0, 1, 2);
  for (std::size_t set = 0; 4 * set < joints.size(); ++set) {
    for (const bool is_joint : {true, false}) {
      VertexArray array;
      array.semantic = is_joint ? Semantic::joints : Semantic::weights;
      array.set = static_cast<int>(set);
      array.width = 4;
      array.storage = is_joint ? joint_storage : storage;
      const auto& from = is_joint ? joints : weights;
      for (int v = 0; v < 3; ++v) {
        for (std::size_t k = 0; k < 4; ++k) array.values.push_back(from[4 * set + k]);
      }
      builder.part().attributes.push_back(array);
    }
  }
  Model model = test::model_of(test::weld_part(builder.part()));
  return model;
}

Storage storage_of(const Written& written, const char* name) {
  const json& accessor = written.accessor(written.primitive()["attributes"][name]);
  return {static_cast<ComponentType>(accessor["componentType"].get<int>()),
          accessor.value("normalized", false)};
}

/// The first `count` stored numbers of an attribute, vertices in the order (0 0 0), (1 0 0), (0 1 0).
template <class T>
std::vector<T> first_values(const Written& written, const char* name, std::size_t count) {
  const auto stored = written.raw<T>(written.primitive()["attributes"][name]);
  const auto positions = written.raw<float>(written.primitive()["attributes"]["POSITION"]);
  const std::size_t width = stored.size() / 3;
  std::vector<T> values(stored.size());
  for (std::size_t v = 0; v < 3; ++v) {
    const std::size_t place = positions[3 * v] == 1 ? 1 : positions[3 * v + 1] == 1 ? 2 : 0;
    std::copy_n(stored.begin() + static_cast<long>(v * width), width,
                values.begin() + static_cast<long>(place * width));
  }
  values.resize(count);
  return values;
}

constexpr Storage kByteUnit{ComponentType::u8, true};
constexpr Storage kShortUnit{ComponentType::u16, true};
constexpr Storage kSignedByteUnit{ComponentType::i8, true};

// ---- as read ----

TEST(GltfStorage, IntegersStayOnTheirGrid) {
  TriMesh mesh = test::grid(3, 3);
  mesh.position_storage = {ComponentType::i16, false};
  for (Vec3f& p : mesh.positions) p = p * 3.0f - Vec3f{1, 1, 1};
  AttributeLayer& uv = *mesh.find(Semantic::uv);
  uv.storage = kByteUnit;
  for (float& x : uv.values) x = decode_component(encode_component(x, kByteUnit), kByteUnit);
  mesh.find(Semantic::normal)->storage = kSignedByteUnit;
  const Written written(test::model_of(mesh));
  EXPECT_EQ(storage_of(written, "POSITION"), mesh.position_storage);
  EXPECT_EQ(storage_of(written, "TEXCOORD_0"), kByteUnit);
  EXPECT_EQ(storage_of(written, "NORMAL"), kSignedByteUnit);
  EXPECT_TRUE(test::lists(written.json, "extensionsRequired", "KHR_mesh_quantization"));
  EXPECT_TRUE(test::corner_soup(written.read().meshes[0].surface) == test::corner_soup(mesh));
}

TEST(GltfStorage, ValuesBeyondTheTypeBecomeFloats) {
  const Written written(triangle_with(Semantic::uv, 2, {0, 0, 1.5f, 0, 0, 1}, kShortUnit));
  EXPECT_EQ(storage_of(written, "TEXCOORD_0"), Storage{});
  EXPECT_FALSE(written.json.contains("extensionsUsed"));
}

TEST(GltfStorage, TypesThatTheFormatForbidsBecomeFloats) {
  EXPECT_EQ(storage_of(Written(triangle_with(Semantic::normal, 3, {0, 0, 1, 0, 0, 1, 0, 0, 1}, kShortUnit)),
                       "NORMAL"),
            Storage{});
  EXPECT_EQ(storage_of(Written(triangle_with(Semantic::color, 3, {0, 0, 1, 0, 0, 1, 0, 0, 1},
                                             {ComponentType::u8, false})),
                       "COLOR_0"),
            Storage{});
}

// ---- repairs ----

TEST(GltfStorage, NumbersThatAreNotFiniteBecomeZero) {
  const float nan = std::numeric_limits<float>::quiet_NaN(), inf = std::numeric_limits<float>::infinity();
  const Written written(triangle_with(Semantic::uv, 2, {nan, 0.5f, inf, -inf, 1, 1}));
  EXPECT_EQ(first_values<float>(written, "TEXCOORD_0", 6), (std::vector<float>{0, 0.5f, 0, 0, 1, 1}));
  EXPECT_EQ(written.told("not-finite"), 3u);
}

TEST(GltfStorage, NormalsGetUnitLengthOrADirection) {
  const Written written(triangle_with(Semantic::normal, 3, {0, 3, 4, 0, 0, 0, 0.6f, 0.8f, 1e-5f}));
  const auto normals = first_values<float>(written, "NORMAL", 9);
  EXPECT_EQ(normals,
            (std::vector<float>{0, 0.6f, 0.8f, 0, 0, 1, 0.6f, 0.8f, 1e-5f}));  // the last was good enough
  EXPECT_EQ(written.told("zero-normals"), 1u);
}

TEST(GltfStorage, TangentsGetUnitLengthAndASign) {
  const Written written(triangle_with(Semantic::tangent, 4, {2, 0, 0, 0.5f, 0, 0, 0, -3, 0, 1, 0, -1}));
  const auto tangents = first_values<float>(written, "TANGENT", 12);
  EXPECT_EQ((std::vector<float>(tangents.begin(), tangents.begin() + 4)), (std::vector<float>{1, 0, 0, 1}));
  EXPECT_NEAR(std::hypot(tangents[4], tangents[5], tangents[6]), 1, 1e-6);  // float rounding
  EXPECT_EQ(tangents[6], 0);  // at right angles to (0, 0, 1), the normal of the triangle
  EXPECT_EQ(tangents[7], -1);
  EXPECT_EQ(written.told("zero-tangents"), 1u);
}

TEST(GltfStorage, ColorsAreClamped) {
  const Written written(triangle_with(Semantic::color, 3, {2, 0.5f, -1, 0, 0, 0, 1, 1, 1}));
  EXPECT_EQ(first_values<float>(written, "COLOR_0", 3), (std::vector<float>{1, 0.5f, 0}));
  EXPECT_EQ(written.told("colors-clamped"), 2u);
}

// ---- skins ----

TEST(GltfStorage, FloatWeightsSumToOne) {
  const Written written(triangle_with_skin({1, 2, 3, 4}, {0.5f, 0.25f, 0.5f, 0}));
  const auto w = first_values<float>(written, "WEIGHTS_0", 4);
  // What the specification's validator allows: 2e-7 per weight.
  EXPECT_NEAR(static_cast<double>(w[0]) + w[1] + w[2] + w[3], 1, 3 * 2e-7);
  EXPECT_NEAR(w[0], 0.4, 1e-7);
  EXPECT_EQ(first_values<std::uint8_t>(written, "JOINTS_0", 4), (std::vector<std::uint8_t>{1, 2, 3, 0}));
  EXPECT_EQ(written.told("weights-repaired"), 3u);
}

TEST(GltfStorage, GoodFloatWeightsKeepTheirBits) {
  const std::vector<float> weights = {0.1f, 0.2f, 0.3f, 0.4f};
  const Written written(triangle_with_skin({1, 2, 3, 4}, weights));
  EXPECT_EQ(first_values<float>(written, "WEIGHTS_0", 4), weights);
  EXPECT_EQ(written.told("weights-repaired"), 0u);
}

TEST(GltfStorage, IntegerWeightsSumExactlyOverAllSets) {
  for (const Storage storage : {kByteUnit, kShortUnit}) {
    const float third = 1.0f / 3, sixth = 1.0f / 6;
    const Written written(triangle_with_skin({1, 2, 3, 4, 5, 6, 7, 8},
                                             {third, sixth, 0.1f, 0.05f, 0.15f, 0.1f, 0.1f, 0}, storage));
    ASSERT_EQ(storage_of(written, "WEIGHTS_1"), storage);
    int sum = 0;
    for (const char* name : {"WEIGHTS_0", "WEIGHTS_1"}) {
      if (storage == kByteUnit) {
        for (const int w : first_values<std::uint8_t>(written, name, 4)) sum += w;
      } else {
        for (const int w : first_values<std::uint16_t>(written, name, 4)) sum += w;
      }
    }
    EXPECT_EQ(sum, storage == kByteUnit ? 255 : 65535);
  }
}

TEST(GltfStorage, JointsTwiceAreMergedAndNoWeightIsAllWeight) {
  const Written twice(triangle_with_skin({3, 3, 5, 0}, {0.25f, 0.25f, 0.5f, 0}));
  EXPECT_EQ(first_values<float>(twice, "WEIGHTS_0", 4), (std::vector<float>{0.5f, 0, 0.5f, 0}));
  EXPECT_EQ(first_values<std::uint8_t>(twice, "JOINTS_0", 4), (std::vector<std::uint8_t>{3, 0, 5, 0}));
  const Written none(triangle_with_skin({3, 2, 5, 0}, {0, 0, 0, 0}));
  EXPECT_EQ(first_values<float>(none, "WEIGHTS_0", 4), (std::vector<float>{1, 0, 0, 0}));
  EXPECT_EQ(first_values<std::uint8_t>(none, "JOINTS_0", 4), (std::vector<std::uint8_t>{3, 0, 0, 0}));
}

TEST(GltfStorage, JointsTakeABytePerIndexWhereTheyCan) {
  const Storage byte{ComponentType::u8, false}, word{ComponentType::u16, false};
  const std::vector<float> weights = {0.5f, 0.5f, 0, 0};
  EXPECT_EQ(storage_of(Written(triangle_with_skin({255, 1, 0, 0}, weights, {}, Storage{})), "JOINTS_0"),
            byte);
  EXPECT_EQ(storage_of(Written(triangle_with_skin({256, 1, 0, 0}, weights, {}, byte)), "JOINTS_0"), word);
  EXPECT_EQ(storage_of(Written(triangle_with_skin({2, 1, 0, 0}, weights, {}, word)), "JOINTS_0"),
            word);  // as read
}

// ---- quantize ----

WriteOptions quantized() {
  WriteOptions options;
  options.quantize = true;
  return options;
}

/// Largest distance of the positions of instance 0 of a mesh from those of another, both in world space.
/// Vertices are matched by their order along x, y, z of the original, which `grid` meshes keep.
double position_error(const Model& a, const Model& b) {
  const auto points = [](const Model& model) {
    std::vector<Vec3d> result;
    const auto instances = mesh_instances(model);
    for (const Vec3f p : model.meshes[0].surface.positions) {
      result.push_back(transform_point(instances[0].at(0), Vec3d(p)));
    }
    return result;
  };
  double worst = 0;
  const auto in_b = points(b);
  for (const Vec3d p : points(a)) {
    double nearest = std::numeric_limits<double>::infinity();
    for (const Vec3d q : in_b) nearest = std::min(nearest, length(p - q));
    worst = std::max(worst, nearest);
  }
  return worst;
}

TEST(GltfQuantize, PositionsKeepHalfAStepPerAxis) {
  Model model = test::model_of(test::wavy_grid(6, 6, 0.2));
  model.nodes[0].translation = {10, 0, 0};
  model.nodes[0].scale = {2, 2, 2};
  for (const std::int64_t bits : {4, 8, 10, 16}) {
    WriteOptions options = quantized();
    options.position_bits = bits;
    const Written written(model, options);
    // Half a step of the extent (1, scaled to 2) in each of three axes; floats add 1e-6.
    const double step = 2 / (std::ldexp(1.0, static_cast<int>(bits)) - 1);
    EXPECT_LE(position_error(model, written.read()), std::sqrt(3.0) / 2 * step + 1e-6) << bits;
    EXPECT_EQ(storage_of(written, "POSITION"),
              (Storage{bits <= 8 ? ComponentType::u8 : ComponentType::u16, false}));
    EXPECT_TRUE(test::lists(written.json, "extensionsRequired", "KHR_mesh_quantization"));
  }
}

TEST(GltfQuantize, NodesKeepTheirIndicesAndGetAChildForTheMesh) {
  Model model = test::model_of({test::cube(), test::cube()});
  Node second;
  second.mesh = 0;
  model.nodes.push_back(second);
  model.scenes[0].nodes.push_back(2);
  const json nodes = Written(model, quantized()).json["nodes"];
  ASSERT_EQ(nodes.size(), 6u);
  for (std::size_t n = 0; n < 3; ++n) {
    EXPECT_FALSE(nodes[n].contains("mesh"));
    ASSERT_EQ(nodes[n]["children"], json({3 + n}));
    EXPECT_EQ(nodes[3 + n]["mesh"], n == 1 ? 1 : 0);
  }
}

TEST(GltfQuantize, MorphTargetsFollow) {
  Model model = test::model_of(test::morph_strip(6));
  AnimationSampler sampler;
  sampler.input = Accessor::from_floats({0, 1}, 1);
  sampler.output = Accessor::from_floats({0, 1, 1, 0}, 1);
  Animation animation;
  animation.samplers = {sampler};
  animation.channels = {{0, 0, "weights", {}}};
  model.animations = {animation};
  model.nodes[0].morph_weights = {0.5, 0.25};
  const Written written(model, quantized());
  const Model read = written.read();
  EXPECT_EQ(read.animations[0].channels[0].node, 1);
  EXPECT_TRUE(read.nodes[0].morph_weights.empty());
  EXPECT_EQ(read.nodes[1].morph_weights, model.nodes[0].morph_weights);

  // What target 0 adds at its largest: x² at the end of the strip, times the scale of the new node.
  const auto largest = [](const Model& m) {
    double result = 0;
    for (const Vec3f d : m.meshes[0].surface.position_morphs[0])
      result = std::max(result, static_cast<double>(d.z));
    return result;
  };
  const double scale = read.nodes[1].scale.x;
  EXPECT_NEAR(largest(read) * scale, largest(model), scale / 2 + 1e-6);  // half a step
}

TEST(GltfQuantize, SkinsTakeTheGridIntoTheirMatrices) {
  const Model model = test::skinned_model(8);
  const Written written(model, quantized());
  const Model read = written.read();
  EXPECT_EQ(read.nodes.size(), model.nodes.size());
  EXPECT_EQ(read.nodes[0].mesh, 0);
  const auto bound = [](const Model& m, std::size_t joint) {
    const auto matrices = m.skins[0].inverse_bind->to_floats();
    Mat4 matrix;
    std::copy_n(matrices.begin() + static_cast<long>(16 * joint), 16, matrix.m.begin());
    Box box;
    for (const Vec3f p : m.meshes[0].surface.positions) box.add(transform_point(matrix, Vec3d(p)));
    return box;
  };
  const double step = 8 / (std::ldexp(1.0, 14) - 1);
  for (std::size_t joint = 0; joint < 2; ++joint) {
    const Box before = bound(model, joint), after = bound(read, joint);
    EXPECT_LE(length(before.low - after.low), step);
    EXPECT_LE(length(before.high - after.high), step);
  }
  EXPECT_EQ(storage_of(written, "WEIGHTS_0"), kByteUnit);
}

TEST(GltfQuantize, WhatCannotBeMovedStaysAsItIs) {
  const auto expect_kept = [](const Model& model, const char* why) {
    const Written written(model, quantized());
    EXPECT_EQ(storage_of(written, "POSITION"), Storage{}) << why;
    EXPECT_EQ(written.json["nodes"].size(), model.nodes.size()) << why;
    EXPECT_GE(written.told("mesh-not-quantized"), 1u) << why;
  };
  const Model plain = test::model_of(test::cube());

  Model model = plain;
  model.nodes[0].instances = {Mat4{}, compose({1, 0, 0}, {}, {1, 1, 1})};
  expect_kept(model, "instanced");

  model = plain;
  model.nodes[0].mesh = -1;
  expect_kept(model, "not shown");

  model = plain;
  model.meshes[0].surface.parts[0].material = 0;
  model.materials.resize(1);
  model.materials[0].json = R"({"extensions":{"KHR_materials_volume":{"thicknessFactor":0.1}}})";
  expect_kept(model, "thickness");

  model = plain;
  model.nodes[0].json = R"({"extensions":{"X_collider":{"shape":{"mesh":0}}}})";
  expect_kept(model, "named by an extension");

  model = test::skinned_model(4);
  Node unskinned;
  unskinned.mesh = 0;
  model.nodes.push_back(unskinned);
  expect_kept(model, "with and without a skin");

  model = test::skinned_model(4);
  model.meshes.push_back(model.meshes[0]);
  Node shared = model.nodes[0];
  shared.mesh = 1;
  model.nodes.push_back(shared);
  Part point;
  point.raw.emplace();
  point.raw->mode = 0;
  point.raw->attributes = {{"POSITION", Accessor::from_floats({0, 0, 0}, 3)}};
  model.meshes[1].surface.parts.push_back(point);
  expect_kept(model, "shares a skin with one that stays");
}

TEST(GltfQuantize, OtherAttributesUseTheAskedBits) {
  WriteOptions options = quantized();
  options.uv_bits = 4;
  options.normal_bits = 10;
  const Written written(test::model_of(test::wavy_grid(5, 5, 0.3)), options);
  EXPECT_EQ(storage_of(written, "TEXCOORD_0"), kByteUnit);
  for (const int v : written.raw<std::uint8_t>(written.primitive()["attributes"]["TEXCOORD_0"])) {
    EXPECT_EQ(v % 17, 0);  // 4 bits of 8: multiples of 255 / 15
  }
  EXPECT_EQ(storage_of(written, "NORMAL"), (Storage{ComponentType::i16, true}));
  const Written colors(triangle_with(Semantic::color, 3, {0, 0.5f, 1, 1, 1, 1, 0, 0, 0}), quantized());
  EXPECT_EQ(storage_of(colors, "COLOR_0"), kByteUnit);
}

TEST(GltfQuantize, TextureCoordinatesBeyondTheUnitSquareStayFloats) {
  const Written written(triangle_with(Semantic::uv, 2, {0, 0, 3, 0, 0, 1}), quantized());
  EXPECT_EQ(storage_of(written, "TEXCOORD_0"), Storage{});
  EXPECT_EQ(written.told("uv-not-quantized"), 1u);
}

TEST(GltfQuantize, AttributesThatCameAsIntegersStay) {
  TriMesh mesh = test::grid(2, 2);
  mesh.find(Semantic::uv)->storage = kShortUnit;
  mesh.position_storage = {ComponentType::i8, false};
  const Written written(test::model_of(mesh), quantized());
  EXPECT_EQ(storage_of(written, "TEXCOORD_0"), kShortUnit);
  EXPECT_EQ(storage_of(written, "POSITION"), mesh.position_storage);
  EXPECT_EQ(storage_of(written, "NORMAL"), kSignedByteUnit);
}

TEST(GltfQuantize, OnePointIsAGridToo) {
  const Written written(test::model_of(test::sliver_strip(3)), quantized());
  EXPECT_EQ(written.read().meshes.size(), 1u);
}

}  // namespace
}  // namespace fovea
