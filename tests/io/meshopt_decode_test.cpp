#include "fovea/io/meshopt_decode.h"

#include <gtest/gtest.h>

#include <cstring>

#include "fovea/base/context.h"
#include "fovea/base/error.h"
#include "fovea/io/gltf_read.h"
#include "fovea/io/meshopt_vertex_v1.h"
#include "support/gltf_builder.h"

namespace fovea::gltf {
namespace {

using test::from_hex;

// Streams of version 1, made by the encoder of meshoptimizer 1.3.0 from `sample_vertices`, at level 0 (byte
// deltas only) and 3 (all three kinds of channels, all four control modes).
constexpr const char* kLevel0 =
    "a15a55aa552f0020202020202020201010101010101010101010101010101008080808080808888888880000000000000102"
    "000000000f004a4a4a4a4a4a4a4a4a4a4a4a4a4a4a4a4a4a4a4a4a4a4a4a4a4a4a4a4a4a4aff004a4a4a4a4a4a4a4a052000"
    "8002000800201000020f0015151515151515151515151515151515151515151515151515151515151515ff00151515151515"
    "15152a0888888868888888888888888888888688888888000000000f00062a72de9122fa09e95a3db1fed2cae6d97512be71"
    "8265d636459dd1e1cd95ff003946ea4d9e51e23a0f00beeeb1219e71ae0181d1f1e1a1316ec13e91ce5e1e0e2e7efe518e61"
    "de4e11ff004141114ede618e510f00894d2ade31fa620619025aee41ca1269a9ad7501ae65c226395d450e9e9572ff0049c9"
    "f2eae1713add0f002e76f921fe66160e4ed659be1e3949116ec94661c1d9a9318e69e67e5e86f6ff0051ae0979a181199600"
    "0000000000803fe80350c3efbeadde0000000000000000";
constexpr const char* kLevel3 =
    "a1687baaff0100011f1a04c4f4c4f262e2621cfcf262e262f13171311e3edddd00000f030703004a4a4a4a4a4a4a4a4a4a4a"
    "4a4a4a4a4a4a4a4a4a4a4a4a4a4a4a4a4a4a4a4a4a4a4a4a4a4a4a4a00eaeaeaeaeaeaeaeaeaeaeaeaeaeaeaeaeaeaeaeaea"
    "eaeaeaeaeaeaeaeaeaeaeaeaeaeaeaeaeaea2a07777777777777777777777777777777777777770000000000062a72de9122"
    "fa09e95a3db1fed2cae6d97512be718265d636459dd1e1cd953946ea4d9e51e23a00beeeb1219e71ae0181d1f1e1a1316ec1"
    "3e91ce5e1e0e2e7efe518e61de4e114141114ede618e5100894d2ade31fa620619025aee41ca1269a9ad7501ae65c226395d"
    "450e9e957249c9f2eae1713add002e76f921fe66160e4ed659be1e3949116ec94661c1d9a9318e69e67e5e86f651ae0979a1"
    "811996000000000000803fe80350c3efbeadde0000000062010000";

/// 40 elements of 16 bytes: a float that grows, two 16-bit ramps (one wraps around), a constant, noise.
std::vector<std::byte> sample_vertices() {
  std::vector<std::byte> bytes(40 * 16);
  for (std::uint32_t i = 0; i < 40; ++i) {
    std::byte* element = bytes.data() + i * 16;
    const float ramp = 1.0f + static_cast<float>(i) * 0.125f;
    const std::uint16_t words[2] = {static_cast<std::uint16_t>(1000 + 37 * i),
                                    static_cast<std::uint16_t>(50000 + 1013 * i)};
    const std::uint32_t constant = 0xDEADBEEF;
    std::memcpy(element, &ramp, 4);
    std::memcpy(element + 4, words, 4);
    std::memcpy(element + 8, &constant, 4);
    for (std::uint32_t k = 0; k < 4; ++k)
      element[12 + k] = static_cast<std::byte>(i * i * i * (k + 3) + i * 91 * k);
  }
  return bytes;
}

TEST(MeshoptDecode, Version1OfTheVertexCodec) {
  for (const char* encoded : {kLevel0, kLevel3}) {
    const auto stream = from_hex(encoded);
    std::vector<std::byte> out(40 * 16);
    ASSERT_TRUE(decode_vertices_v1(stream, 40, 16, out.data()));
    EXPECT_EQ(out, sample_vertices());
  }
}

TEST(MeshoptDecode, Version1OverSeveralBlocks) {
  // 600 × 4 bytes in blocks of 256: 0x01020304 + (i >> 8).
  const auto stream =
      from_hex("a1aaa801000000010002a80100010002000000000000000000000000000000000000000403020100");
  std::vector<std::byte> out(600 * 4);
  ASSERT_TRUE(decode_vertices_v1(stream, 600, 4, out.data()));
  for (std::uint32_t i = 0; i < 600; ++i) {
    std::uint32_t value = 0;
    std::memcpy(&value, out.data() + 4 * i, 4);
    ASSERT_EQ(value, 0x01020304 + (i >> 8)) << i;
  }
}

TEST(MeshoptDecode, DamagedVersion1StreamsAreRefused) {
  const auto stream = from_hex(kLevel3);
  std::vector<std::byte> out(40 * 16);
  for (std::size_t length = 0; length < stream.size(); ++length) {
    EXPECT_FALSE(decode_vertices_v1(std::span(stream).first(length), 40, 16, out.data())) << length;
  }
  auto longer = stream;
  longer.insert(longer.begin() + 40, std::byte{0});
  EXPECT_FALSE(decode_vertices_v1(longer, 40, 16, out.data()));
  auto bad_channel = stream;
  bad_channel.back() = std::byte{3};
  EXPECT_FALSE(decode_vertices_v1(bad_channel, 40, 16, out.data()));
}

TEST(MeshoptDecode, ColorFilter) {
  struct Case {
    std::size_t stride;
    const char* encoded;
    const char* decoded;  // by the decoder of meshoptimizer 1.3.0
  };
  const Case cases[] = {
      {4, "a1ff0080ff01c2006a980080007e00008b00bd3ffe6500000000000000000000000000000000000000407fc1ff00",
       "fe0100ff3480cc4000000000ffffffffe61a6698"},
      {8,
       "a1ffff000000010200080f1e11006a67000000170a000800010000cb000800000900020001650009030e05000000000000000"
       "000000000"
       "00000004ff0701fcff0f0000",
       "efff10000000ffff43330880cccc04400000000000000000ffffffffffffffff6ee6a21966668999"}};
  for (const Case& c : cases) {
    const auto stream = from_hex(c.encoded);
    EXPECT_EQ(decode_meshopt({stream, 5, c.stride, "ATTRIBUTES", "COLOR"}), from_hex(c.decoded)) << c.stride;
  }
}

TEST(MeshoptDecode, ImpossibleLayoutsAndCountsAreRefusedBeforeAnythingIsAllocated) {
  const auto stream = from_hex(kLevel3);
  const std::size_t huge = std::size_t{1} << 52;
  const MeshoptStream bad[] = {{stream, 40, 0, "ATTRIBUTES", "NONE"},
                               {stream, 40, 6, "ATTRIBUTES", "NONE"},
                               {stream, 40, 260, "ATTRIBUTES", "NONE"},
                               {stream, huge, 16, "ATTRIBUTES", "NONE"},
                               {stream, 40, 16, "ATTRIBUTES", "COLOR"},
                               {stream, 40, 16, "ATTRIBUTES", "OCTAHEDRAL"},
                               {stream, 40, 4, "ATTRIBUTES", "QUATERNION"},
                               {stream, 40, 2, "TRIANGLES", "NONE"},
                               {stream, 39, 3, "TRIANGLES", "NONE"},
                               {stream, 39, 4, "TRIANGLES", "OCTAHEDRAL"},
                               {stream, huge - huge % 3, 4, "TRIANGLES", "NONE"},
                               {stream, huge, 4, "INDICES", "NONE"},
                               {stream, 40, 16, "NONSENSE", "NONE"},
                               {{}, 0, 16, "ATTRIBUTES", "NONE"}};
  for (const MeshoptStream& s : bad) {
    try {
      check_meshopt(s);
      ADD_FAILURE() << s.mode << " " << s.filter << " " << s.count << " × " << s.stride;
    } catch (const Error& e) {
      EXPECT_EQ(e.kind(), ErrorKind::format);
    }
  }
}

TEST(MeshoptDecode, ViewsOfEitherExtensionAreDecompressed) {
  for (const char* name : {"EXT_meshopt_compression", "KHR_meshopt_compression"}) {
    test::GltfBuilder builder;
    builder.add_view(from_hex(kLevel3));
    // View 1 lies in a buffer that has no data: it is there for readers without the extension.
    builder.json["buffers"].push_back({{"byteLength", 640}});
    test::GltfBuilder::Json view = {{"buffer", 1}, {"byteLength", 640}, {"byteStride", 16}};
    view["extensions"][name] = {
        {"buffer", 0}, {"byteLength", 327}, {"byteStride", 16}, {"count", 40}, {"mode", "ATTRIBUTES"}};
    builder.json["bufferViews"].push_back(view);
    const int position = builder.add_accessor_json(1, 3, 5126, "SCALAR", false);
    builder.json["nodes"] =
        test::GltfBuilder::Json::array({{{"extensions", {{"X", {{"accessor", position}}}}}}});
    builder.json["extensionsUsed"] = builder.json["extensionsRequired"] = {name};
    Context context;
    const Model model = read_gltf(builder.glb(), ".", "test.glb", {}, context);
    ASSERT_EQ(model.carried_accessors.size(), 1u);
    EXPECT_EQ(model.carried_accessors[0].to_floats(), (std::vector<float>{1.0f, 1.125f, 1.25f}));
    EXPECT_TRUE(model.extensions_used.empty());
    EXPECT_TRUE(model.extensions_required.empty());
  }
}

}  // namespace
}  // namespace fovea::gltf
