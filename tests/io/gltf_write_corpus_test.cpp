#include <gtest/gtest.h>

#include <filesystem>
#include <set>

#include "fovea/base/error.h"
#include "fovea/io/read.h"
#include "io/gltf_written.h"
#include "support/corner_soup.h"
#include "support/reading.h"

namespace fovea {
namespace {

namespace fs = std::filesystem;
using test::Written;

/// Files whose values break the rules of glTF, so that writing repairs them: the soup differs.
const std::set<std::string> kRepaired = {};

class GltfWriteCorpus : public ::testing::Test {
 protected:
  void SetUp() override {
    const auto folder = test::corpus_folder();
    if (!folder) GTEST_SKIP() << "FOVEA_DATA does not name the corpus";
    for (const char* part : {"textured", "animated", "conformance"}) {
      for (const auto& entry : fs::recursive_directory_iterator(*folder / part)) {
        const auto extension = entry.path().extension();
        if (extension == ".glb" || extension == ".gltf") load(entry.path());
      }
    }
    ASSERT_GT(models_.size(), 50u);
  }

  void load(const fs::path& path) {
    Context quiet;
    try {
      const auto bytes = read_file(path, std::int64_t{1} << 30);
      models_.emplace_back(path.filename().string(),
                           read_gltf(bytes, path.parent_path(), path.filename().string(), {}, quiet));
    } catch (const Error&) {
      // The reader's tests know which files must be refused.
    }
  }

  std::vector<std::pair<std::string, Model>> models_;
};

/// Meshes of which nothing is left are not written.
std::vector<const Mesh*> written_meshes(const Model& model) {
  std::vector<const Mesh*> result;
  for (const Mesh& mesh : model.meshes) {
    bool any = mesh.surface.face_count() > 0;
    for (const Part& part : mesh.surface.parts) any = any || part.raw.has_value();
    if (any) result.push_back(&mesh);
  }
  return result;
}

void expect_same_but_for_meshes(const Model& a, const Model& b, const std::string& name) {
  ASSERT_EQ(a.nodes.size(), b.nodes.size()) << name;
  EXPECT_EQ(world_transforms(a), world_transforms(b)) << name;
  for (std::size_t n = 0; n < a.nodes.size(); ++n) {
    EXPECT_EQ(a.nodes[n].json, b.nodes[n].json) << name;
    EXPECT_EQ(a.nodes[n].instances, b.nodes[n].instances) << name;
  }
  ASSERT_EQ(a.materials.size(), b.materials.size()) << name;
  for (std::size_t m = 0; m < a.materials.size(); ++m)
    EXPECT_EQ(a.materials[m].json, b.materials[m].json) << name;
  ASSERT_EQ(a.images.size(), b.images.size()) << name;
  for (std::size_t i = 0; i < a.images.size(); ++i) EXPECT_EQ(a.images[i].bytes, b.images[i].bytes) << name;
  ASSERT_EQ(a.textures.size(), b.textures.size()) << name;
  for (std::size_t t = 0; t < a.textures.size(); ++t)
    EXPECT_EQ(a.textures[t].json, b.textures[t].json) << name;
  ASSERT_EQ(a.skins.size(), b.skins.size()) << name;
  for (std::size_t s = 0; s < a.skins.size(); ++s)
    EXPECT_EQ(a.skins[s].inverse_bind, b.skins[s].inverse_bind) << name;
  ASSERT_EQ(a.animations.size(), b.animations.size()) << name;
  for (std::size_t i = 0; i < a.animations.size(); ++i) {
    ASSERT_EQ(a.animations[i].samplers.size(), b.animations[i].samplers.size()) << name;
    for (std::size_t s = 0; s < a.animations[i].samplers.size(); ++s) {
      EXPECT_EQ(a.animations[i].samplers[s].input, b.animations[i].samplers[s].input) << name;
      EXPECT_EQ(a.animations[i].samplers[s].output, b.animations[i].samplers[s].output) << name;
    }
  }
  EXPECT_EQ(a.extensions_used, b.extensions_used) << name;
  EXPECT_EQ(a.carried_accessors, b.carried_accessors) << name;
}

TEST_F(GltfWriteCorpus, ReadsBackTheSame) {
  for (const GeometryCompression compression : {GeometryCompression::none, GeometryCompression::meshopt}) {
    WriteOptions options;
    options.compression = compression;
    for (const auto& [name, model] : models_) {
      const Written written(model, options);
      const Model read = written.read();
      expect_same_but_for_meshes(model, read, name);
      const auto before = written_meshes(model), after = written_meshes(read);
      ASSERT_EQ(before.size(), after.size()) << name;
      if (kRepaired.contains(name)) continue;
      for (std::size_t m = 0; m < before.size(); ++m) {
        EXPECT_TRUE(test::corner_soup(before[m]->surface) == test::corner_soup(after[m]->surface))
            << name << " mesh " << m;
      }
    }
  }
}

TEST_F(GltfWriteCorpus, QuantizedFilesReadAndTakeLess) {
  WriteOptions options;
  options.quantize = true;
  for (const auto& [name, model] : models_) {
    const Written plain(model), written(model, options);
    const Model read = written.read();
    EXPECT_LE(written.counts.geometry, plain.counts.geometry) << name;
    EXPECT_EQ(counts(read).triangles_drawn, counts(Written(read).read()).triangles_drawn) << name;
    const Box before = bounds(model), after = bounds(read);
    if (before.empty()) continue;
    // A grid of 14 bits moves each corner of the box by half a step of the largest mesh at most; instances of
    // a mesh may be scaled beyond the scene, hence a full step and the diagonal.
    const double step = before.diagonal() / (std::ldexp(1.0, 14) - 1);
    EXPECT_LE(length(before.low - after.low), step) << name;
    EXPECT_LE(length(before.high - after.high), step) << name;
  }
}

}  // namespace
}  // namespace fovea
