#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "fovea/io/read.h"
#include "run_command.h"

namespace fovea::test {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;

/// A folder with a model in it, and room for outputs.
class Verbs : public ::testing::Test {
 protected:
  std::string out(const std::string& name) const { return folder_ / name; }

  Folder folder_;
  std::string grid_ = write_grid(folder_, "grid.glb");
};

TEST_F(Verbs, SampleMakesAModel) {
  const std::string vase = out("vase.glb");
  const Outcome outcome = fovea({"sample", "vase", "-o", vase, "--detail", "0.1", "--json"});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const nlohmann::json json = outcome.json();
  EXPECT_EQ(json["outputs"][0]["path"], vase);
  EXPECT_EQ(json["outputs"][0]["format"], "glb");
  EXPECT_EQ(json["outputs"][0]["bytes"], std::filesystem::file_size(vase));
  EXPECT_GT(json["after"]["triangles"], 1000);
  EXPECT_GT(json["after"]["bytes_by_kind"]["images"], 0);
}

// The whole way, as a new user goes it.
TEST_F(Verbs, SampleThenInfoThenSimplify) {
  const std::string arm = out("arm.glb"), small = out("small.glb");
  ASSERT_EQ(fovea({"sample", "arm", "-o", arm, "--detail", "0.1"}).code, 0);
  const nlohmann::json before = fovea({"info", arm, "--json"}).json();
  EXPECT_EQ(before["skins"].size(), 1u);
  EXPECT_EQ(before["meshes"][0]["skinned"], true);
  ASSERT_EQ(fovea({"simplify", arm, "-o", small, "--ratio", "0.25"}).code, 0);
  const nlohmann::json after = fovea({"info", small, "--json"}).json();
  EXPECT_LE(after["totals"]["triangles"].get<int>(), before["totals"]["triangles"].get<int>() / 4 + 1);
  EXPECT_EQ(after["animations"], before["animations"]);
  EXPECT_GT(before["animations"][0]["duration_s"], 0);
  EXPECT_EQ(after["images"], before["images"]);
}

TEST_F(Verbs, SampleListNamesWhatSampleMakes) {
  const Outcome list = fovea({"sample", "--list"});
  EXPECT_EQ(list.code, 0);
  for (const char* name : {"vase", "arm", "spheres", "terrain"}) EXPECT_THAT(list.out, HasSubstr(name));
  const nlohmann::json json = fovea({"sample", "--list", "--json"}).json();
  EXPECT_EQ(json["samples"][0]["name"], "vase");
}

TEST_F(Verbs, SampleSuggestsNames) {
  const Outcome outcome = fovea({"sample", "vaes", "-o", out("vaes.glb")});
  EXPECT_EQ(outcome.code, 2);
  EXPECT_THAT(outcome.err, HasSubstr("vase"));
}

TEST_F(Verbs, SampleWithoutANameOrWithoutOutput) {
  for (const std::vector<std::string>& words : {std::vector<std::string>{"sample"}, {"sample", ""}})
    EXPECT_THAT(fovea(words).err, HasSubstr("error: NAME is missing\nhint: fovea sample --list"));
  EXPECT_THAT(fovea({"sample", "arm"}).err, HasSubstr("for example -o arm.glb"));
  EXPECT_THAT(fovea({"sample", "--list", "-o", out("x.glb")}).err, HasSubstr("--output needs a NAME"));
}

TEST_F(Verbs, InfoJsonDescribesTheModel) {
  const Outcome outcome = fovea({"info", grid_, "--json"});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const nlohmann::json json = outcome.json();
  ASSERT_TRUE(json.is_object()) << outcome.out;
  EXPECT_EQ(json["schema_version"], 2);
  EXPECT_EQ(json["tool"]["version"], FOVEA_VERSION);
  EXPECT_EQ(json["inputs"][0]["path"], grid_);
  const nlohmann::json& mesh = json["meshes"][0];
  EXPECT_GT(mesh["triangles"], 0);
  EXPECT_GE(mesh["split_vertices"], mesh["vertices"]);
  EXPECT_GE(mesh["components"], 1);
  EXPECT_TRUE(mesh["edges"].contains("non_manifold"));
  EXPECT_FALSE(mesh["layers"].empty());
  EXPECT_GT(json["images"][0]["width"], 0);
  EXPECT_EQ(json["materials"][0]["textures"][0]["role"], "base color");
  EXPECT_GT(json["bounds"]["diagonal"], 0);
  EXPECT_TRUE(json["diagnostics"].is_array());
  EXPECT_GT(json["peak_memory_bytes"], 0);
}

TEST_F(Verbs, InfoBytesAddUpToTheFile) {
  const nlohmann::json bytes = fovea({"info", grid_, "--json"}).json()["totals"]["bytes_by_kind"];
  EXPECT_EQ(bytes["files"], std::filesystem::file_size(grid_));
  const auto sum = bytes["geometry"].get<std::uint64_t>() + bytes["images"].get<std::uint64_t>() +
                   bytes["animation"].get<std::uint64_t>() + bytes["other"].get<std::uint64_t>();
  EXPECT_EQ(sum, bytes["files"]);
}

TEST_F(Verbs, InfoTextNamesWhatIsInside) {
  const Outcome outcome = fovea({"info", grid_});
  EXPECT_EQ(outcome.code, 0);
  for (const char* word :
       {"triangles", "Meshes", "TEXCOORD_0", "Materials", "base color", "Images", "Bytes"}) {
    EXPECT_THAT(outcome.out, HasSubstr(word));
  }
}

TEST_F(Verbs, InfoQuietStillGivesTheData) {
  EXPECT_THAT(fovea({"info", grid_, "--quiet"}).out, HasSubstr("Meshes"));
}

TEST_F(Verbs, InfoMeasuresGltfWithFilesBeside) {
  // Three positions and three 16-bit indices, padded: 36 + 6 bytes of geometry in a buffer of 44.
  const Folder folder;
  folder.write("data.bin", std::string("\0\0\0\0\0\0\0\0\0\0\0\0"      // 0 0 0
                                       "\0\0\x80\x3f\0\0\0\0\0\0\0\0"  // 1 0 0
                                       "\0\0\0\0\0\0\x80\x3f\0\0\0\0"  // 0 1 0
                                       "\0\0\1\0\2\0\0\0",
                                       44));
  const std::string text = R"({"asset":{"version":"2.0","generator":"by hand"},
    "buffers":[{"uri":"data.bin","byteLength":44}],
    "bufferViews":[{"buffer":0,"byteLength":36},{"buffer":0,"byteOffset":36,"byteLength":6}],
    "accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3","min":[0,0,0],"max":[1,1,0]},
                 {"bufferView":1,"componentType":5123,"count":3,"type":"SCALAR"}],
    "meshes":[{"name":"one","primitives":[{"attributes":{"POSITION":0},"indices":1}]}],
    "nodes":[{"mesh":0},{"mesh":0,"translation":[2,0,0]}],"scenes":[{"nodes":[0,1]}],"scene":0})";
  const std::string path = folder.write("one.gltf", text);
  const Outcome outcome = fovea({"info", path, "--json"});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const nlohmann::json json = outcome.json();
  EXPECT_EQ(json["generator"], "by hand");
  EXPECT_EQ(json["totals"]["triangles"], 1);
  EXPECT_EQ(json["totals"]["triangles_drawn"], 2);
  EXPECT_EQ(json["totals"]["bytes_by_kind"]["files"], text.size() + 44);
  EXPECT_EQ(json["totals"]["bytes_by_kind"]["geometry"], 42);
  EXPECT_EQ(json["meshes"][0]["edges"]["boundary"], 3);
  EXPECT_EQ(json["meshes"][0]["shown"], 2);
}

TEST_F(Verbs, SimplifyReportsBeforeAndAfter) {
  const Outcome outcome = fovea({"simplify", grid_, "-o", out("tenth.glb"), "--ratio", "0.1", "--json"});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const nlohmann::json json = outcome.json();
  ASSERT_TRUE(json.is_object()) << outcome.out;
  EXPECT_EQ(json["options"]["ratio"], 0.1);
  EXPECT_TRUE(json["options"]["triangles"].is_null());
  EXPECT_LE(json["after"]["triangles"], json["result"]["triangles_target"]);
  EXPECT_LT(json["after"]["vertices"], json["before"]["vertices"]);
  EXPECT_LT(json["after"]["bytes_by_kind"]["geometry"], json["before"]["bytes_by_kind"]["geometry"]);
  EXPECT_EQ(json["after"]["bytes_by_kind"]["images"], json["before"]["bytes_by_kind"]["images"]);
  EXPECT_EQ(json["after"]["bytes_by_kind"]["files"], std::filesystem::file_size(out("tenth.glb")));
  EXPECT_EQ(json["result"]["stop"], "target");
  EXPECT_EQ(json["result"]["reached"], true);
  EXPECT_GT(json["result"]["error_rel"], 0);
  EXPECT_GT(json["result"]["error_abs"], json["result"]["error_rel"].get<double>() * 0.01);
  std::vector<std::string> phases;
  for (const nlohmann::json& phase : json["phases"]) phases.push_back(phase["name"]);
  EXPECT_THAT(phases, ::testing::ElementsAre("read", "simplify", "write"));
  EXPECT_EQ(json["exit_code"], 0);
}

TEST_F(Verbs, SimplifyCountsTheFilesBesideTheOutput) {
  for (const std::string extension : {"gltf", "obj", "ply"}) {
    const Folder folder;
    const std::string path = folder / ("small." + extension);
    const Outcome outcome = fovea({"simplify", grid_, "-o", path, "--ratio", "0.5", "--json"});
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    std::uint64_t sum = 0;
    for (const std::string& name : folder.names()) sum += std::filesystem::file_size(folder / name);
    const nlohmann::json json = outcome.json();
    EXPECT_EQ(json["outputs"][0]["format"], extension);
    EXPECT_EQ(json["after"]["bytes_by_kind"]["files"], sum) << extension;
    EXPECT_EQ(json["after"]["bytes_by_kind"]["images"], json["before"]["bytes_by_kind"]["images"])
        << extension;
  }
}

TEST_F(Verbs, SimplifyTellsItInText) {
  const Outcome outcome = fovea({"simplify", grid_, "-o", out("text.glb"), "--ratio", "0.5"});
  EXPECT_EQ(outcome.code, 0);
  for (const char* word :
       {"before", "after", "triangles", "geometry", "images", "error", "stopped", "time"}) {
    EXPECT_THAT(outcome.out, HasSubstr(word));
  }
}

TEST_F(Verbs, SimplifyQuietPrintsNothing) {
  const Outcome outcome = fovea({"simplify", grid_, "-o", out("quiet.glb"), "--ratio", "0.5", "--quiet"});
  EXPECT_EQ(outcome.code, 0);
  EXPECT_THAT(outcome.out, IsEmpty());
  EXPECT_THAT(outcome.err, IsEmpty());
  EXPECT_TRUE(std::filesystem::exists(out("quiet.glb")));
}

TEST_F(Verbs, SimplifyWritesTheSameBytesForAnyThreads) {
  EXPECT_EQ(
      fovea({"simplify", grid_, "-o", out("one.glb"), "--ratio", "0.3", "--threads", "1", "--quiet"}).code,
      0);
  EXPECT_EQ(
      fovea({"simplify", grid_, "-o", out("four.glb"), "--ratio", "0.3", "--threads", "4", "--quiet"}).code,
      0);
  EXPECT_TRUE(read_text(out("one.glb")) == read_text(out("four.glb")));
}

TEST_F(Verbs, SimplifyReplacesWithForce) {
  folder_.write("old.glb", "old");
  EXPECT_EQ(fovea({"simplify", grid_, "-o", out("old.glb"), "--ratio", "0.5", "--force", "--quiet"}).code, 0);
  EXPECT_EQ(read_text(out("old.glb")).substr(0, 4), "glTF");
}

TEST_F(Verbs, SimplifyStopsAtAnErrorBound) {
  const Outcome outcome = fovea({"simplify", grid_, "-o", out("bound.glb"), "--error", "0.001", "--json"});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_EQ(outcome.json()["result"]["stop"], "error");
  EXPECT_TRUE(outcome.json()["result"]["triangles_target"].is_null());
  EXPECT_LE(outcome.json()["result"]["error_rel"], 0.001);
}

TEST_F(Verbs, SimplifySaysWhyItIsStuck) {
  const std::string square = folder_.write("square.obj", square_obj());
  const Outcome outcome =
      fovea({"simplify", square, "-o", out("stuck.glb"), "--triangles", "1", "--lock-boundary"});
  EXPECT_EQ(outcome.code, 8);
  EXPECT_THAT(outcome.out, HasSubstr("stuck"));
  EXPECT_THAT(outcome.out, HasSubstr("drop --lock-boundary"));
  EXPECT_THAT(outcome.err, HasSubstr("--allow-miss"));
  EXPECT_TRUE(std::filesystem::exists(out("stuck.glb")));
}

TEST_F(Verbs, SimplifyAllowsAMiss) {
  const std::string square = folder_.write("square.obj", square_obj());
  const Outcome outcome = fovea({"simplify", square, "-o", out("missed.glb"), "--triangles", "1",
                                 "--lock-boundary", "--allow-miss", "--json"});
  EXPECT_EQ(outcome.code, 0);
  const nlohmann::json result = outcome.json()["result"];
  EXPECT_EQ(result["reached"], false);
  EXPECT_EQ(result["stop"], "stuck");
  EXPECT_GT(result["blocked"]["locked"], 0);
  EXPECT_TRUE(result["blocked"].contains("folds"));
}

/// Triangles of a model whose middle lies in x < 0.5, and all of them.
std::pair<std::size_t, std::size_t> left_and_all(const std::string& path) {
  Context context;
  const Model model = read_model(path, {}, context);
  const TriMesh& mesh = model.meshes[0].surface;
  std::size_t left = 0;
  for (const auto& triangle : mesh.triangles) {
    float sum = 0;
    for (const VertexId v : triangle) sum += mesh.positions[v.index()].x;
    left += sum < 1.5f;
  }
  return {left, mesh.face_count()};
}

TEST_F(Verbs, SimplifyIsFastOrAtItsBest) {
  const auto simplify = [&](std::vector<std::string> words) {
    words.insert(words.begin(), {"simplify", grid_, "-o", out("s.glb"), "--force", "--json"});
    return fovea(words);
  };
  EXPECT_EQ(simplify({"--ratio", "0.1", "--fast"}).json()["result"]["metric"], "quadric");
  const nlohmann::json best = simplify({"--ratio", "0.1", "--best", "--view-size", "64"}).json();
  EXPECT_EQ(best["exit_code"], 0);
  EXPECT_EQ(best["metric"]["trials"].size(), 5u);  // large pictures are for those who leave their size open
  EXPECT_GT(best["saliency"]["trials"].size(), 1u);
  for (const std::vector<std::string>& wrong :
       {std::vector<std::string>{"--fast", "--best", "--ratio", "0.1"},
        {"--best", "--metric", "image", "--ratio", "0.1"},
        {"--best", "--even-exposure", "--ratio", "0.1"},
        {"--fast", "--even-exposure", "--ratio", "0.1"},
        {"--fast", "--saliency", "auto", "--ratio", "0.1"},
        {"--best", "--bytes", "9KB"},
        {"--best", "--per-mesh", "--ratio", "0.1"}})
    EXPECT_EQ(simplify(wrong).code, 2) << wrong[0] << wrong[1];
}

TEST_F(Verbs, SimplifySpendsTrianglesWhereTheImportanceIs) {
  Context context;
  const Model model = read_model(grid_, {}, context);
  std::string list = "importance\n";
  for (const Vec3f& p : model.meshes[0].surface.positions) list += p.x < 0.5f ? "1000\n" : "1\n";
  const std::string csv = folder_.write("importance.csv", list);
  const Outcome outcome =
      fovea({"simplify", grid_, "-o", out("left.glb"), "--ratio", "0.3", "--importance", csv});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const auto [left, all] = left_and_all(out("left.glb"));
  // Both halves have the same shape: without importance each keeps about a half.
  EXPECT_GT(left, all * 2 / 3);
}

TEST_F(Verbs, SimplifyRefusesAnImportanceThatIsNotThere) {
  const auto code_and_error = [&](const std::string& source) {
    const Outcome outcome =
        fovea({"simplify", grid_, "-o", out("x.glb"), "--ratio", "0.5", "--importance", source});
    return std::pair(outcome.code, outcome.err);
  };
  EXPECT_EQ(code_and_error("no-such.npy").first, 3);
  EXPECT_EQ(code_and_error("_NOT_THERE").first, 5);
  std::string values;
  for (int i = 1; i < 25 * 25; ++i) values += "1\n";
  const std::pair<std::string, std::string> wrong[] = {{"1\n2\n", "the field has 2 values"},
                                                       {"nan\n" + values, "value 0 of the field is nan"},
                                                       {"-inf\n" + values, "value 0 of the field is -inf"},
                                                       {"-1\n" + values, "mesh 0 has the importance -1"}};
  for (const auto& [text, message] : wrong) {
    const auto [code, error] = code_and_error(folder_.write("wrong.csv", text));
    EXPECT_EQ(code, 4) << message;
    EXPECT_THAT(error, HasSubstr("wrong.csv: " + message));
  }
  folder_.write("lock.csv", "inf\n" + values);
  EXPECT_EQ(fovea({"simplify", grid_, "-o", out("locked.glb"), "--ratio", "0.5", "--importance",
                   out("lock.csv"), "--quiet"})
                .code,
            0);
  EXPECT_FALSE(std::filesystem::exists(out("x.glb")));
}

TEST_F(Verbs, VerboseTellsPhases) {
  const Outcome outcome = fovea({"info", grid_, "-v"});
  EXPECT_THAT(outcome.err, HasSubstr("fovea: read ..."));
  EXPECT_THAT(outcome.err, HasSubstr("peak memory"));
}

}  // namespace
}  // namespace fovea::test
