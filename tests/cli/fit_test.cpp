#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>

#include "fovea/io/image_codec.h"
#include "fovea/io/write.h"
#include "run_command.h"
#include "support/meshes.h"
#include "support/pictures.h"
#include "support/textured.h"

namespace fovea::test {
namespace {

using ::testing::HasSubstr;

class FitVerb : public ::testing::Test {
 protected:
  std::string out(const std::string& name) const { return folder_ / name; }
  std::string write_hills() const {
    Model model = textured(shuffled(wavy_grid(40, 40, 0.1)), 1);
    model.images[0].bytes = encode_png(pattern(256, 256));
    Context context;
    write_model(model, out("hills.glb"), {}, context);
    return out("hills.glb");
  }
  Outcome fit(std::vector<std::string> words) const {
    words.insert(words.begin(), {"fit", hills_, "--view-size", "96"});
    return fovea(words);
  }

  Folder folder_;
  std::string hills_ = write_hills();
};

TEST_F(FitVerb, TheFileTakesNoMoreThanAsked) {
  for (const auto& [text, bytes] :
       {std::pair{"60KB", 60000u}, {"20kb", 20000u}, {"0.01 MB", 10000u}, {"8KiB", 8192u}}) {
    const Outcome outcome = fit({"-o", out("o.glb"), "--force", "--bytes", text, "--json"});
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    const nlohmann::json json = outcome.json();
    const std::uintmax_t size = std::filesystem::file_size(out("o.glb"));
    EXPECT_LE(size, bytes);
    EXPECT_EQ(json["result"]["bytes"], size);
    EXPECT_EQ(json["result"]["triangles"], json["after"]["triangles"]);
    EXPECT_EQ(json["verb"], "fit");
  }
}

TEST_F(FitVerb, AsGltfTheFilesTogetherTakeNoMore) {
  const Outcome outcome = fit({"-o", out("o.gltf"), "--bytes", "30KB", "--json"});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  std::uintmax_t size = 0;
  for (const auto& entry : std::filesystem::directory_iterator(out("")))
    if (entry.path() != hills_) size += entry.file_size();
  EXPECT_LE(size, 30000u);
  EXPECT_EQ(outcome.json()["result"]["bytes"], size);
}

TEST_F(FitVerb, WritesTheCurve) {
  const Outcome outcome = fit({"-o", out("o.glb"), "--bytes", "10KB", "--curve", out("curve.json")});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const nlohmann::json curve = nlohmann::json::parse(read_text(out("curve.json")));
  ASSERT_GT(curve["path"].size(), 3u);
  EXPECT_GT(curve["path"][0]["bytes"], curve["path"][1]["bytes"]);
  EXPECT_THAT(outcome.out, HasSubstr("dB from the original at 96 pixels"));
}

TEST_F(FitVerb, MatchesALikeness) {
  const Outcome outcome = fit({"-o", out("o.glb"), "--match", "psnr=25@128", "--json"});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_LT(std::filesystem::file_size(out("o.glb")), std::filesystem::file_size(hills_) / 2);
  const Outcome compared = fovea({"compare", hills_, out("o.glb"), "--views", "icosahedron", "--view-size",
                                  "128", "--distance-samples", "0", "--json"});
  EXPECT_GE(compared.json()["results"][0]["lit"]["psnr_foreground"],
            24.9);  // it was measured before quantising
}

TEST_F(FitVerb, WhatCannotBeIsSaidAndNothingWritten) {
  const Outcome outcome = fit({"-o", out("o.glb"), "--bytes", "500"});
  EXPECT_EQ(outcome.code, 8);
  EXPECT_THAT(outcome.err, HasSubstr("the smallest has"));
  EXPECT_FALSE(std::filesystem::exists(out("o.glb")));
  const Outcome allowed = fit({"-o", out("o.glb"), "--bytes", "500", "--allow-miss"});
  EXPECT_EQ(allowed.code, 0);
  EXPECT_TRUE(std::filesystem::exists(out("o.glb")));
}

TEST_F(FitVerb, WrongRequestsAreRefused) {
  const auto refuses = [&](std::vector<std::string> words, const std::string& why) {
    words.insert(words.end(), {"-o", out("o.glb")});
    const Outcome outcome = fit(std::move(words));
    EXPECT_EQ(outcome.code, 2) << why;
    EXPECT_THAT(outcome.err, HasSubstr(why));
  };
  refuses({}, "no budget is given");
  refuses({"--bytes", "50KB", "--match", "flip=0.1"}, "there are two targets");
  refuses({"--bytes", "lots"}, "'lots' is no number of bytes");
  refuses({"--bytes", "-5KB"}, "is no number of bytes");
  refuses({"--bytes", "5 parsecs"}, "is no number of bytes");
  refuses({"--match", "looks=1"}, "is no likeness");
  refuses({"--match", "ms-ssim=1.5"}, "is no likeness");
  refuses({"--match", "flip=0.1@7"}, "is no likeness");
  refuses({"--bytes", "50KB", "--curve", out("c.png")}, "c.png");
  EXPECT_EQ(fit({"-o", out("o.obj"), "--bytes", "50KB"}).code, 2);
  EXPECT_EQ(fovea({"fit", out("missing.glb"), "-o", out("o.glb"), "--bytes", "50KB"}).code, 3);
  EXPECT_FALSE(std::filesystem::exists(out("o.glb")));
}

}  // namespace
}  // namespace fovea::test
