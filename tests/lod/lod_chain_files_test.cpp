#include "fovea/lod/lod_chain_files.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "lod_chains.h"
#include "support/meshes.h"
#include "support/reading.h"

namespace fovea {
namespace {

LodChain chain() {
  Context context;
  return make_lod_chain(test::model_of(test::icosphere(3)), test::quick_chain(), {}, context);
}

TEST(LodFiles, NamesFollowThePattern) {
  EXPECT_EQ(lod_name("{name}_LOD{i}", "chair", 2), "chair_LOD2.glb");
  EXPECT_EQ(lod_name("LOD{i}_{name}.glb", "chair", 0), "LOD0_chair.glb");
  EXPECT_EQ(lod_name("{i}", "chair", 7), "7.glb");
  EXPECT_EQ(lod_name("{name}.{i}", "{i}{name}", 1), "{i}{name}.1.glb");
  test::expect_error([] { lod_name("{name}", "chair", 0); }, ErrorKind::usage, "--name");
  test::expect_error([] { lod_name("lods/{i}", "chair", 0); }, ErrorKind::usage, "--name");
}

TEST(LodFiles, BytesFall) {
  LodChain levels = chain();
  Context context;
  const auto files = make_lod_files(levels, "{name}_LOD{i}", "ball", std::nullopt, {}, context);
  ASSERT_EQ(files.size(), 4U);
  for (std::size_t i = 1; i < files.size(); ++i) {
    EXPECT_LT(files[i].glb.size(), files[i - 1].glb.size());
    EXPECT_LT(files[i].bytes.geometry, files[i - 1].bytes.geometry);
    EXPECT_EQ(files[i].bytes.total(), files[i].glb.size());
  }
}

TEST(LodFiles, TheOriginalGoesThroughAndWhatIsNoSmallerIsLeftOut) {
  LodChain levels = chain();
  const std::uint64_t coarsest = levels.levels[3].triangles;
  Context context;
  std::vector<LodFile> all = make_lod_files(levels, "{i}", "", std::nullopt, {}, context);
  // As if the original were compressed: smaller than levels 1 and 2, but not than 3.
  LodFile original;
  original.glb.resize(all[2].glb.size());
  const auto files = make_lod_files(levels, "{i}", "", original, {}, context);
  ASSERT_EQ(files.size(), 2U);
  ASSERT_EQ(levels.levels.size(), 2U);
  EXPECT_EQ(files[0].glb, original.glb);
  EXPECT_EQ(files[1].name, "1.glb");
  EXPECT_EQ(levels.levels[1].triangles, coarsest);
  EXPECT_EQ(test::told(context, "lod-not-smaller"), 2U);
  // Asked for another way of storing, it is written like the others.
  levels = chain();
  WriteOptions options;
  options.quantize = true;
  EXPECT_NE(make_lod_files(levels, "{i}", "", original, options, context)[0].glb, original.glb);
}

TEST(LodFiles, TheSidecarTellsAll) {
  LodChain levels = chain();
  Context context;
  const auto files = make_lod_files(levels, "{name}_LOD{i}", "ball", std::nullopt, {}, context);
  const nlohmann::json json = nlohmann::json::parse(lod_sidecar(levels, files, "ball.glb"));
  EXPECT_EQ(json["schema_version"], 1);
  EXPECT_EQ(json["source"], "ball.glb");
  EXPECT_EQ(json["screen"]["fov_deg"], 60);
  ASSERT_EQ(json["levels"].size(), 4U);
  EXPECT_EQ(json["levels"][0]["switch_distance"], 0);
  EXPECT_TRUE(json["levels"][0]["screen_coverage"].is_null());
  const nlohmann::json level = json["levels"][2];
  EXPECT_EQ(level["file"], "ball_LOD2.glb");
  EXPECT_EQ(level["triangles"], 320);
  EXPECT_EQ(level["bytes"]["file"], files[2].glb.size());
  EXPECT_EQ(level["error"]["max_abs"], levels.levels[2].error.max);
  EXPECT_NEAR(level["error"]["max_rel"].get<double>(), levels.levels[2].error.max / levels.diagonal, 1e-12);
  EXPECT_NEAR(level["error"]["pixels"].get<double>(), 1, 1e-9);
  EXPECT_EQ(level["switch_distance"], levels.levels[2].distance);
  EXPECT_TRUE(level["pictures"].is_null());
}

}  // namespace
}  // namespace fovea
