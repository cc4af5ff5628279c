#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <csignal>
#include <filesystem>
#include <fstream>

#include "fovea/io/read.h"
#include "run_command.h"

namespace fovea::test {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

class LodsVerb : public ::testing::Test {
 protected:
  std::string out(const std::string& name) const { return folder_ / name; }
  static Outcome lods(std::vector<std::string> words) {
    words.insert(words.begin(), "lods");
    return fovea(words);
  }
  /// Quick: no pictures, quadrics.
  static Outcome quick(std::vector<std::string> words) {
    words.insert(words.end(), {"--no-pictures", "--metric", "quadric", "--distance-samples", "2000"});
    return lods(std::move(words));
  }
  static Model model(const std::string& path) {
    Context context;
    return read_model(path, {}, context);
  }
  static std::vector<std::string> names(const std::string& folder) {
    std::vector<std::string> names;
    for (const auto& entry : fs::directory_iterator(folder)) names.push_back(entry.path().filename());
    std::sort(names.begin(), names.end());
    return names;
  }
  void expect_refused(std::vector<std::string> words, int code, const std::string& text) const {
    words.insert(words.begin(), grid_);
    const std::vector<std::string> before = folder_.names();
    const Outcome outcome = quick(words);
    EXPECT_EQ(outcome.code, code) << outcome.err;
    EXPECT_THAT(outcome.err, HasSubstr(text));
    EXPECT_THAT(outcome.err, HasSubstr("hint:"));
    EXPECT_EQ(folder_.names(), before) << "nothing is left behind";
  }

  Folder folder_;
  std::string grid_ = write_grid(folder_, "grid.glb");  // 1152 triangles
};

TEST_F(LodsVerb, AFolderGetsAFilePerLevelAndWhatIsKnownOfThem) {
  const Outcome outcome = quick({grid_, "-o", out("lods"), "--levels", "3", "--json"});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_THAT(names(out("lods")),
              ElementsAre("grid_LOD0.glb", "grid_LOD1.glb", "grid_LOD2.glb", "grid_lods.json"));
  EXPECT_EQ(read_text(out("lods/grid_LOD0.glb")), read_text(grid_)) << "the original, bit for bit";
  const json report = outcome.json(), sidecar = json::parse(read_text(out("lods/grid_lods.json")));
  EXPECT_EQ(report["levels"], sidecar["levels"]);
  EXPECT_EQ(report["outputs"].size(), 4U);
  EXPECT_EQ(report["verb"], "lods");
  const std::uint64_t triangles[] = {1152, 576, 288};
  for (std::size_t i = 0; i < 3; ++i) {
    const json level = sidecar["levels"][i];
    const std::string path = out("lods/" + level["file"].get<std::string>());
    EXPECT_EQ(level["triangles"], triangles[i]);
    EXPECT_EQ(counts(model(path)).triangles, triangles[i]);
    EXPECT_EQ(level["bytes"]["file"], fs::file_size(path));
    if (i == 0) continue;
    EXPECT_LT(level["bytes"]["file"], sidecar["levels"][i - 1]["bytes"]["file"]);
    EXPECT_GT(level["error"]["max_abs"], sidecar["levels"][i - 1]["error"]["max_abs"]);
  }
}

TEST_F(LodsVerb, PeopleGetATable) {
  const Outcome outcome = lods({grid_, "-o", out("lods"), "--triangles", "300,100", "--view-size", "64"});
  EXPECT_EQ(outcome.code, 2) << "pictures are as large as the level";
  const Outcome table = lods({grid_, "-o", out("lods"), "--triangles", "300,100"});
  ASSERT_EQ(table.code, 0) << table.err;
  EXPECT_THAT(table.out, HasSubstr("from distance"));
  EXPECT_THAT(table.out, HasSubstr("FLIP"));
  EXPECT_THAT(table.out, HasSubstr("image from 200 triangles on"));
  EXPECT_THAT(quick({grid_, "-o", out("quiet"), "--quiet"}).out, IsEmpty());
}

TEST_F(LodsVerb, NamesFollowThePattern) {
  ASSERT_EQ(quick({grid_, "-o", out("lods/"), "--levels", "2", "--name", "LOD{i}_{name}"}).code, 0);
  EXPECT_THAT(names(out("lods")), ElementsAre("LOD0_grid.glb", "LOD1_grid.glb", "grid_lods.json"));
}

TEST_F(LodsVerb, OneFileHoldsAllLevels) {
  const Outcome outcome = quick({grid_, "-o", out("all.glb"), "--levels", "3", "--json"});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const Model all = model(out("all.glb"));
  EXPECT_THAT(all.extensions_used, ElementsAre("MSFT_lod"));
  EXPECT_EQ(all.meshes.size(), 3U);
  EXPECT_EQ(counts(all).triangles_drawn, 1152U) << "who does not know the extension sees level 0";
  const json node = json::parse(all.nodes[0].json);
  EXPECT_EQ(node["extensions"]["MSFT_lod"]["ids"].size(), 2U);
  EXPECT_EQ(node["extras"]["MSFT_screencoverage"].size(), 3U);
  EXPECT_EQ(outcome.json()["outputs"].size(), 1U);
  // It has levels now: no others are made of it.
  const Outcome again = quick({out("all.glb"), "-o", out("more.glb")});
  EXPECT_EQ(again.code, 5);
  EXPECT_THAT(again.err, HasSubstr("MSFT_lod"));
}

TEST_F(LodsVerb, TheScreenSaysWhichLevels) {
  const Outcome outcome = quick(
      {grid_, "-o", out("lods"), "--coverage", "0.5,0.1", "--height", "720", "--pixel-error", "2", "--json"});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const json levels = outcome.json()["levels"];
  ASSERT_EQ(levels.size(), 3U);
  EXPECT_NEAR(levels[1]["screen_coverage"].get<double>(), 0.5, 1e-9);
  for (std::size_t i = 1; i < 3; ++i) EXPECT_LE(levels[i]["error"]["pixels"].get<double>(), 2);
  const std::string distances = std::to_string(levels[1]["switch_distance"].get<double>()) + "," +
                                std::to_string(levels[2]["switch_distance"].get<double>());
  const Outcome same = quick({grid_, "-o", out("same"), "--distances", distances, "--height", "720",
                              "--pixel-error", "2", "--json"});
  ASSERT_EQ(same.code, 0) << same.err;
  EXPECT_EQ(same.json()["levels"][2]["triangles"], levels[2]["triangles"]);
}

TEST_F(LodsVerb, WrongRequestsAreRefusedWithAHint) {
  const std::string folder = out("lods");
  expect_refused({"-o", folder, "--levels", "0"}, 2, "--levels");
  expect_refused({"-o", folder, "--levels", "x"}, 2, "--levels");
  expect_refused({"-o", folder, "--ratio", "50"}, 2, "--ratio");
  expect_refused({"-o", folder, "--triangles", "100,300"}, 2, "does not fall below");
  expect_refused({"-o", folder, "--triangles", "100,,300"}, 2, "not a list");
  expect_refused({"-o", folder, "--triangles", "100;50"}, 2, "not a list");
  expect_refused({"-o", folder, "--triangles", "100,0"}, 2, "not above 0");
  expect_refused({"-o", folder, "--triangles", "1.5"}, 2, "not a list");
  expect_refused({"-o", folder, "--coverage", "0.1,0.5"}, 2, "does not fall below");
  expect_refused({"-o", folder, "--coverage", "5"}, 2, "inside");
  expect_refused({"-o", folder, "--distances", "20,10"}, 2, "does not rise above");
  expect_refused({"-o", folder, "--coverage", "0.5", "--triangles", "100"}, 2, "several ways");
  expect_refused({"-o", folder, "--name", "same"}, 2, "{i}");
  expect_refused({"-o", out("lods.obj")}, 2, "neither a folder nor a .glb");
  expect_refused({"-o", out("lods.gltf")}, 2, "neither a folder nor a .glb");
  expect_refused({"-o", out("missing/lods")}, 7, "does not exist");
  expect_refused({}, 2, "no output");
}

TEST_F(LodsVerb, OptionsThatDoNothingAreRefused) {
  const auto refused = [&](std::vector<std::string> words, const std::string& needs) {
    words.insert(words.begin(), {grid_, "-o", out("lods")});
    const Outcome outcome = lods(words);
    EXPECT_EQ(outcome.code, 2);
    EXPECT_THAT(outcome.err, HasSubstr(needs));
  };
  refused({"--levels", "3", "--triangles", "100"}, "needs no --triangles");
  refused({"--textures", "keep", "--texture-format", "webp"}, "--textures follow");
  refused({"--vanish", "0.01"}, "a .glb");
  refused({"--position-bits", "10"}, "--quantize");
  const Outcome named = lods({grid_, "-o", out("all.glb"), "--name", "{i}"});
  EXPECT_EQ(named.code, 2);
  EXPECT_THAT(named.err, HasSubstr("a folder"));
}

TEST_F(LodsVerb, LevelsShareTheirVertices) {
  const Outcome own = quick({grid_, "-o", out("own.glb"), "--levels", "3", "--placement", "half-edge"});
  const Outcome shared = quick({grid_, "-o", out("shared.glb"), "--levels", "3", "--share-vertices"});
  ASSERT_EQ(shared.code, 0) << shared.err;
  EXPECT_LT(std::filesystem::file_size(out("shared.glb")), std::filesystem::file_size(out("own.glb")));
  EXPECT_EQ(counts(model(out("shared.glb"))).triangles, counts(model(out("own.glb"))).triangles);
  const auto refused = [&](std::vector<std::string> words, const std::string& why) {
    words.insert(words.begin(), {grid_, "--share-vertices"});
    const Outcome outcome = lods(words);
    EXPECT_EQ(outcome.code, 2);
    EXPECT_THAT(outcome.err, HasSubstr(why));
  };
  refused({"-o", out("folder")}, "a .glb as output");
  refused({"-o", out("grid.fovea")}, "a chain, not all levels");
  refused({"-o", out("a.glb"), "--placement", "optimal"}, "levels with vertices of their own");
  refused({"-o", out("a.glb"), "--warp", "saliency"}, "levels with vertices of their own");
  // Steps that are known must leave vertices where they are.
  ASSERT_EQ(lods({grid_, "-o", out("moving.fovea"), "--triangles", "40"}).code, 0);
  const Outcome moving = lods({out("moving.fovea"), "-o", out("b.glb"), "--share-vertices", "--no-pictures"});
  EXPECT_EQ(moving.code, 2);
  EXPECT_THAT(moving.err, HasSubstr("half-edge"));
}

TEST_F(LodsVerb, WhatIsThereStaysUnlessForced) {
  fs::create_directory(out("lods"));
  folder_.write("lods/grid_LOD1.glb", "mine");
  const Outcome kept = quick({grid_, "-o", out("lods")});
  EXPECT_EQ(kept.code, 2);
  EXPECT_THAT(kept.err, HasSubstr("--force"));
  EXPECT_THAT(names(out("lods")), ElementsAre("grid_LOD1.glb"));
  EXPECT_EQ(quick({grid_, "-o", out("lods"), "--force"}).code, 0);
  EXPECT_NE(read_text(out("lods/grid_LOD1.glb")), "mine");
  folder_.write("file", "mine");
  EXPECT_EQ(quick({grid_, "-o", out("file")}).code, 7);
}

TEST_F(LodsVerb, ModelsWithoutLevelsAreRefused) {
  folder_.write("square.obj", square_obj());
  const Outcome outcome = quick({out("square.obj"), "-o", out("lods"), "--keep-topology"});
  EXPECT_EQ(outcome.code, 5) << outcome.err;
  EXPECT_FALSE(fs::exists(out("lods")));
}

TEST_F(LodsVerb, UnreachableCountsAreTold) {
  const std::vector<std::string> words{
      grid_, "-o", out("lods"), "--triangles", "500,10", "--lock-boundary", "--force"};
  EXPECT_EQ(quick(words).code, 8);
  std::vector<std::string> allowed = words;
  allowed.push_back("--allow-miss");
  EXPECT_EQ(quick(allowed).code, 0);
}

TEST_F(LodsVerb, TheSameBytesForAnyNumberOfThreads) {
  ASSERT_EQ(lods({grid_, "-o", out("one"), "--threads", "1", "--levels", "3"}).code, 0);
  ASSERT_EQ(lods({grid_, "-o", out("two"), "--threads", "2", "--levels", "3"}).code, 0);
  for (const std::string& name : names(out("one")))
    EXPECT_EQ(read_text(out("one/" + name)), read_text(out("two/" + name)));
}

TEST_F(LodsVerb, CancellingLeavesNothing) {
  const std::string vase = out("vase.glb");
  ASSERT_EQ(fovea({"sample", "vase", "-o", vase}).code, 0);
  Running running({"lods", vase, "-o", out("lods"), "--verbose"});
  ASSERT_TRUE(running.wait_for_talk());
  running.send(SIGINT);
  EXPECT_EQ(running.wait().code, 130);
  EXPECT_FALSE(fs::exists(out("lods")));
}

TEST_F(LodsVerb, ASkinnedModelsPosesStayWithinTheStatedError) {
  const std::string arm = out("arm.glb");
  ASSERT_EQ(fovea({"sample", "arm", "-o", arm, "--detail", "0.1"}).code, 0);
  const Outcome made = lods({arm, "-o", out("lods"), "--textures", "keep", "--levels", "3", "--no-pictures",
                             "--metric", "quadric", "--json"});
  ASSERT_EQ(made.code, 0) << made.err;
  const json levels = made.json()["levels"];
  for (std::size_t i = 1; i < levels.size(); ++i) {
    const std::string file = out("lods/" + levels[i]["file"].get<std::string>());
    for (const char* time : {"0", "0.4", "0.9", "1.5", "2.2", "3"}) {
      const Outcome compared = fovea({"compare", arm, file, "--animation", "0", "--time", time, "--views",
                                      "tetrahedron", "--view-size", "32", "--json"});
      ASSERT_EQ(compared.code, 0) << compared.err;
      const json distance = compared.json()["results"][0]["distance"];
      const double error =
          std::max(distance["forward"]["max"].get<double>(), distance["backward"]["max"].get<double>());
      EXPECT_LE(error, 1.02 * levels[i]["error"]["max_abs"].get<double>()) << "level " << i << " at " << time;
    }
  }
}

TEST_F(LodsVerb, AFileOfAllLevelsIsReadAsTheOriginal) {
  const Outcome made = lods({grid_, "-o", out("grid.fovea"), "--triangles", "40", "--json"});
  ASSERT_EQ(made.code, 0) << made.err;
  const json result = json::parse(made.out)["result"];
  EXPECT_EQ(result["triangles"], 1152);
  EXPECT_LE(result["triangles_coarsest"], 40);
  EXPECT_EQ(result["bytes"], fs::file_size(out("grid.fovea")));
  const json info = json::parse(fovea({"info", out("grid.fovea"), "--json"}).out);
  EXPECT_EQ(info["inputs"][0]["format"], "fovea");
  EXPECT_EQ(info["totals"]["triangles"], 1152);
  // Levels of a chain and of an eye's focus are read off it; nothing is simplified that could be told how.
  const Outcome chain =
      lods({out("grid.fovea"), "-o", out("lods"), "--triangles", "300,100", "--no-pictures"});
  EXPECT_EQ(chain.code, 0) << chain.err;
  EXPECT_LE(counts(model(out("lods/grid_LOD2.glb"))).triangles, 100u);
  const Outcome focus =
      fovea({"focus", out("grid.fovea"), "-o", out("focus.glb"), "--at", "128,128", "--triangles", "600"});
  EXPECT_EQ(focus.code, 0) << focus.err;
  EXPECT_EQ(lods({out("grid.fovea"), "-o", out("y.fovea"), "--triangles", "90"}).code, 2);
  const Outcome told = lods({out("grid.fovea"), "-o", out("x"), "--metric", "image"});
  EXPECT_EQ(told.code, 2);
  EXPECT_THAT(told.err, HasSubstr("--metric needs a model without levels"));
}

TEST_F(LodsVerb, AGlbWithAllLevelsShowsTheCoarsest) {
  const Outcome made =
      lods({grid_, "-o", out("all.glb"), "--as", "levels", "--triangles", "40", "--quantize"});
  ASSERT_EQ(made.code, 0) << made.err;
  EXPECT_LE(counts(model(out("all.glb"))).triangles, 40u) << "to who does not know the extension";
  const json info = json::parse(fovea({"info", out("all.glb"), "--json"}).out);
  EXPECT_EQ(info["totals"]["triangles"], 1152);
}

TEST_F(LodsVerb, RefusesWhatAllLevelsHaveNoUseFor) {
  const std::vector<std::string> before = folder_.names();
  EXPECT_EQ(lods({grid_, "-o", out("a.fovea"), "--triangles", "300,100"}).code, 2);
  EXPECT_EQ(lods({grid_, "-o", out("a.fovea"), "--levels", "3"}).code, 2);
  EXPECT_EQ(lods({grid_, "-o", out("a.fovea"), "--as", "chain"}).code, 2);
  EXPECT_EQ(lods({grid_, "-o", out("lods"), "--as", "levels"}).code, 2);
  EXPECT_EQ(folder_.names(), before);
  std::ofstream(out("cut.fovea"), std::ios::binary) << "\x89"
                                                       "FOVEA\r\n\1";
  EXPECT_EQ(fovea({"info", out("cut.fovea")}).code, 4);
}

}  // namespace
}  // namespace fovea::test
