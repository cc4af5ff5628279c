#include "fovea/io/gltf_read.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "fovea/base/error.h"
#include "support/gltf_builder.h"

namespace fovea {
namespace {

using test::GltfBuilder;
using Json = GltfBuilder::Json;

Model read(const std::vector<std::byte>& bytes, Context& context) {
  return read_gltf(bytes, ".", "test.glb", ReadOptions{}, context);
}

Model read(const GltfBuilder& builder) {
  Context context;
  return read(builder.glb(), context);
}

std::vector<std::string> codes(const Context& context) {
  std::vector<std::string> result;
  for (const Diagnostic& d : context.diagnostics()) result.push_back(d.code);
  return result;
}

Json& primitive_of(GltfBuilder& builder) { return builder.json["meshes"][0]["primitives"][0]; }

/// The corners of a face, with the first one first: triangles that differ in where they begin are equal.
std::vector<Vec3f> face(const TriMesh& mesh, std::size_t f) {
  std::vector<Vec3f> corners;
  for (const VertexId v : mesh.triangles[f]) corners.push_back(mesh.positions[v.index()]);
  const auto less = [](Vec3f a, Vec3f b) { return std::tie(a.x, a.y, a.z) < std::tie(b.x, b.y, b.z); };
  std::rotate(corners.begin(), std::min_element(corners.begin(), corners.end(), less), corners.end());
  return corners;
}

TEST(GltfRead, TriangleFromGlbAndFromJsonAreTheSame) {
  const GltfBuilder builder = GltfBuilder::triangle();
  Context context;
  for (const auto& bytes : {builder.glb(), builder.gltf()}) {
    const Model model = read(bytes, context);
    ASSERT_EQ(model.meshes.size(), 1u);
    const TriMesh& mesh = model.meshes[0].surface;
    check(mesh);
    EXPECT_EQ(mesh.face_count(), 1u);
    EXPECT_EQ(mesh.vertex_count(), 3u);
    EXPECT_EQ(face(mesh, 0), (std::vector<Vec3f>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}));
    ASSERT_EQ(model.nodes.size(), 1u);
    EXPECT_EQ(model.nodes[0].mesh, 0);
    EXPECT_EQ(model.default_scene, 0);
  }
  EXPECT_TRUE(context.diagnostics().empty());
}

TEST(GltfRead, BinaryWithoutJsonOfItsOwnIsNotNeeded) {
  GltfBuilder builder;
  const Model model = read(builder);
  EXPECT_TRUE(model.meshes.empty());
  EXPECT_EQ(model.default_scene, -1);
}

//  1───3───5      strip 0 1 2 3 4 5; all faces look towards +z
//  │ ╲ │ ╲ │
//  0───2───4
GltfBuilder six_vertices(int mode) {
  GltfBuilder builder;
  const int p = builder.add_accessor<float>({0, 0, 0, 0, 1, 0, 1, 0, 0, 1, 1, 0, 2, 0, 0, 2, 1, 0}, "VEC3");
  builder.add_mesh({{"attributes", {{"POSITION", p}}}, {"mode", mode}});
  return builder;
}

double normal_z(const TriMesh& mesh, std::size_t f) {
  const auto& t = mesh.triangles[f];
  const Vec3f a = mesh.positions[t[0].index()];
  return cross(mesh.positions[t[1].index()] - a, mesh.positions[t[2].index()] - a).z;
}

TEST(GltfRead, StripBecomesTrianglesOfOneOrientation) {
  const Model model = read(six_vertices(5));
  const TriMesh& mesh = model.meshes[0].surface;
  ASSERT_EQ(mesh.face_count(), 4u);
  for (std::size_t f = 0; f < 4; ++f) EXPECT_LT(normal_z(mesh, f), 0) << f;  // 0 1 2 is clockwise
  EXPECT_FALSE(mesh.parts[0].raw.has_value());
  EXPECT_EQ(Json::parse(mesh.parts[0].json).count("mode"), 0u);
}

TEST(GltfRead, FanBecomesTrianglesAroundItsFirstVertex) {
  GltfBuilder builder;
  // Fan around 0 over the corners of a square, counter-clockwise.
  const int p = builder.add_accessor<float>({0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0}, "VEC3");
  builder.add_mesh({{"attributes", {{"POSITION", p}}}, {"mode", 6}});
  const Model model = read(builder);
  const TriMesh& mesh = model.meshes[0].surface;
  ASSERT_EQ(mesh.face_count(), 2u);
  EXPECT_EQ(face(mesh, 0), (std::vector<Vec3f>{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}}));
  EXPECT_EQ(face(mesh, 1), (std::vector<Vec3f>{{0, 0, 0}, {1, 1, 0}, {0, 1, 0}}));
}

TEST(GltfRead, CornersThatMakeNoWholeTriangleAreDroppedAndTold) {
  GltfBuilder builder = GltfBuilder::triangle();
  primitive_of(builder)["indices"] = builder.add_accessor<std::uint8_t>({0, 1, 2, 0}, "SCALAR");
  Context context;
  const Model model = read(builder.glb(), context);
  EXPECT_EQ(model.meshes[0].surface.face_count(), 1u);
  EXPECT_EQ(codes(context), std::vector<std::string>{"incomplete-triangles"});
}

TEST(GltfRead, PointsAndLinesStayAsTheyAre) {
  for (int mode = 0; mode < 4; ++mode) {
    const GltfBuilder builder = six_vertices(mode);
    const Model model = read(builder);
    const TriMesh& mesh = model.meshes[0].surface;
    EXPECT_EQ(mesh.face_count(), 0u);
    ASSERT_TRUE(mesh.parts.at(0).raw.has_value());
    const RawPrimitive& raw = *mesh.parts[0].raw;
    EXPECT_EQ(raw.mode, mode);
    ASSERT_EQ(raw.attributes.size(), 1u);
    EXPECT_EQ(raw.attributes[0].name, "POSITION");
    EXPECT_EQ(raw.attributes[0].data.bytes, builder.binary);
  }
}

TEST(GltfRead, PrimitiveWithoutPositionsIsKeptEmptyAndTold) {
  GltfBuilder builder;
  const int n = builder.add_accessor<float>({0, 0, 1, 0, 0, 1, 0, 0, 1}, "VEC3");
  builder.add_mesh({{"attributes", {{"NORMAL", n}}}});
  Context context;
  const Model model = read(builder.glb(), context);
  EXPECT_EQ(model.meshes[0].surface.parts.size(), 1u);
  EXPECT_EQ(model.meshes[0].surface.face_count(), 0u);
  EXPECT_EQ(codes(context), std::vector<std::string>{"no-positions"});
}

TEST(GltfRead, AttributesKeepMeaningSetAndStorage) {
  GltfBuilder builder = GltfBuilder::triangle();
  Json& attributes = primitive_of(builder)["attributes"];
  attributes["NORMAL"] = builder.add_accessor<std::int8_t>({0, 0, 127, 0, 0, 127, 0, 0, 127}, "VEC3", true);
  attributes["TEXCOORD_1"] = builder.add_accessor<std::uint16_t>({0, 0, 65535, 0, 0, 65535}, "VEC2", true);
  attributes["COLOR_0"] =
      builder.add_accessor<std::uint8_t>({255, 0, 0, 51, 0, 255, 0, 255, 0, 0, 255, 255}, "VEC4", true);
  attributes["JOINTS_0"] =
      builder.add_accessor<std::uint16_t>({0, 1, 2, 3, 0, 0, 0, 0, 300, 0, 0, 0}, "VEC4");
  attributes["WEIGHTS_0"] = builder.add_accessor<float>({1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0}, "VEC4");
  attributes["_HEAT"] = builder.add_accessor<float>({1.5f, 2.5f, 3.5f}, "SCALAR");
  const Model model = read(builder);
  const TriMesh& mesh = model.meshes[0].surface;
  check(mesh);
  const AttributeLayer* uv = mesh.find(Semantic::uv, 1);
  ASSERT_NE(uv, nullptr);
  EXPECT_EQ(uv->storage, (Storage{ComponentType::u16, true}));
  EXPECT_EQ(uv->value(uv->corner_value[1])[0], 1.0f);
  const AttributeLayer* normal = mesh.find(Semantic::normal);
  ASSERT_NE(normal, nullptr);
  EXPECT_EQ(normal->value(normal->corner_value[0])[2], 1.0f);
  const AttributeLayer* color = mesh.find(Semantic::color);
  ASSERT_NE(color, nullptr);
  EXPECT_EQ(color->value(color->corner_value[0])[3], 51.0f / 255.0f);
  const AttributeLayer* joints = mesh.find(Semantic::joints);
  ASSERT_NE(joints, nullptr);
  EXPECT_EQ(joints->value(joints->corner_value[2])[0], 300.0f);
  const AttributeLayer* custom = mesh.find(Semantic::custom);
  ASSERT_NE(custom, nullptr);
  EXPECT_EQ(custom->name, "_HEAT");
  EXPECT_EQ(custom->value(custom->corner_value[1])[0], 2.5f);
}

TEST(GltfRead, QuantizedPositionsAreTheirIntegers) {
  GltfBuilder builder;
  const int p = builder.add_accessor<std::int16_t>({0, 0, 0, 100, 0, 0, 0, -300, 0}, "VEC3");
  builder.add_mesh({{"attributes", {{"POSITION", p}}}});
  const Model model = read(builder);
  const TriMesh& mesh = model.meshes[0].surface;
  EXPECT_EQ(face(mesh, 0), (std::vector<Vec3f>{{0, -300, 0}, {0, 0, 0}, {100, 0, 0}}));
  EXPECT_EQ(mesh.position_storage, (Storage{ComponentType::i16, false}));
}

TEST(GltfRead, InterleavedElementsFollowTheStride) {
  GltfBuilder builder;
  // position, uv, 4 bytes that nobody reads
  const std::vector<float> rows = {0, 0, 0, 0.25f, 0.5f, 9, 1, 0, 0, 1, 0.5f, 9, 0, 1, 0, 0.25f, 1, 9};
  const int view = builder.add_view(std::as_bytes(std::span(rows)));
  builder.json["bufferViews"][view]["byteStride"] = 24;
  const int p = builder.add_accessor_json(view, 3, 5126, "VEC3", false);
  const int uv = builder.add_accessor_json(view, 3, 5126, "VEC2", false);
  builder.json["accessors"][uv]["byteOffset"] = 12;
  builder.add_mesh({{"attributes", {{"POSITION", p}, {"TEXCOORD_0", uv}}}});
  const Model model = read(builder);
  const TriMesh& mesh = model.meshes[0].surface;
  EXPECT_EQ(mesh.positions[mesh.vertex(CornerId{1}).index()], (Vec3f{1, 0, 0}));
  const AttributeLayer* layer = mesh.find(Semantic::uv);
  ASSERT_NE(layer, nullptr);
  EXPECT_EQ(layer->value(layer->corner_value[2])[1], 1.0f);
}

TEST(GltfRead, SparseValuesReplaceDenseOnesAndZeros) {
  for (const bool dense : {true, false}) {
    GltfBuilder builder = GltfBuilder::triangle();
    const std::vector<std::uint8_t> indices = {2};
    const std::vector<float> values = {0, 5, 0};
    const int iv = builder.add_view(std::as_bytes(std::span(indices)));
    const int vv = builder.add_view(std::as_bytes(std::span(values)));
    Json& accessor = builder.json["accessors"][0];
    accessor["sparse"] = {{"count", 1},
                          {"indices", {{"bufferView", iv}, {"componentType", 5121}}},
                          {"values", {{"bufferView", vv}}}};
    if (!dense) accessor.erase("bufferView");
    const Model model = read(builder);
    const TriMesh& mesh = model.meshes[0].surface;
    if (dense) {
      EXPECT_EQ(face(mesh, 0)[2], (Vec3f{0, 5, 0}));
    } else {
      EXPECT_EQ(mesh.face_count(), 0u);  // two corners at the origin: dropped
    }
  }
}

TEST(GltfRead, ColumnsOfSmallMatricesArePadded) {
  GltfBuilder builder = GltfBuilder::triangle();
  // MAT3 of bytes: three columns of 3 bytes, each padded to 4.
  const std::vector<std::uint8_t> bytes = {1,  2,  3,  0, 4,  5,  6,  0, 7,  8,  9, 0,
                                           11, 12, 13, 0, 14, 15, 16, 0, 17, 18, 19};
  const int view = builder.add_view(std::as_bytes(std::span(bytes)));
  const int accessor = builder.add_accessor_json(view, 2, 5121, "MAT3", false);
  builder.json["nodes"][0]["extensions"]["EXT_unknown"] = {{"accessor", accessor}};
  const Model model = read(builder);
  ASSERT_EQ(model.carried_accessors.size(), 1u);
  const Accessor& carried = model.carried_accessors[0];
  EXPECT_TRUE(carried.matrix);
  EXPECT_EQ(carried.to_floats(),
            (std::vector<float>{1, 2, 3, 4, 5, 6, 7, 8, 9, 11, 12, 13, 14, 15, 16, 17, 18, 19}));
}

TEST(GltfRead, MorphTargetsComeWithTheVertices) {
  GltfBuilder builder = GltfBuilder::triangle();
  Json& primitive = primitive_of(builder);
  primitive["attributes"]["NORMAL"] = builder.add_accessor<float>({0, 0, 1, 0, 0, 1, 0, 0, 1}, "VEC3");
  const int move = builder.add_accessor<float>({0, 0, 1, 0, 0, 2, 0, 0, 3}, "VEC3");
  const int turn = builder.add_accessor<float>({1, 0, 0, 1, 0, 0, 1, 0, 0}, "VEC3");
  primitive["targets"] = Json::array({{{"POSITION", move}}, {{"NORMAL", turn}}});
  builder.json["meshes"][0]["weights"] = {0.5, 0.25};
  const Model model = read(builder);
  const TriMesh& mesh = model.meshes[0].surface;
  check(mesh);
  ASSERT_EQ(mesh.target_count(), 2u);
  EXPECT_EQ(mesh.position_morphs[0][mesh.vertex(CornerId{2}).index()], (Vec3f{0, 0, 3}));
  EXPECT_EQ(mesh.position_morphs[1][0], (Vec3f{0, 0, 0}));
  EXPECT_EQ(model.meshes[0].morph_weights, (std::vector<double>{0.5, 0.25}));
  const AttributeLayer* normal = mesh.find(Semantic::normal);
  ASSERT_EQ(normal->morphs.size(), 2u);
  EXPECT_EQ(normal->morphs[1][0], 1.0f);
}

TEST(GltfRead, NumbersThatAreNotFiniteBecomeZeroExceptInPositions) {
  GltfBuilder builder = GltfBuilder::triangle();
  const float nan = std::numeric_limits<float>::quiet_NaN();
  primitive_of(builder)["attributes"]["NORMAL"] =
      builder.add_accessor<float>({nan, 0, 1, 0, INFINITY, 1, 0, 0, 1}, "VEC3");
  Context context;
  const Model model = read(builder.glb(), context);
  ASSERT_EQ(context.diagnostics().size(), 1u);
  EXPECT_EQ(context.diagnostics()[0].code, "non-finite-values");
  EXPECT_EQ(context.diagnostics()[0].count, 2u);
  EXPECT_EQ(context.diagnostics()[0].place, "test.glb: /meshes/0/primitives/0/attributes/NORMAL");
  for (const float x : model.meshes[0].surface.layers[0].values) EXPECT_TRUE(std::isfinite(x));
}

TEST(GltfRead, EmptyArraysAreNoTriangles) {
  for (const int accessor : {0, 1}) {
    GltfBuilder builder = GltfBuilder::triangle();
    builder.json["accessors"][0]["count"] = accessor == 0 ? 0 : 3;
    builder.json["accessors"][1]["count"] = 0;
    builder.json["bufferViews"][0]["byteLength"] = accessor == 0 ? 0 : 36;
    const Model model = read(builder);
    EXPECT_EQ(model.meshes[0].surface.face_count(), 0u);
  }
}

TEST(GltfRead, SourceVerticesCountOverAllTriangleParts) {
  GltfBuilder builder = GltfBuilder::triangle();
  // A second primitive over the same vertices, other winding; source vertices 3, 4, 5.
  const int indices = builder.add_accessor<std::uint8_t>({2, 1, 0}, "SCALAR");
  builder.json["meshes"][0]["primitives"].push_back(
      {{"attributes", {{"POSITION", 0}}}, {"indices", indices}});
  const Model model = read(builder);
  const TriMesh& mesh = model.meshes[0].surface;
  EXPECT_EQ(mesh.vertex_count(), 3u);
  EXPECT_EQ(mesh.face_part, (std::vector<std::uint32_t>{0, 1}));
  ASSERT_EQ(mesh.source_vertex.size(), 6u);
  for (std::size_t v = 0; v < 3; ++v) EXPECT_EQ(mesh.source_vertex[v], mesh.source_vertex[v + 3]);
}

TEST(GltfRead, MaterialWithTextureTransformAndUnlit) {
  GltfBuilder builder = GltfBuilder::triangle();
  builder.json["images"] = Json::array({{{"uri", "data:image/png;base64,AAAA"}}});
  builder.json["samplers"] = Json::array({{{"wrapS", 33071}, {"minFilter", 9987}}});
  builder.json["textures"] = Json::array({{{"source", 0}, {"sampler", 0}, {"name", "t"}}});
  builder.json["materials"] = Json::parse(R"([{
    "name": "m", "alphaMode": "MASK", "alphaCutoff": 0.25, "doubleSided": true,
    "pbrMetallicRoughness": {"baseColorFactor": [1, 0.5, 0.25, 1], "baseColorTexture": {"index": 0, "texCoord": 1,
      "extensions": {"KHR_texture_transform": {"offset": [0.5, 0], "rotation": 1.5, "scale": [2, 3], "texCoord": 2}}}},
    "normalTexture": {"index": 0, "scale": 0.5},
    "extensions": {"KHR_materials_unlit": {}, "KHR_materials_clearcoat": {"clearcoatTexture": {"index": 0}}},
    "extras": {"keep": [1, 2]}}])");
  const Model model = read(builder);
  const Material& m = model.materials.at(0);
  ASSERT_TRUE(m.base_color.has_value());
  EXPECT_EQ(m.base_color->uv_set, 2);
  EXPECT_EQ(m.base_color->transform, (TextureTransform{{0.5, 0}, 1.5, {2, 3}}));
  EXPECT_EQ(m.base_color_factor[2], 0.25);
  EXPECT_EQ(m.normal_scale, 0.5);
  EXPECT_EQ(m.alpha_mode, AlphaMode::mask);
  EXPECT_EQ(m.alpha_cutoff, 0.25);
  EXPECT_TRUE(m.double_sided);
  EXPECT_TRUE(m.unlit);
  EXPECT_EQ(Json::parse(m.json), builder.json["materials"][0]);
  EXPECT_EQ(model.samplers.at(0).wrap_u, Wrap::clamp);
  EXPECT_EQ(model.samplers[0].wrap_v, Wrap::repeat);
  EXPECT_EQ(model.samplers[0].min_filter, 9987);
  EXPECT_EQ(model.textures.at(0).image, 0);
}

TEST(GltfRead, ExtensionNamesTheImageOnlyWhereThePlainSourceIsAbsent) {
  GltfBuilder builder;
  builder.json["images"] = Json::array({{{"uri", "data:image/png,x"}}, {{"uri", "data:image/webp,y"}}});
  builder.json["textures"] = Json::parse(R"([
    {"extensions": {"EXT_texture_webp": {"source": 1}}},
    {"source": 0, "extensions": {"EXT_texture_webp": {"source": 1}}}, {}])");
  const Model model = read(builder);
  EXPECT_EQ(model.textures.at(0).image, 1);
  EXPECT_EQ(model.textures.at(1).image, 0);
  EXPECT_EQ(model.textures.at(2).image, -1);
}

TEST(GltfRead, ImagesComeFromUriAndBufferView) {
  GltfBuilder builder;
  const int view = builder.add_view(test::to_bytes("pixels"));
  builder.json["images"] = Json::array({{{"uri", "data:image/png;base64,aGVsbG8="}, {"extras", 7}},
                                        {{"bufferView", view}, {"mimeType", "image/avif"}, {"name", "n"}}});
  const Model model = read(builder);
  EXPECT_EQ(model.images.at(0).bytes, (std::vector<std::uint8_t>{'h', 'e', 'l', 'l', 'o'}));
  EXPECT_EQ(model.images[0].mime_type, "image/png");
  EXPECT_EQ(model.images[0].uri, "");
  EXPECT_EQ(Json::parse(model.images[0].json), (Json{{"extras", 7}}));
  EXPECT_EQ(model.images.at(1).bytes, (std::vector<std::uint8_t>{'p', 'i', 'x', 'e', 'l', 's'}));
  EXPECT_EQ(model.images[1].mime_type, "image/avif");
  EXPECT_EQ(model.images[1].name, "n");
}

TEST(GltfRead, NodesSkinsCamerasAndAnimations) {
  GltfBuilder builder = GltfBuilder::triangle();
  std::vector<float> identity(16, 0.0f);
  for (int i = 0; i < 4; ++i) identity[5 * i] = 1;
  builder.json["nodes"] = Json::parse(R"([
    {"mesh": 0, "skin": 0, "weights": []},
    {"children": [2], "translation": [1, 2, 3], "rotation": [0, 0, 1, 0], "scale": [2, 2, 2], "extras": {"a": 1}},
    {"matrix": [1,0,0,0, 0,1,0,0, 0,0,1,0, 5,6,7,1], "camera": 0}])");
  builder.json["cameras"] = Json::parse(R"([
    {"type": "perspective", "perspective": {"yfov": 0.5, "znear": 0.1, "aspectRatio": 1.5}},
    {"type": "orthographic", "orthographic": {"xmag": 2, "ymag": 3, "znear": 0, "zfar": 9}}])");
  builder.json["skins"] = {{{"joints", {1}},
                            {"skeleton", 1},
                            {"inverseBindMatrices", builder.add_accessor<float>(identity, "MAT4")}}};
  const int times = builder.add_accessor<float>({0, 1}, "SCALAR");
  const int turns = builder.add_accessor<std::int16_t>({0, 0, 0, 32767, 0, 0, 32767, 0}, "VEC4", true);
  builder.json["animations"] = {
      {{"name", "a"},
       {"samplers", {{{"input", times}, {"output", turns}, {"interpolation", "STEP"}}}},
       {"channels", {{{"sampler", 0}, {"target", {{"node", 1}, {"path", "rotation"}}}}}}}};
  const Model model = read(builder);
  EXPECT_EQ(model.nodes[1].children, std::vector<int>{2});
  EXPECT_EQ(model.nodes[1].translation, (Vec3d{1, 2, 3}));
  EXPECT_EQ(model.nodes[1].rotation, (Quat{0, 0, 1, 0}));
  EXPECT_FALSE(model.nodes[1].matrix.has_value());
  EXPECT_EQ(Json::parse(model.nodes[1].json), builder.json["nodes"][1]);
  ASSERT_TRUE(model.nodes[2].matrix.has_value());
  EXPECT_EQ((*model.nodes[2].matrix)(1, 3), 6);
  EXPECT_EQ(model.nodes[2].camera, 0);
  EXPECT_EQ(model.cameras[0].aspect, 1.5);
  EXPECT_FALSE(model.cameras[1].perspective);
  EXPECT_EQ(model.cameras[1].ymag, 3);
  EXPECT_EQ(model.skins.at(0).joints, std::vector<int>{1});
  ASSERT_TRUE(model.skins[0].inverse_bind.has_value());
  EXPECT_EQ(model.skins[0].inverse_bind->to_floats(), identity);
  EXPECT_EQ(Json::parse(model.skins[0].json).count("inverseBindMatrices"), 0u);
  const Animation& animation = model.animations.at(0);
  EXPECT_EQ(animation.samplers.at(0).interpolation, Interpolation::step);
  EXPECT_EQ(animation.samplers[0].output.storage, (Storage{ComponentType::i16, true}));
  EXPECT_EQ(animation.samplers[0].output.bytes.size(), 16u);
  EXPECT_EQ(animation.channels.at(0).path, "rotation");
}

TEST(GltfRead, JointsBeyondTheSkinAreTold) {
  GltfBuilder builder = GltfBuilder::triangle();
  Json& attributes = primitive_of(builder)["attributes"];
  attributes["JOINTS_0"] = builder.add_accessor<std::uint8_t>({0, 0, 0, 0, 5, 0, 0, 0, 0, 0, 0, 0}, "VEC4");
  attributes["WEIGHTS_0"] = builder.add_accessor<float>({1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0}, "VEC4");
  builder.json["nodes"][0]["skin"] = 0;
  builder.json["skins"] = {{{"joints", {0}}}};
  Context context;
  read(builder.glb(), context);
  EXPECT_EQ(codes(context), std::vector<std::string>{"joint-out-of-range"});
}

TEST(GltfRead, InstancesAreReadAndTheirDataIsCarried) {
  GltfBuilder builder = GltfBuilder::triangle();
  const int unused = builder.add_accessor<float>({1}, "SCALAR");
  const int translation = builder.add_accessor<float>({1, 0, 0, 2, 0, 0}, "VEC3");
  const int id = builder.add_accessor<std::uint16_t>({7, 8}, "SCALAR");
  builder.json["nodes"][0]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"] = {
      {"TRANSLATION", translation}, {"_ID", id}};
  builder.json["extensionsUsed"] = {"EXT_mesh_gpu_instancing"};
  const Model model = read(builder);
  ASSERT_EQ(model.nodes[0].instances.size(), 2u);
  EXPECT_EQ(transform_point(model.nodes[0].instances[1], {0, 0, 0}), (Vec3d{2, 0, 0}));
  EXPECT_GT(translation, unused);
  ASSERT_EQ(model.carried_accessors.size(), 2u);
  EXPECT_EQ(model.carried_accessors[1].to_floats(), (std::vector<float>{7, 8}));
  const Json kept = Json::parse(model.nodes[0].json)["extensions"]["EXT_mesh_gpu_instancing"]["attributes"];
  EXPECT_EQ(kept, (Json{{"TRANSLATION", 0}, {"_ID", 1}}));
  EXPECT_EQ(model.extensions_used, std::vector<std::string>{"EXT_mesh_gpu_instancing"});
}

TEST(GltfRead, InstancesAreFinite) {
  GltfBuilder builder = GltfBuilder::triangle();
  const int t = builder.add_accessor<float>({std::numeric_limits<float>::quiet_NaN(), 1, 2}, "VEC3");
  builder.json["nodes"][0]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"]["TRANSLATION"] = t;
  Context context;
  const Model model = read(builder.glb(), context);
  EXPECT_EQ(transform_point(model.nodes[0].instances.at(0), {0, 0, 0}), (Vec3d{0, 1, 2}));
  EXPECT_EQ(codes(context), std::vector<std::string>{"non-finite-values"});
}

TEST(GltfRead, DataOfUnknownExtensionsIsCarriedOnceAndRenumbered) {
  GltfBuilder builder = GltfBuilder::triangle();
  const int view = builder.add_view(test::to_bytes("sound"));
  const int accessor = builder.add_accessor<float>({1, 2, 3}, "SCALAR");
  builder.json["extensions"]["KHR_audio"]["audio"] =
      Json::array({{{"bufferView", view}, {"mimeType", "audio/mpeg"}}});
  builder.json["nodes"][0]["extensions"]["X"] = {
      {"deep", {{"colorAccessor", accessor}, {"bufferView", view}}},
      {"accessor", "a name"},
      {"extras", {{"accessor", 999}}}};
  builder.json["nodes"][0]["extras"] = {{"bufferView", 999}};
  const Model model = read(builder);
  ASSERT_EQ(model.carried_buffer_views.size(), 1u);
  EXPECT_EQ(model.carried_buffer_views[0], test::to_bytes("sound"));
  ASSERT_EQ(model.carried_accessors.size(), 1u);
  const Json node = Json::parse(model.nodes[0].json);
  EXPECT_EQ(node["extensions"]["X"]["deep"], (Json{{"colorAccessor", 0}, {"bufferView", 0}}));
  EXPECT_EQ(node["extensions"]["X"]["accessor"], "a name");
  EXPECT_EQ(node["extensions"]["X"]["extras"]["accessor"], 999);
  EXPECT_EQ(node["extras"]["bufferView"], 999);
  const Json root = Json::parse(model.json);
  EXPECT_EQ(root["extensions"]["KHR_audio"]["audio"][0]["bufferView"], 0);
}

TEST(GltfRead, ElementsKeepWhatFoveaDoesNotKnowInItsOrder) {
  GltfBuilder builder = GltfBuilder::triangle();
  builder.json["zebra"] = {{"z", 1}, {"a", 2}};
  builder.json["asset"]["generator"] = "g";
  builder.json["meshes"][0]["extras"] = {{"targetNames", {"x"}}};
  primitive_of(builder)["extras"] = {{"b", 0.1}};
  const Model model = read(builder);
  EXPECT_EQ(model.meshes[0].json, R"({"extras":{"targetNames":["x"]}})");
  EXPECT_EQ(model.meshes[0].surface.parts[0].json, R"({"extras":{"b":0.1}})");
  EXPECT_EQ(model.json, R"({"asset":{"version":"2.0","generator":"g"},"scene":0,"zebra":{"z":1,"a":2}})");
}

TEST(GltfRead, ExtensionsThatNumberVerticesAreDroppedAndTold) {
  GltfBuilder builder = GltfBuilder::triangle();
  primitive_of(builder)["extensions"] = {{"CESIUM_primitive_outline", {{"indices", 1}}},
                                         {"OTHER", {{"x", 1}}}};
  builder.json["extensionsUsed"] = {"CESIUM_primitive_outline", "OTHER"};
  Context context;
  const Model model = read(builder.glb(), context);
  EXPECT_EQ(codes(context), std::vector<std::string>{"extension-dropped"});
  EXPECT_EQ(model.meshes[0].surface.parts[0].json, R"({"extensions":{"OTHER":{"x":1}}})");
  EXPECT_EQ(model.extensions_used, std::vector<std::string>{"OTHER"});
}

TEST(GltfRead, RequiredExtensionIsRefusedOnlyIfItTouchesGeometry) {
  GltfBuilder builder = GltfBuilder::triangle();
  builder.json["extensionsUsed"] = builder.json["extensionsRequired"] = {"NEW_thing"};
  builder.json["nodes"][0]["extensions"]["NEW_thing"] = Json::object();
  Context context;
  const Model model = read(builder.glb(), context);
  EXPECT_EQ(codes(context), std::vector<std::string>{"unknown-required-extension"});
  EXPECT_EQ(model.extensions_required, std::vector<std::string>{"NEW_thing"});

  builder.json["accessors"][0]["extensions"]["NEW_thing"] = Json::object();
  try {
    read(builder);
    FAIL() << "an accessor that is not understood was read";
  } catch (const Error& e) {
    EXPECT_EQ(e.kind(), ErrorKind::unsupported);
    EXPECT_NE(e.message().find("NEW_thing"), std::string::npos);
    EXPECT_EQ(e.place(), "test.glb: /accessors/0/extensions/NEW_thing");
  }
}

TEST(GltfRead, MorphWeightsOfNodesFitTheirMesh) {
  GltfBuilder builder = GltfBuilder::triangle();
  primitive_of(builder)["targets"] = Json::array({{{"POSITION", 0}}});
  builder.json["nodes"][0]["weights"] = {0.5, 0.5, 0.5};
  Context context;
  const Model model = read(builder.glb(), context);
  EXPECT_EQ(model.nodes[0].morph_weights, std::vector<double>{0.5});
  EXPECT_EQ(codes(context), std::vector<std::string>{"morph-weights"});
}

}  // namespace
}  // namespace fovea
