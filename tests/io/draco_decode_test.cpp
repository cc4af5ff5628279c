#include "fovea/io/draco_decode.h"

#include <gtest/gtest.h>

#include "fovea/base/context.h"
#include "fovea/base/error.h"
#include "fovea/io/gltf_read.h"
#include "support/gltf_builder.h"

namespace fovea::gltf {
namespace {

using test::from_hex;
using test::GltfBuilder;
using TestJson = GltfBuilder::Json;

// A unit square of two triangles with uv = xy, encoded by Draco 1.5.5 with 8 bits, in its two ways. Attribute
// 0 is the position, 1 the uv.
constexpr const char* kSequential =
    "445241434f020201000000020401000102000203010200090300000309020001020200010100030301300110030034828804"
    "00000000ff0000000001010003030130011003003482a40000000000ff0000000000000000000000000000000000803f0800"
    "000000000000000000803f08";
constexpr const char* kEdgebreaker =
    "445241434f02020101000000040201020000011fff0111ff011102ff00000000000100090300000201030902000102010101"
    "0003030130011003002882980000000000ff0000000000000000000000000000000000803f08010101000303013001100300"
    "28822c0000000000ff00000000000000000000000000803f08";

AccessorShape shape(int width, std::size_t count) {
  return {{ComponentType::f32, false}, width, false, count};
}

/// A primitive whose data is the stream; its accessors have no data of their own.
GltfBuilder square(const char* stream) {
  GltfBuilder builder;
  const int view = builder.add_view(from_hex(stream));
  builder.json["accessors"] = TestJson::parse(R"([{"componentType": 5126, "type": "VEC3", "count": 4},
    {"componentType": 5126, "type": "VEC2", "count": 4}, {"componentType": 5123, "type": "SCALAR", "count": 6}])");
  TestJson primitive = TestJson::parse(R"({"attributes": {"POSITION": 0, "TEXCOORD_0": 1}, "indices": 2})");
  primitive["extensions"]["KHR_draco_mesh_compression"] = {
      {"bufferView", view}, {"attributes", {{"POSITION", 0}, {"TEXCOORD_0", 1}}}};
  builder.add_mesh(primitive);
  builder.json["extensionsUsed"] = builder.json["extensionsRequired"] = {"KHR_draco_mesh_compression"};
  return builder;
}

TEST(DracoDecode, PrimitivesTakeTheirDataFromTheStream) {
  for (const char* stream : {kSequential, kEdgebreaker}) {
    Context context;
    const Model model = read_gltf(square(stream).glb(), ".", "test.glb", {}, context);
    const TriMesh& mesh = model.meshes.at(0).surface;
    check(mesh);
    EXPECT_EQ(mesh.face_count(), 2u);
    EXPECT_EQ(mesh.vertex_count(), 4u);
    const AttributeLayer* uv = mesh.find(Semantic::uv);
    ASSERT_NE(uv, nullptr);
    for (std::size_t c = 0; c < 6; ++c) {
      const Vec3f p = mesh.positions[mesh.vertex(CornerId{c}).index()];
      const float* t = uv->value(uv->corner_value[c]);
      // 0 and 1 are the ends of the quantised range, so they come back as they were.
      EXPECT_EQ(p.x, t[0]);
      EXPECT_EQ(p.y, t[1]);
      EXPECT_TRUE((p.x == 0 || p.x == 1) && (p.y == 0 || p.y == 1));
    }
    EXPECT_EQ(mesh.parts.at(0).json, "{}");
    EXPECT_TRUE(model.extensions_used.empty());
    EXPECT_TRUE(model.extensions_required.empty());
  }
}

TEST(DracoDecode, ClaimsAreHeldAgainstTheAccessors) {
  for (const char* encoded : {kSequential, kEdgebreaker}) {
    const auto stream = from_hex(encoded);
    const DracoAttribute good[] = {{0, shape(3, 4)}, {1, shape(2, 4)}};
    EXPECT_EQ(decode_draco(stream, good, 2).indices.size(), 6u);
    EXPECT_THROW(decode_draco(stream, good, 1), Error);
    const DracoAttribute few[] = {{0, shape(3, 3)}};
    EXPECT_THROW(decode_draco(stream, few, 2), Error);
    const DracoAttribute missing[] = {{7, shape(3, 4)}};
    EXPECT_THROW(decode_draco(stream, missing, 2), Error);
    const DracoAttribute narrow[] = {{0, shape(2, 4)}};
    EXPECT_THROW(decode_draco(stream, narrow, 2), Error);
    for (std::size_t length = 0; length < stream.size(); ++length) {
      EXPECT_THROW(decode_draco(std::span(stream).first(length), good, 2), Error) << length;
    }
  }
}

TEST(DracoDecode, OtherVersionsAreUnsupported) {
  auto stream = from_hex(kEdgebreaker);
  stream[6] = std::byte{1};
  try {
    decode_draco(stream, {}, 2);
    FAIL();
  } catch (const Error& e) {
    EXPECT_EQ(e.kind(), ErrorKind::unsupported);
  }
}

// Any byte may stand where a truth value is read, which is undefined; tests/fuzz/seeds/draco has one.
TEST(DracoDecode, TruthValuesAreRefused) {
  auto stream = from_hex(kSequential);
  ASSERT_EQ(stream[23], std::byte{9}) << "the position's type, float";
  stream[23] = std::byte{11};
  const std::vector<DracoAttribute> position{{0, shape(3, 4)}};
  EXPECT_THROW(decode_draco(stream, position, 2), Error);
}

TEST(DracoDecode, UncompressedAttributesMayStandBesideTheStream) {
  GltfBuilder builder = square(kEdgebreaker);
  const int heat = builder.add_accessor<float>({1, 2, 3, 4}, "SCALAR");
  builder.json["meshes"][0]["primitives"][0]["attributes"]["_HEAT"] = heat;
  Context context;
  const Model model = read_gltf(builder.glb(), ".", "test.glb", {}, context);
  EXPECT_NE(model.meshes[0].surface.find(Semantic::custom), nullptr);
  builder.json["accessors"][heat]["count"] = 3;
  EXPECT_THROW(read_gltf(builder.glb(), ".", "test.glb", {}, context), Error);
}

}  // namespace
}  // namespace fovea::gltf
