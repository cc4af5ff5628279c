#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <filesystem>

#include "fovea/io/image_codec.h"
#include "fovea/io/write.h"
#include "run_command.h"
#include "support/meshes.h"

namespace fovea::test {
namespace {

using ::testing::HasSubstr;

class FlyVerb : public ::testing::Test {
 protected:
  std::string out(const std::string& name) const { return folder_ / name; }
  std::string write(const Model& model, const std::string& name) const {
    Context context;
    write_model(model, out(name), {}, context);
    return out(name);
  }
  /// A short flight with small pictures.
  Outcome fly(std::vector<std::string> words) const {
    words.insert(words.begin(), {"fly", sphere_, "--frames", "6", "--view-size", "96", "--judge-every", "2"});
    return fovea(words);
  }

  Folder folder_;
  std::string sphere_ = write(model_of(shuffled(icosphere(5))), "sphere.glb");  // 20,480 triangles
};

TEST_F(FlyVerb, SaysWhatLevelsAreAndHowTheyLook) {
  const Outcome outcome = fly({"--json", "--ratios", "0.05,0.6"});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const nlohmann::json json = outcome.json();
  ASSERT_EQ(json["ratios"].size(), 2u);
  const nlohmann::json &coarse = json["ratios"][0], &fine = json["ratios"][1];
  EXPECT_LE(coarse["triangles"], 0.05 * 20480);
  EXPECT_GE(coarse["triangles"], 0.05 * 20480 - 2);
  EXPECT_EQ(coarse["cracks"], 0);
  EXPECT_EQ(fine["cracks"], 0);
  EXPECT_LT(fine["flip"], coarse["flip"]);
  EXPECT_GE(coarse["psnr"], coarse["psnr_worst"]);
  EXPECT_GT(coarse["cpu_ms"], 0);
  EXPECT_EQ(json["device"].is_null(), coarse["gpu_ms"].is_null());
}

TEST_F(FlyVerb, WritesNumbersOfFramesAndPictures) {
  const Outcome outcome = fly({"-o", out("f.csv"), "--strip", out("f.png"), "--device", "cpu"});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const std::string text = read_text(out("f.csv"));
  EXPECT_THAT(text, HasSubstr("ratio,frame,triangles,cracks,full_draw_ms,"));
  EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 1 + 3 * 6);
  EXPECT_THAT(text, HasSubstr("\n0.05,0,1024,0,,"));  // nothing drawn
  const std::string png = read_text(out("f.png"));
  const Image8 strip = decode_image({reinterpret_cast<const std::uint8_t*>(png.data()), png.size()});
  EXPECT_EQ(strip.width, 3 * 96);  // frames 0, 2 and 4
  EXPECT_EQ(strip.height, 4 * 96);
}

TEST_F(FlyVerb, RulesDiffer) {
  const std::string torus = write(model_of(shuffled(test::torus(96, 48))), "torus.glb");
  std::vector<std::string> seen;
  for (const std::vector<std::string>& rule : {std::vector<std::string>{"--select", "error"},
                                               {"--select", "error", "--salient"},
                                               {"--select", "uniform"},
                                               {"--select", "clusters", "--clusters", "60"}}) {
    std::vector<std::string> words{"fly",      torus, "--frames", "4",   "--view-size",   "96", "--json",
                                   "--device", "cpu", "--ratios", "0.2", "--judge-every", "1"};
    words.insert(words.end(), rule.begin(), rule.end());
    const Outcome outcome = fovea(words);
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    const nlohmann::json row = outcome.json()["ratios"][0];
    EXPECT_LE(row["triangles"], 0.2 * 9216);
    EXPECT_EQ(row["cracks"], 0);
    seen.push_back(row["flip"].dump());
  }
  std::sort(seen.begin(), seen.end());
  EXPECT_EQ(std::unique(seen.begin(), seen.end()), seen.end());
}

TEST_F(FlyVerb, WithoutComparingThereIsNoLikeness) {
  const Outcome outcome = fovea({"fly", sphere_, "--frames", "4", "--view-size", "64", "--judge-every", "0",
                                 "--spread", "3", "--device", "cpu", "--json"});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_TRUE(outcome.json()["ratios"][0]["psnr"].is_null());
}

TEST_F(FlyVerb, WrongRequestsAreRefused) {
  const auto refuses = [&](std::vector<std::string> words, const std::string& why) {
    const Outcome outcome = fly(std::move(words));
    EXPECT_EQ(outcome.code, 2) << why;
    EXPECT_THAT(outcome.err, HasSubstr(why));
  };
  refuses({"--ratios", "0.5,2"}, "2 is no share of the triangles");
  refuses({"--ratios", "5%"}, "is not a value for it");
  refuses({"-o", out("f.png")}, "f.png");
  refuses({"--strip", out("f.csv")}, "f.csv");
  refuses({"--clusters", "5"}, "--select clusters");
  refuses({"--preset", "lee"}, "--salient");
  refuses({"--select", "uniform", "--unseen", "0"}, "--select error");
  const Outcome none = fovea({"fly", out("missing.glb")});
  EXPECT_EQ(none.code, 3);
  EXPECT_FALSE(std::filesystem::exists(out("f.png")));
}

}  // namespace
}  // namespace fovea::test
