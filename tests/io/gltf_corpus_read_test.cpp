#include <gtest/gtest.h>

#include <filesystem>
#include <map>
#include <set>

#include "fovea/base/error.h"
#include "fovea/io/gltf_read.h"
#include "support/reading.h"

namespace fovea {
namespace {

namespace fs = std::filesystem;

/// What must be refused, and where it must say so.
const std::map<std::string, std::string> kMalformed = {
    {"bufferview-past-end.glb", "bufferview-past-end.glb: /bufferViews/0"},
    {"index-out-of-range.glb", "index-out-of-range.glb: /meshes/0/primitives/0/indices"},
    {"truncated.glb", "truncated.glb: byte 8"}};

class GltfCorpus : public ::testing::Test {
 protected:
  void SetUp() override {
    const auto folder = test::corpus_folder();
    if (!folder) GTEST_SKIP() << "FOVEA_DATA does not name the corpus";
    folder_ = *folder;
  }

  Model read(const fs::path& path, Context& context) const {
    const auto bytes = read_file(path, std::int64_t{1} << 30);
    return read_gltf(bytes, path.parent_path(), path.filename().string(), {}, context);
  }
  Model read(const char* name) const {
    Context context;
    return read(folder_ / name, context);
  }
  std::set<fs::path> files() const {
    std::set<fs::path> result;
    for (const char* part : {"textured", "animated", "conformance"}) {
      for (const auto& entry : fs::recursive_directory_iterator(folder_ / part)) {
        const auto extension = entry.path().extension();
        if (extension == ".glb" || extension == ".gltf") result.insert(entry.path());
      }
    }
    return result;
  }

  fs::path folder_;
};

TEST_F(GltfCorpus, EverythingSoundIsReadAndEverythingMalformedIsRefused) {
  for (const fs::path& path : files()) {
    Context context;
    const auto malformed = kMalformed.find(path.filename().string());
    try {
      const Model model = read(path, context);
      EXPECT_EQ(malformed, kMalformed.end()) << path;
      for (const Mesh& mesh : model.meshes) EXPECT_NO_THROW(check(mesh.surface)) << path;
      for (const Diagnostic& d : context.diagnostics()) EXPECT_EQ(d.code, "degenerate-triangles") << path;
    } catch (const Error& e) {
      ASSERT_NE(malformed, kMalformed.end()) << e.what();
      EXPECT_EQ(e.place(), malformed->second);
    }
  }
}

TEST_F(GltfCorpus, CompressedDucksHaveTheTrianglesOfThePlainOne) {
  const TriMesh plain = read("textured/Duck.glb").meshes[0].surface;
  for (const char* name : {"conformance/Duck-Draco/Duck.gltf", "conformance/Duck-meshopt.glb",
                           "conformance/Duck-Quantized/Duck.gltf"}) {
    const Model model = read(name);
    const TriMesh& mesh = model.meshes[0].surface;
    EXPECT_EQ(mesh.face_count(), plain.face_count()) << name;
    EXPECT_EQ(mesh.vertex_count(), plain.vertex_count()) << name;
    EXPECT_EQ(mesh.layers.size(), plain.layers.size()) << name;
    // The coarsest of the three stores 11 bits (Draco): half a step of 2^-11 per axis, of the diagonal.
    const Box a = bounds(model), b = bounds(read("textured/Duck.glb"));
    EXPECT_LT(length(a.low - b.low), 1e-3 * b.diagonal()) << name;
    EXPECT_LT(length(a.high - b.high), 1e-3 * b.diagonal()) << name;
    for (const std::string& extension : model.extensions_used) {
      EXPECT_EQ(extension.find("compression"), std::string::npos) << name;
    }
  }
}

TEST_F(GltfCorpus, AllPrimitiveModes) {
  const Model model = read("conformance/MeshPrimitiveModes.gltf");
  std::map<int, int> raw;
  std::size_t faces = 0;
  for (const Mesh& mesh : model.meshes) {
    faces += mesh.surface.face_count();
    for (const Part& part : mesh.surface.parts) {
      if (part.raw) ++raw[part.raw->mode];
    }
  }
  EXPECT_EQ(faces, 16u);
  EXPECT_EQ(raw.size(), 4u);
}

TEST_F(GltfCorpus, InstancesAndSkins) {
  const Model instanced = read("conformance/SimpleInstancing.glb");
  std::size_t instances = 0;
  for (const Node& node : instanced.nodes) instances += node.instances.size();
  EXPECT_EQ(instances, 125u);
  EXPECT_EQ(instanced.carried_accessors.size(), 3u);
  const Model knight = read("animated/KayKitKnight.glb");
  EXPECT_EQ(knight.animations.size(), 76u);
  EXPECT_EQ(knight.skins.at(0).joints.size(), 41u);
}

}  // namespace
}  // namespace fovea
