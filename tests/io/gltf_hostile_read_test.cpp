#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <functional>

#include "fovea/base/error.h"
#include "fovea/io/gltf_read.h"
#include "support/gltf_builder.h"

namespace fovea {
namespace {

using test::GltfBuilder;
using Json = GltfBuilder::Json;

constexpr const char* kPlace = "bad.glb";

Model read(const std::vector<std::byte>& bytes, const ReadOptions& options = {},
           const std::filesystem::path& folder = "/nonexistent") {
  Context context;
  return read_gltf(bytes, folder, kPlace, options, context);
}

/// A file with something of everything, all of it sound: the ground that the cases below damage.
GltfBuilder sound_model() {
  GltfBuilder b = GltfBuilder::triangle();
  Json& primitive = b.json["meshes"][0]["primitives"][0];
  primitive["material"] = 0;
  primitive["attributes"]["TEXCOORD_0"] = b.add_accessor<float>({0, 0, 1, 0, 0, 1}, "VEC2");  // 2
  primitive["targets"] = Json::array({{{"POSITION", 0}}});
  const int times = b.add_accessor<float>({0, 1}, "SCALAR");                         // 3
  const int moves = b.add_accessor<float>({0, 0, 0, 1, 1, 1}, "VEC3");               // 4
  const int matrices = b.add_accessor<float>(std::vector<float>(16, 0.0f), "MAT4");  // 5
  const std::vector<std::uint8_t> sparse_indices = {1};
  const int iv = b.add_view(std::as_bytes(std::span(sparse_indices)));
  b.json["accessors"][2]["sparse"] = {{"count", 1},
                                      {"indices", {{"bufferView", iv}, {"componentType", 5121}}},
                                      {"values", {{"bufferView", 0}}}};
  b.json["images"] =
      Json::array({{{"uri", "data:image/png;base64,AAAA"}}, {{"bufferView", 0}, {"mimeType", "image/png"}}});
  b.json["samplers"] = Json::array({{{"wrapS", 10497}}});
  b.json["textures"] = Json::array({{{"source", 0}, {"sampler", 0}}});
  b.json["materials"] = Json::parse(R"([{"pbrMetallicRoughness": {"baseColorTexture": {"index": 0}}}])");
  b.json["cameras"] = Json::parse(R"([{"type": "perspective", "perspective": {"yfov": 1, "znear": 1}}])");
  b.json["nodes"].push_back({{"camera", 0}, {"children", {2}}});
  b.json["nodes"].push_back({{"skin", 0}, {"mesh", 0}});
  b.json["nodes"][0]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"]["TRANSLATION"] = moves;
  b.json["skins"] = {{{"joints", {1}}, {"inverseBindMatrices", matrices}}};
  b.json["animations"] = {
      {{"samplers", {{{"input", times}, {"output", moves}}}},
       {"channels", {{{"sampler", 0}, {"target", {{"node", 1}, {"path", "translation"}}}}}}}};
  return b;
}

TEST(GltfHostile, TheSoundModelIsSound) {
  const Model model = read(sound_model().glb());
  EXPECT_EQ(model.meshes.at(0).surface.face_count(), 1u);
  EXPECT_EQ(model.nodes.at(0).instances.size(), 2u);
}

/// A damage: what is written at a JSON pointer (nothing: the member is removed), and where the error says
/// that it is.
struct Damage {
  const char* pointer;
  const char* value;
  const char* place;
  ErrorKind kind = ErrorKind::format;
};

const Damage kDamages[] = {
    // asset
    {"/asset", "", ""},
    {"/asset", "[]", "/asset"},
    {"/asset/version", "\"1.0\"", "/asset/version", ErrorKind::unsupported},
    {"/asset/version", "2", "/asset/version"},
    {"/asset/minVersion", "\"2.1\"", "/asset/minVersion", ErrorKind::unsupported},
    // accessors
    {"/accessors/0/count", "4294967296", "/accessors/0/count", ErrorKind::limit},
    {"/accessors/0/count", "18446744073709551615", "/accessors/0/count"},
    {"/accessors/0/count", "-1", "/accessors/0/count"},
    {"/accessors/0/count", "1.5", "/accessors/0/count"},
    {"/accessors/0/count", "1e300", "/accessors/0/count"},
    {"/accessors/0/count", "\"3\"", "/accessors/0/count"},
    {"/accessors/0/count", "4", "/accessors/0"},
    {"/accessors/0/count", "", "/accessors/0"},
    {"/accessors/0/count", "2", "/meshes/0/primitives/0/attributes/TEXCOORD_0"},
    {"/accessors/0/type", "\"VEC5\"", "/accessors/0/type"},
    {"/accessors/0/type", "\"VEC2\"", "/meshes/0/primitives/0/attributes/POSITION"},
    {"/accessors/0/type", "3", "/accessors/0/type"},
    {"/accessors/0/componentType", "5124", "/accessors/0/componentType"},
    {"/accessors/0/componentType", "5130", "/accessors/0/componentType"},
    {"/accessors/0/componentType", "", "/accessors/0"},
    {"/accessors/0/normalized", "1", "/accessors/0/normalized"},
    {"/accessors/0/byteOffset", "9007199254740992", "/accessors/0"},
    {"/accessors/0/byteOffset", "-4", "/accessors/0/byteOffset"},
    {"/accessors/0/byteOffset", "4", "/accessors/0"},
    {"/accessors/0/bufferView", "99", "/accessors/0/bufferView"},
    {"/accessors/0/bufferView", "-1", "/accessors/0/bufferView"},
    {"/accessors/0/bufferView", "{}", "/accessors/0/bufferView"},
    {"/accessors/1/type", "\"VEC2\"", "/accessors/1"},
    {"/accessors/1/componentType", "5122", "/meshes/0/primitives/0/indices"},
    {"/accessors/2/sparse/count", "4", "/accessors/2/sparse/count"},
    {"/accessors/2/sparse/count", "2", "/accessors/2/sparse/indices"},
    {"/accessors/2/sparse/indices/componentType", "5126", "/accessors/2/sparse/indices/componentType"},
    {"/accessors/2/sparse/indices/bufferView", "0.5", "/accessors/2/sparse/indices/bufferView"},
    {"/accessors/2/sparse/values/byteOffset", "1e15", "/accessors/2/sparse/values"},
    {"/accessors/2/sparse/values", "", "/accessors/2/sparse"},
    {"/accessors/2/sparse/indices/bufferView", "1", "/accessors/2/sparse/indices",
     ErrorKind::internal},  // fits by luck
    {"/accessors", "{}", "/accessors"},
    // buffers and views
    {"/bufferViews/0/byteLength", "1e12", "/bufferViews/0"},
    {"/bufferViews/0/byteOffset", "9007199254740991", "/bufferViews/0"},
    {"/bufferViews/0/byteStride", "0", "/bufferViews/0/byteStride"},
    {"/bufferViews/0/byteStride", "8", "/accessors/0"},
    {"/bufferViews/0/byteStride", "1e9", "/bufferViews/0/byteStride"},
    {"/bufferViews/0/buffer", "1", "/bufferViews/0/buffer"},
    {"/bufferViews/0", "7", "/bufferViews/0"},
    {"/buffers/0/byteLength", "1e6", "/buffers/0/byteLength"},
    {"/buffers/0/byteLength", "10", "/bufferViews/0"},
    {"/buffers/0/uri", "\"data:;base64,AAAA\"", "/buffers/0/byteLength"},
    {"/buffers/0/uri", "\"data:;base64,A*AA\"", "/buffers/0/uri"},
    {"/buffers/0/uri", "\"../secret.bin\"", "/buffers/0/uri"},
    {"/buffers/0/uri", "\"/etc/passwd\"", "/buffers/0/uri"},
    {"/buffers/0/uri", "\"http://host/x.bin\"", "/buffers/0/uri"},
    {"/buffers/0/uri", "\"missing.bin\"", "/buffers/0/uri", ErrorKind::input},
    {"/bufferViews/0/extensions/EXT_meshopt_compression", "{}",
     "/bufferViews/0/extensions/EXT_meshopt_compression"},
    {"/bufferViews/0/extensions/EXT_meshopt_compression",
     R"({"buffer": 0, "byteLength": 36, "byteStride": 12, "count": 3, "mode": "ATTRIBUTES"})",
     "/bufferViews/0/extensions/EXT_meshopt_compression"},
    {"/bufferViews/0/extensions/EXT_meshopt_compression",
     R"({"buffer": 0, "byteLength": 36, "byteStride": 256, "count": 9000000000000000, "mode": "ATTRIBUTES"})",
     "/bufferViews/0/extensions/EXT_meshopt_compression"},
    {"/bufferViews/0/extensions/EXT_meshopt_compression",
     R"({"buffer": 0, "byteLength": 9000000000000000, "byteStride": 4, "count": 3, "mode": "ATTRIBUTES"})",
     "/bufferViews/0/extensions/EXT_meshopt_compression"},
    // meshes
    {"/meshes/0/primitives", "", "/meshes/0"},
    {"/meshes/0/primitives/0", "null", "/meshes/0/primitives/0"},
    {"/meshes/0/primitives/0/attributes", "", "/meshes/0/primitives/0"},
    {"/meshes/0/primitives/0/attributes/POSITION", "77", "/meshes/0/primitives/0/attributes/POSITION"},
    {"/meshes/0/primitives/0/attributes/POSITION", "null", "/meshes/0/primitives/0/attributes/POSITION"},
    {"/meshes/0/primitives/0/attributes/NORMAL", "2", "/meshes/0/primitives/0/attributes/NORMAL"},
    {"/meshes/0/primitives/0/attributes/JOINTS_0", "0", "/meshes/0/primitives/0/attributes/JOINTS_0"},
    {"/meshes/0/primitives/0/indices", "0", "/meshes/0/primitives/0/indices"},
    {"/meshes/0/primitives/0/mode", "7", "/meshes/0/primitives/0/mode"},
    {"/meshes/0/primitives/0/material", "1", "/meshes/0/primitives/0/material"},
    {"/meshes/0/primitives/0/targets/0/POSITION", "2", "/meshes/0/primitives/0/targets/0/POSITION"},
    {"/meshes/0/primitives/0/targets/0/POSITION", "4", "/meshes/0/primitives/0/targets/0/POSITION"},
    {"/meshes/0/primitives/1", R"({"attributes": {"POSITION": 0}})", "/meshes/0/primitives/1"},
    {"/meshes/0/weights", "[1, \"x\"]", "/meshes/0/weights"},
    {"/meshes/0/primitives/0/extensions/KHR_draco_mesh_compression",
     R"({"bufferView": 0, "attributes": {"POSITION": 0}})",
     "/meshes/0/primitives/0/extensions/KHR_draco_mesh_compression"},
    {"/meshes/0/primitives/0/extensions/KHR_draco_mesh_compression",
     R"({"bufferView": 0, "attributes": {"NORMAL": 0}})",
     "/meshes/0/primitives/0/extensions/KHR_draco_mesh_compression/attributes/NORMAL"},
    {"/meshes/0/primitives/0/extensions/KHR_draco_mesh_compression", "3",
     "/meshes/0/primitives/0/extensions/KHR_draco_mesh_compression"},
    {"/meshes/0/primitives/0/extensions/KHR_materials_variants", R"({"mappings": [{"material": 5}]})",
     "/meshes/0/primitives/0/extensions/KHR_materials_variants/mappings/0/material"},
    // nodes and scenes
    {"/nodes/1/children", "[1]", "/nodes/1"},
    {"/nodes/2/children", "[1]", "/nodes/1"},
    {"/nodes/0/children", "[2]", "/nodes/1/children/0"},
    {"/nodes/0/children", "[2, 2]", "/nodes/0/children/1"},
    {"/nodes/0/children", "[9]", "/nodes/0/children/0"},
    {"/nodes/0/children", "2", "/nodes/0/children"},
    {"/nodes/0/mesh", "1", "/nodes/0/mesh"},
    {"/nodes/0/camera", "1", "/nodes/0/camera"},
    {"/nodes/2/skin", "1", "/nodes/2/skin"},
    {"/nodes/0/matrix", "[1, 2, 3]", "/nodes/0/matrix"},
    {"/nodes/0/rotation", "[0, 0, 0]", "/nodes/0/rotation"},
    {"/nodes/0/scale", "[0, 0, null]", "/nodes/0/scale"},
    {"/nodes/0/name", "5", "/nodes/0/name"},
    {"/nodes/0/extensions/EXT_mesh_gpu_instancing/attributes/SCALE", "0",
     "/nodes/0/extensions/EXT_mesh_gpu_instancing/attributes/SCALE"},
    {"/nodes/0/extensions/EXT_mesh_gpu_instancing/attributes/_ID", "88",
     "/nodes/0/extensions/EXT_mesh_gpu_instancing/attributes/_ID"},
    {"/nodes/0/extensions/KHR_lights_punctual", R"({"light": 0})",
     "/nodes/0/extensions/KHR_lights_punctual/light"},
    {"/nodes/0/extensions/X", R"({"bufferView": 88})", "/nodes/0/extensions/X/bufferView"},
    {"/scene", "1", "/scene"},
    {"/scenes/0/nodes", "[3]", "/scenes/0/nodes/0"},
    {"/scenes", "3", "/scenes"},
    // skins, cameras, animations
    {"/skins/0/joints", "", "/skins/0"},
    {"/skins/0/joints", "[7]", "/skins/0/joints/0"},
    {"/skins/0/joints", "[0, 1]", "/skins/0/inverseBindMatrices"},
    {"/skins/0/inverseBindMatrices", "0", "/skins/0/inverseBindMatrices"},
    {"/cameras/0/type", "\"fisheye\"", "/cameras/0/type"},
    {"/cameras/0/perspective", "", "/cameras/0"},
    {"/cameras/0/perspective/yfov", "\"wide\"", "/cameras/0/perspective/yfov"},
    {"/animations/0/samplers/0/input", "4", "/animations/0/samplers/0/input"},
    {"/animations/0/samplers/0/output", "0", "/animations/0/samplers/0/output"},
    {"/animations/0/samplers/0/interpolation", "\"X\"", "/animations/0/samplers/0/interpolation"},
    {"/animations/0/channels/0/sampler", "1", "/animations/0/channels/0/sampler"},
    {"/animations/0/channels/0/target/node", "12", "/animations/0/channels/0/target/node"},
    {"/animations/0/channels/0/target/path", "\"rotation\"", "/animations/0/channels/0"},
    // textures and materials
    {"/images/0/uri", "\"missing.png\"", "/images/0/uri", ErrorKind::input},
    {"/images/0/uri", "\"data:image/png;base64\"", "/images/0/uri"},
    {"/images/0/uri", "5", "/images/0/uri"},
    {"/images/0", "{}", "/images/0"},
    {"/images/1/bufferView", "40", "/images/1/bufferView"},
    {"/textures/0/source", "9", "/textures/0/source"},
    {"/textures/0/sampler", "9", "/textures/0/sampler"},
    {"/textures/0/extensions/KHR_texture_basisu", R"({"source": 3})",
     "/textures/0/extensions/KHR_texture_basisu/source"},
    {"/samplers/0/wrapS", "1", "/samplers/0/wrapS"},
    {"/samplers/0/minFilter", "1", "/samplers/0/minFilter"},
    {"/materials/0/pbrMetallicRoughness/baseColorTexture/index", "1",
     "/materials/0/pbrMetallicRoughness/baseColorTexture/index"},
    {"/materials/0/pbrMetallicRoughness/baseColorTexture/texCoord", "-1",
     "/materials/0/pbrMetallicRoughness/baseColorTexture/texCoord"},
    {"/materials/0/pbrMetallicRoughness/baseColorFactor", "[1, 1, 1]",
     "/materials/0/pbrMetallicRoughness/baseColorFactor"},
    {"/materials/0/alphaMode", "\"GLASS\"", "/materials/0/alphaMode"},
    {"/materials/0/extensions", R"({"KHR_materials_sheen": {"sheenColorTexture": {"index": 2}}})",
     "/materials/0/extensions/KHR_materials_sheen/sheenColorTexture/index"},
    {"/materials/0/extensions", "[]", "/materials/0/extensions"},
    // extension lists
    {"/extensionsUsed", "[1]", "/extensionsUsed/0"},
    {"/extensionsRequired", "\"x\"", "/extensionsRequired"},
    {"/extensionsRequired", R"(["KHR_mesh_primitive_restart"])", "/extensionsRequired/0",
     ErrorKind::unsupported},
};

TEST(GltfHostile, EveryDamageIsNamedByItsPlace) {
  for (const Damage& damage : kDamages) {
    GltfBuilder builder = sound_model();
    const Json::json_pointer pointer(damage.pointer);
    if (*damage.value == '\0') {
      builder.json[pointer.parent_pointer()].erase(pointer.back());
    } else {
      builder.json[pointer] = Json::parse(damage.value);
    }
    const std::string what = std::string(damage.pointer) + " = " + damage.value;
    try {
      read(builder.glb());
      EXPECT_EQ(damage.kind, ErrorKind::internal) << what << " was read";
    } catch (const Error& e) {
      EXPECT_STREQ(to_string(e.kind()), to_string(damage.kind)) << what;
      EXPECT_EQ(e.place(), damage.place[0] == '\0' ? kPlace : kPlace + std::string(": ") + damage.place)
          << what << ": " << e.message();
      EXPECT_EQ(e.message().find('\n'), std::string::npos) << what;
    }
  }
}

TEST(GltfHostile, AnyValueAnywhereIsReadOrRefusedInOrder) {
  // Every member of the sound model in turn becomes each of these.
  const Json values[] = {
      nullptr, true, -1, 1e18, 65536, 0, "x", Json::array(), Json::object(), Json::array({0, 0})};
  const Json flat = sound_model().json.flatten();
  std::size_t refused = 0, total = 0;
  for (const auto& entry : flat.items()) {
    for (Json::json_pointer at(entry.key()); !at.empty(); at = at.parent_pointer()) {
      for (const Json& value : values) {
        GltfBuilder builder = sound_model();
        builder.json[at] = value;
        ++total;
        try {
          const Model model = read(builder.glb());
          for (const Mesh& mesh : model.meshes) check(mesh.surface);
        } catch (const Error& e) {
          ++refused;
          EXPECT_NE(e.kind(), ErrorKind::internal) << at << " = " << value << ": " << e.what();
          EXPECT_EQ(e.place().rfind(kPlace, 0), 0u) << at << " = " << value << ": " << e.what();
        }
      }
    }
  }
  // Most of these values are wrong in most places; far fewer refusals would mean that checks are gone.
  EXPECT_GT(refused, total / 2);
}

TEST(GltfHostile, TruncatedAnywhere) {
  const auto bytes = sound_model().glb();
  for (std::size_t length = 0; length < bytes.size(); length += 8) {
    const std::vector<std::byte> cut(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(length));
    try {
      read(cut);
      ADD_FAILURE() << length << " bytes were read";
    } catch (const Error& e) {
      EXPECT_EQ(e.kind(), ErrorKind::format) << length;
      EXPECT_NE(e.place().find(" byte "), std::string::npos) << e.what();
    }
  }
}

TEST(GltfHostile, TruncatedJson) {
  const auto bytes = sound_model().gltf();
  for (std::size_t length = 0; length < bytes.size(); length += 64) {
    const std::vector<std::byte> cut(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(length));
    EXPECT_THROW(read(cut), Error) << length;
  }
}

TEST(GltfHostile, PositionsAndIndicesAreNamedByNumber) {
  GltfBuilder builder = GltfBuilder::triangle();
  builder.binary[16 + 3] = std::byte{0x7F};  // y of vertex 1 becomes infinite
  builder.binary[16 + 2] = std::byte{0x80};
  try {
    read(builder.glb());
    FAIL();
  } catch (const Error& e) {
    EXPECT_EQ(e.place(), "bad.glb: /meshes/0/primitives/0/attributes/POSITION");
    EXPECT_NE(e.message().find("vertex 1"), std::string::npos) << e.message();
  }
  builder = GltfBuilder::triangle();
  builder.binary[36 + 4] = std::byte{3};  // third index
  try {
    read(builder.glb());
    FAIL();
  } catch (const Error& e) {
    EXPECT_EQ(e.place(), "bad.glb: /meshes/0/primitives/0/indices");
    EXPECT_EQ(e.message(), "index 2 is 3 but there are 3 vertices");
  }
}

/// Ways of a small file to ask for more than a million bytes.
const std::function<void(GltfBuilder&)> kTricks[] = {
    // zeros without a buffer view
    [](GltfBuilder& b) {
      b.json["accessors"][0] = {{"componentType", 5126}, {"type", "VEC3"}, {"count", 100'000'000}};
    },
    // many primitives over one array
    [](GltfBuilder& b) {
      b.json["accessors"][0] = {{"componentType", 5126}, {"type", "VEC3"}, {"count", 1000}};
      const Json primitive = b.json["meshes"][0]["primitives"][0];
      for (int i = 0; i < 500; ++i) b.json["meshes"][0]["primitives"].push_back(primitive);
    },
    // many layers that share nothing
    [](GltfBuilder& b) {
      const Json primitive = b.json["meshes"][0]["primitives"][0];
      for (int i = 0; i < 300; ++i) {
        Json other = primitive;
        other["attributes"]["_A" + std::to_string(i)] = 0;
        b.json["meshes"][0]["primitives"].push_back(other);
      }
    },
    // many samplers over one array
    [](GltfBuilder& b) {
      b.json["accessors"].push_back({{"componentType", 5126}, {"type", "SCALAR"}, {"count", 10'000}});
      Json sampler = {{"input", 2}, {"output", 2}};
      for (int i = 0; i < 100; ++i) b.json["animations"][0]["samplers"].push_back(sampler);
      b.json["animations"][0]["channels"] = Json::array();
    },
    // many instances
    [](GltfBuilder& b) {
      b.json["accessors"].push_back({{"componentType", 5126}, {"type", "VEC3"}, {"count", 20'000}});
      b.json["nodes"][0]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"]["TRANSLATION"] = 2;
    },
    // many nodes of two bytes each
    [](GltfBuilder& b) {
      for (int i = 0; i < 3000; ++i) b.json["nodes"].push_back(Json::object());
    },
    // many attributes
    [](GltfBuilder& b) {
      for (int i = 0; i < 100; ++i)
        b.json["meshes"][0]["primitives"][0]["attributes"]["_A" + std::to_string(i)] = 0;
    },
    // many images of one view
    [](GltfBuilder& b) {
      const int view = b.add_view(std::vector<std::byte>(20'000));
      for (int i = 0; i < 100; ++i)
        b.json["images"].push_back({{"bufferView", view}, {"mimeType", "image/png"}});
    }};

TEST(GltfHostile, SmallFilesCannotAskForMuchMemory) {
  ReadOptions few_bytes, few_times;
  few_bytes.max_total_bytes = 1'000'000;
  few_times.max_expansion = 1;  // of 1 MiB, which smaller files count as
  for (const ReadOptions& options : {few_bytes, few_times}) {
    int number = 0;
    for (const auto& trick : kTricks) {
      GltfBuilder builder = GltfBuilder::triangle();
      trick(builder);
      try {
        read(builder.glb(), options);
        ADD_FAILURE() << "trick " << number << " worked";
      } catch (const Error& e) {
        EXPECT_EQ(e.kind(), ErrorKind::limit) << number << ": " << e.what();
      }
      ++number;
    }
  }
}

/// A triangle with an animation of `count` times and values of 4 bytes each, none of them in the file.
GltfBuilder zeros(std::size_t count) {
  GltfBuilder b = GltfBuilder::triangle();
  b.json["accessors"].push_back({{"componentType", 5126}, {"type", "SCALAR"}, {"count", count}});
  b.json["animations"] = {{{"samplers", {{{"input", 2}, {"output", 2}}}}, {"channels", Json::array()}}};
  return b;
}

TEST(GltfHostile, WithoutOptionsASmallFileExpandsTo512MiB) {
  EXPECT_NO_THROW(read(zeros(1'000'000).glb()));
  for (const std::size_t count : {68'000'000, 400'000'000}) {
    try {
      read(zeros(count).glb());
      ADD_FAILURE() << count << " zeros were read";
    } catch (const Error& e) {
      EXPECT_EQ(e.kind(), ErrorKind::limit) << e.what();
      EXPECT_NE(e.hint().find("max-expansion"), std::string::npos) << e.hint();
    }
  }
}

TEST(GltfHostile, ALargerFileMayExpandToMore) {
  ReadOptions options;
  options.max_expansion = 1;
  GltfBuilder builder = zeros(150'000);
  EXPECT_THROW(read(builder.glb(), options), Error);
  builder.add_view(std::vector<std::byte>(2'000'000));
  EXPECT_NO_THROW(read(builder.glb(), options));
}

TEST(GltfHostile, ElementLimitIsAnOption) {
  ReadOptions options;
  options.max_elements = 2;
  try {
    read(GltfBuilder::triangle().glb(), options);
    FAIL();
  } catch (const Error& e) {
    EXPECT_EQ(e.kind(), ErrorKind::limit);
    EXPECT_EQ(e.place(), "bad.glb: /accessors/0/count");
  }
}

/// A folder of its own that goes away with the test.
class GltfFolder : public ::testing::Test {
 protected:
  void SetUp() override {
    const std::string name = ::testing::UnitTest::GetInstance()->current_test_info()->name();
    root_ =
        std::filesystem::temp_directory_path() / ("fovea-gltf-" + name + "-" + std::to_string(::getpid()));
    std::filesystem::create_directories(root_ / "model");
  }
  void TearDown() override { std::filesystem::remove_all(root_); }

  void write(const std::filesystem::path& name, std::span<const std::byte> bytes) {
    std::ofstream(root_ / name, std::ios::binary)
        .write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
  }
  /// Reads a triangle whose buffer has this URI.
  Model read_with_uri(const std::string& uri, const ReadOptions& options = {}) {
    GltfBuilder builder = GltfBuilder::triangle();
    builder.json["buffers"][0]["uri"] = uri;
    return read(test::to_bytes(builder.json.dump()), options, root_ / "model");
  }

  std::filesystem::path root_;
  std::vector<std::byte> data_ = GltfBuilder::triangle().binary;
};

TEST_F(GltfFolder, ExternalBuffersAndImages) {
  write("model/ä ❤.bin", data_);
  EXPECT_EQ(read_with_uri("ä ❤.bin").meshes[0].surface.face_count(), 1u);
  EXPECT_EQ(read_with_uri("%C3%A4%20%E2%9D%A4.bin").meshes[0].surface.face_count(), 1u);

  write("model/pic.png", test::from_hex("89504e470d0a1a0a"));
  GltfBuilder builder;
  builder.json["images"] = Json::array({{{"uri", "x/../pic.png"}, {"name", "p"}}});
  std::filesystem::create_directories(root_ / "model/x");
  const Model model = read(test::to_bytes(builder.json.dump()), {}, root_ / "model");
  EXPECT_EQ(model.images.at(0).uri, "pic.png");
  EXPECT_EQ(model.images[0].bytes.size(), 8u);
}

TEST_F(GltfFolder, FilesBesideTheModelAllowForTheirOwnBytes) {
  ReadOptions options;
  options.max_expansion = 2;
  std::vector<std::byte> large = data_;
  large.resize(3'000'000);
  write("model/large.bin", large);
  EXPECT_NO_THROW(read_with_uri("large.bin", options));
  // One file under two names, read twice, counts once.
  GltfBuilder builder = GltfBuilder::triangle();
  builder.json["buffers"][0]["uri"] = "large.bin";
  builder.json["images"] = Json::array({{{"uri", "large.bin"}}, {{"uri", "./large.bin"}}});
  EXPECT_THROW(read(test::to_bytes(builder.json.dump()), options, root_ / "model"), Error);
}

TEST_F(GltfFolder, NothingOutsideOfTheFolderIsRead) {
  write("secret.bin", data_);
  write("model/inside.bin", data_);
  std::filesystem::create_symlink(root_ / "secret.bin", root_ / "model/link.bin");
  std::filesystem::create_symlink(root_, root_ / "model/up");
  std::filesystem::create_symlink("inside.bin", root_ / "model/good-link.bin");
  EXPECT_NO_THROW(read_with_uri("inside.bin"));
  EXPECT_NO_THROW(read_with_uri("good-link.bin"));
  for (const char* uri :
       {"../secret.bin", "link.bin", "up/secret.bin", "inside.bin/../../secret.bin", "%2e%2e/secret.bin"}) {
    EXPECT_THROW(read_with_uri(uri), Error) << uri;
  }
  EXPECT_THROW(read_with_uri((root_ / "secret.bin").string()), Error);
  EXPECT_THROW(read_with_uri("file://" + (root_ / "model/inside.bin").string()), Error);
}

TEST_F(GltfFolder, FoldersAndHugeFilesAreRefused) {
  std::filesystem::create_directories(root_ / "model/folder.bin");
  EXPECT_THROW(read_with_uri("folder.bin"), Error);
  write("model/data.bin", data_);
  ReadOptions options;
  options.max_file_bytes = 10;
  try {
    read_with_uri("data.bin", options);
    FAIL();
  } catch (const Error& e) {
    EXPECT_EQ(e.kind(), ErrorKind::limit);
  }
}

}  // namespace
}  // namespace fovea
