#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "fovea/io/field_file.h"
#include "fovea/io/image_codec.h"
#include "fovea/io/read.h"
#include "fovea/io/write.h"
#include "run_command.h"
#include "support/meshes.h"

namespace fovea::test {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

class SegmentVerb : public ::testing::Test {
 protected:
  std::string out(const std::string& name) const { return folder_ / name; }
  static Outcome segment(std::vector<std::string> words) {
    words.insert(words.begin(), "segment");
    return fovea(words);
  }
  static Model model(const std::string& path) {
    Context context;
    return read_model(path, {}, context);
  }
  static std::size_t triangles(const std::string& path) { return counts(model(path)).triangles; }

  Folder folder_;
  std::string grid_ = write_grid(folder_, "grid.glb", 12);
};

/// The colours, or other values of a layer, that the corners of each triangle have.
std::vector<std::set<std::vector<float>>> values_of_triangles(const TriMesh& mesh,
                                                              const AttributeLayer& layer) {
  std::vector<std::set<std::vector<float>>> values(mesh.face_count());
  for (std::size_t c = 0; c < layer.corner_value.size(); ++c) {
    const float* x = layer.value(layer.corner_value[c]);
    values[c / 3].insert(std::vector<float>(x, x + layer.width));
  }
  return values;
}

const AttributeLayer& cluster_layer(const TriMesh& mesh) {
  const auto at = std::find_if(mesh.layers.begin(), mesh.layers.end(),
                               [](const AttributeLayer& layer) { return layer.name == "_CLUSTER"; });
  EXPECT_NE(at, mesh.layers.end());
  return *at;
}

TEST_F(SegmentVerb, WritesClustersInColours) {
  const Outcome outcome = segment({grid_, "-o", out("clusters.glb"), "--clusters", "7", "--json"});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const nlohmann::json json = outcome.json();
  ASSERT_TRUE(json.is_object()) << outcome.out;
  EXPECT_EQ(json["verb"], "segment");
  EXPECT_EQ(json["inputs"][0]["path"], grid_);
  EXPECT_EQ(json["outputs"][0]["format"], "glb");
  EXPECT_EQ(json["outputs"][0]["bytes"], std::filesystem::file_size(out("clusters.glb")));
  EXPECT_EQ(json["poses"], nlohmann::json::array({"rest"}));
  EXPECT_GE(json["rounds"], 1);
  EXPECT_THAT(json["end"].get<std::string>(), ::testing::AnyOf("converged", "cycle", "rounds"));
  ASSERT_EQ(json["clusters"].size(), 7u);
  std::uint64_t sum = 0;
  for (const nlohmann::json& cluster : json["clusters"]) sum += cluster["triangles"].get<std::uint64_t>();
  EXPECT_EQ(sum, triangles(grid_));

  for (const char* name : {"clusters.glb", "clusters.gltf", "clusters.ply"}) {
    ASSERT_EQ(segment({grid_, "-o", out(name), "--clusters", "7", "--force"}).code, 0) << name;
    const Model made = model(out(name));
    EXPECT_TRUE(made.images.empty());
    const TriMesh& mesh = made.meshes[0].surface;
    std::set<std::vector<float>> ids;
    for (const auto& values : values_of_triangles(mesh, cluster_layer(mesh))) {
      ASSERT_EQ(values.size(), 1u) << "borders are crisp";
      ids.insert(values.begin(), values.end());
    }
    EXPECT_EQ(ids.size(), 7u);
    for (const auto& values : values_of_triangles(mesh, *mesh.find(Semantic::color)))
      EXPECT_EQ(values.size(), 1u);
  }
}

TEST_F(SegmentVerb, KeysOfItsReportAreOnThePage) {
  const std::string page = read_text(FOVEA_COMMAND_PAGE);
  const nlohmann::json json = segment({grid_, "-o", out("clusters.glb"), "--json"}).json();
  const auto expect_there = [&](const nlohmann::json& object) {
    for (const auto& [key, value] : object.items()) EXPECT_THAT(page, HasSubstr("`" + key + "`"));
  };
  expect_there(json);
  expect_there(json["clusters"][0]);
}

TEST_F(SegmentVerb, TheExtensionSaysWhatIsWritten) {
  for (const char* name : {"ids.npy", "ids.csv", "ids.txt"}) {
    ASSERT_EQ(segment({grid_, "-o", out(name), "--clusters", "5"}).code, 0) << name;
    const std::vector<float> ids = read_field(out(name));
    EXPECT_EQ(ids.size(), triangles(grid_));
    EXPECT_EQ(std::set<float>(ids.begin(), ids.end()), (std::set<float>{0, 1, 2, 3, 4}));
  }
  EXPECT_THAT(read_text(out("ids.csv")), ::testing::StartsWith("cluster\n"));

  ASSERT_EQ(segment({grid_, "-o", out("sheet.png"), "--view-size", "32", "--columns", "3"}).code, 0);
  const std::string bytes = read_text(out("sheet.png"));
  const Image8 sheet = decode_image({reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()});
  EXPECT_EQ(sheet.width, 96);
  EXPECT_EQ(sheet.height, 64);

  ASSERT_EQ(segment({grid_, "-o", out("p.json"), "--clusters", "5"}).code, 0);
  const nlohmann::json written = nlohmann::json::parse(read_text(out("p.json")));
  const nlohmann::json told =
      segment({grid_, "-o", out("p.json"), "--clusters", "5", "--force", "--json"}).json();
  EXPECT_EQ(written["clusters"], told["clusters"]);
}

TEST_F(SegmentVerb, TheAttributeLeavesTheModelAsItIs) {
  ASSERT_EQ(segment({grid_, "-o", out("marked.glb"), "--as", "attribute", "--method", "kmeans"}).code, 0);
  const Model before = model(grid_), marked = model(out("marked.glb"));
  EXPECT_EQ(marked.images[0].bytes, before.images[0].bytes);
  EXPECT_TRUE(marked.materials[0].base_color.has_value());
  EXPECT_NE(marked.meshes[0].surface.find(Semantic::uv), nullptr);
  const TriMesh& mesh = marked.meshes[0].surface;
  for (const auto& values : values_of_triangles(mesh, cluster_layer(mesh))) EXPECT_EQ(values.size(), 1u);
}

TEST_F(SegmentVerb, SaliencyWithinClustersIsImportanceForSimplify) {
  ASSERT_EQ(segment({grid_, "-o", out("local.npy"), "--as", "local"}).code, 0);
  const std::vector<float> local = read_field(out("local.npy"));
  EXPECT_EQ(local.size(), model(grid_).meshes[0].surface.source_vertex.size());
  EXPECT_GT(*std::max_element(local.begin(), local.end()), 1) << "a cluster's peak is 1 above its mean";
  const Outcome outcome =
      fovea({"simplify", grid_, "-o", out("small.glb"), "--ratio", "0.5", "--importance", out("local.npy")});
  EXPECT_EQ(outcome.code, 0) << outcome.err;
}

TEST_F(SegmentVerb, EveryMethodGivesTheSameForASeed) {
  for (const char* method : {"salient", "propagative", "kmeans"}) {
    const auto ids = [&](const char* seed, const char* threads) {
      EXPECT_EQ(segment({grid_, "-o", out("ids.npy"), "--method", method, "--seed", seed, "--threads",
                         threads, "--force"})
                    .code,
                0);
      return read_field(out("ids.npy"));
    };
    EXPECT_EQ(ids("1", "1"), ids("1", "2")) << method;
    EXPECT_NE(ids("1", "1"), ids("2", "1")) << method;
  }
}

TEST_F(SegmentVerb, SeveralMeshesAreOneSceneAndUnseenOnesHaveNone) {
  Model two = model_of({grid(4, 4), cube(), tetrahedron()});
  two.nodes[1].translation = {0.5, 0.5, 1.2};
  two.scenes[0].nodes.pop_back();
  Context context;
  write_model(two, out("two.glb"), {}, context);
  ASSERT_EQ(segment({out("two.glb"), "-o", out("ids.txt"), "--clusters", "3"}).code, 0);
  const std::vector<float> ids = read_field(out("ids.txt"));
  ASSERT_EQ(ids.size(), 32u + 12 + 4);
  EXPECT_EQ(std::set<float>(ids.begin(), ids.begin() + 44), (std::set<float>{0, 1, 2}));
  EXPECT_EQ(std::set<float>(ids.begin() + 44, ids.end()), std::set<float>{-1});
  EXPECT_EQ(segment({out("two.glb"), "-o", out("colors.glb")}).code, 0);
}

TEST_F(SegmentVerb, MoreClustersThanTrianglesAreAsManyAsTriangles) {
  const std::string square = folder_.write("square.obj", square_obj());
  const Outcome outcome = segment({square, "-o", out("c.ply"), "--clusters", "100", "--json"});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_EQ(outcome.json()["clusters"].size(), 2u);
}

TEST_F(SegmentVerb, LooksAtThePosesOfAnAnimation) {
  ASSERT_EQ(fovea({"sample", "arm", "-o", out("arm.glb"), "--detail", "0.03"}).code, 0);
  const Outcome all = segment({out("arm.glb"), "-o", out("a.glb"), "--json"});
  ASSERT_EQ(all.code, 0) << all.err;
  EXPECT_GT(all.json()["poses"].size(), 1u);
  EXPECT_EQ(model(out("a.glb")).animations.size(), 1u) << "it still moves";
  const Outcome moment =
      segment({out("arm.glb"), "-o", out("b.glb"), "--animation", "0", "--time", "0.5", "--json"});
  ASSERT_EQ(moment.code, 0) << moment.err;
  EXPECT_EQ(moment.json()["poses"], nlohmann::json::array({"animation 0 at 0.50 s"}));
  EXPECT_EQ(moment.json()["options"]["key-poses"], 1);
  const Outcome both = segment({out("arm.glb"), "-o", out("c.glb"), "--animation", "0", "--key-poses", "4"});
  EXPECT_EQ(both.code, 2);
  EXPECT_THAT(both.err, HasSubstr("leave out --animation, or --key-poses"));
}

TEST_F(SegmentVerb, FilesArePosesOfOneModel) {
  const std::string flat = folder_.write("a.obj", square_obj()),
                    bent = folder_.write("b.obj", "v 0 0 0\nv 1 0 0\nv 1 1 1\nv 0 1 0\nf 1 2 3\nf 1 3 4\n");
  const Outcome outcome = segment({flat, bent, "-o", out("c.ply"), "--clusters", "2", "--json"});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_EQ(outcome.json()["poses"], nlohmann::json::array({"file 1", "file 2"}));
  EXPECT_EQ(outcome.json()["inputs"].size(), 2u);
  EXPECT_EQ(segment({flat, grid_, "-o", out("d.ply")}).code, 5);
}

TEST_F(SegmentVerb, WhatIsWrongIsSaidBeforeTheWork) {
  const auto error = [&](std::vector<std::string> words, int code, const char* message) {
    const Outcome outcome = segment(std::move(words));
    EXPECT_EQ(outcome.code, code) << outcome.err;
    EXPECT_THAT(outcome.err, HasSubstr(message));
  };
  error({grid_}, 2, "clusters.glb");
  error({grid_, "-o", out("x.glb"), "--clusters", "0"}, 2, "--clusters");
  error({grid_, "-o", out("x.glb"), "--clusters", "many"}, 2, "--clusters");
  error({grid_, "-o", out("x.glb"), "--method", "kmean"}, 2, "did you mean kmeans?");
  error({grid_, "-o", out("x.abc")}, 2, "x.abc");
  error({grid_, "-o", out("x.obj")}, 2, "OBJ files have no place for vertex attributes");
  error({grid_, "-o", out("x.glb"), "--as", "ids"}, 2, ".npy");
  error({grid_, "-o", out("x.npy"), "--as", "properties"}, 2, ".json");
  error({grid_, "-o", out("x.npy"), "--view-size", "64"}, 2, "--view-size needs a picture as output");
  error({grid_, "-o", grid_}, 2, "--force");
  error({out("none.glb"), "-o", out("x.glb")}, 3, "no such file");
  error({grid_, "-o", out("none/x.glb")}, 7, "none");
  EXPECT_THAT(folder_.names(), ElementsAre("grid.glb"));
}

TEST_F(SegmentVerb, AModelWithoutTrianglesIsRefused) {
  Context context;
  write_model(Model{}, out("empty.glb"), {}, context);
  EXPECT_EQ(segment({out("empty.glb"), "-o", out("x.glb")}).code, 5);
}

}  // namespace
}  // namespace fovea::test
