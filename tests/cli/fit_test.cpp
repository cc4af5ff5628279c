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
using ::testing::Not;

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

TEST_F(FitVerb, SeveralBudgetsGetAFileEach) {
  const Outcome outcome = fit({"-o", out("o.glb"), "--bytes", "40KB, 15kb,8192", "--json"});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const nlohmann::json results = outcome.json()["results"], outputs = outcome.json()["outputs"];
  ASSERT_EQ(results.size(), 3u);
  double last = 0;
  const std::pair<const char*, unsigned> wanted[] = {
      {"o-40KB.glb", 40000}, {"o-15kb.glb", 15000}, {"o-8192.glb", 8192}};
  for (std::size_t i = 0; i < 3; ++i) {
    const std::string path = out(wanted[i].first);
    const std::uintmax_t size = std::filesystem::file_size(path);
    EXPECT_LE(size, wanted[i].second);
    EXPECT_EQ(results[i]["budget"], wanted[i].second);
    EXPECT_EQ(results[i]["bytes"], size);
    EXPECT_EQ(results[i]["reached"], true);
    EXPECT_EQ(outputs[i]["path"], path);
    EXPECT_GT(results[i]["loss"], last) << "fewer bytes show less";
    last = results[i]["loss"];
  }
  EXPECT_FALSE(std::filesystem::exists(out("o.glb")));
  EXPECT_FALSE(outcome.json().contains("result"));
}

TEST_F(FitVerb, IfOneOfSeveralCannotBeNothingIsWritten) {
  const Outcome outcome = fit({"-o", out("o.glb"), "--bytes", "40KB,500"});
  EXPECT_EQ(outcome.code, 8);
  EXPECT_THAT(outcome.err, HasSubstr("no file takes 500 B or less: the smallest takes"));
  EXPECT_FALSE(std::filesystem::exists(out("o-40KB.glb")));
  EXPECT_FALSE(std::filesystem::exists(out("o-500.glb")));
}

TEST_F(FitVerb, OfSeveralAsGltfEachKeepsToItsBytes) {
  const Outcome outcome =
      fit({"-o", out("o.gltf"), "--bytes", "30KB,9KB", "--curve", out("c.html"), "--views", "tetrahedron"});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_THAT(outcome.out, HasSubstr("o-30KB.gltf"));
  for (const auto& [name, bytes] : {std::pair{"o-30KB", 30000u}, {"o-9KB", 9000u}}) {
    std::uintmax_t size = 0;
    for (const auto& entry : std::filesystem::directory_iterator(out("")))
      if (entry.path().filename().string().starts_with(name)) size += entry.file_size();
    EXPECT_GT(size, 0u);
    EXPECT_LE(size, bytes);
  }
  const std::string page = read_text(out("c.html"));
  EXPECT_NE(page.find("circle class=\"chosen\""), page.rfind("circle class=\"chosen\"")) << "two rings";
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
  ASSERT_EQ(curve["chosen"].size(), 1u);
  EXPECT_LE(curve["chosen"][0]["bytes"], 10000);
  EXPECT_GT(curve["path"][0]["bytes"], curve["path"][1]["bytes"]);
  EXPECT_THAT(outcome.out, HasSubstr("dB from the original at 96 pixels"));
}

TEST_F(FitVerb, TheCurveAsAPageHasPicturesAndStandsForItself) {
  const Outcome outcome = fit({"-o", out("o.glb"), "--bytes", "10KB", "--curve", out("curve.html"), "--views",
                               "tetrahedron", "--search", "exhaustive"});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const std::string page = read_text(out("curve.html"));
  EXPECT_THAT(page, HasSubstr("<title>hills.glb: likeness over bytes</title>"));
  EXPECT_THAT(page, HasSubstr("data:image/png;base64,"));
  EXPECT_THAT(page, HasSubstr("class=\"chosen\""));
  EXPECT_THAT(page, HasSubstr("class=\"all\""));
  EXPECT_THAT(page, Not(HasSubstr("http")));
}

TEST_F(FitVerb, WhatIsLostAndFromWhereCanBeChosen) {
  for (const char* const distortion : {"mse", "ms-ssim", "flip"}) {
    const Outcome outcome = fit({"-o", out("o.glb"), "--force", "--bytes", "12KB", "--distortion", distortion,
                                 "--views", "orbit", "--view-count", "3", "--search", "grow", "--json"});
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    const nlohmann::json result = outcome.json()["result"];
    EXPECT_LE(result["bytes"], 12000);
    EXPECT_GT(result["loss"], 0);
    EXPECT_LT(result["loss"], distortion == std::string("mse") ? 255 * 255 : 1);
  }
}

TEST_F(FitVerb, SimplifyKeepsToBytesToo) {
  const std::uintmax_t whole = std::filesystem::file_size(hills_);
  for (const bool textures : {false, true}) {
    std::vector<std::string> words{
        "simplify", hills_,   "-o",      out("s.glb"),
        "--force",  "--json", "--bytes", std::to_string(textures ? whole / 6 : whole * 2 / 3)};
    if (textures) words.push_back("--textures");
    const Outcome outcome = fovea(words);
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    const std::uintmax_t size = std::filesystem::file_size(out("s.glb"));
    EXPECT_LE(size, textures ? whole / 6 : whole * 2 / 3);
    EXPECT_GT(size, (textures ? whole / 6 : whole * 2 / 3) * 9 / 10);
    EXPECT_EQ(outcome.json()["result"]["reached"], true);
    const auto images = [&](const char* when) {
      return outcome.json()[when]["bytes_by_kind"]["images"].get<int>();
    };
    EXPECT_EQ(images("after") < images("before"), textures);
  }
}

TEST_F(FitVerb, TextureKeepsToBytesToo) {
  const std::uintmax_t whole = std::filesystem::file_size(hills_);
  const Outcome outcome =
      fovea({"texture", hills_, "-o", out("t.glb"), "--bytes", std::to_string(whole * 7 / 8), "--json"});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_LE(std::filesystem::file_size(out("t.glb")), whole * 7 / 8);
  EXPECT_EQ(outcome.json()["after"]["triangles"], outcome.json()["before"]["triangles"]);
}

TEST_F(FitVerb, LevelsKeepToBytesToo) {
  const Outcome outcome =
      fovea({"lods", hills_, "-o", out("lods"), "--bytes", "20KB,6KB", "--quantize", "--no-pictures"});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const std::uintmax_t most[] = {20000, 6000};
  for (int i = 1; i <= 2; ++i) {
    const std::uintmax_t size =
        std::filesystem::file_size(out("lods/hills_LOD" + std::to_string(i) + ".glb"));
    EXPECT_LE(size, most[i - 1]);
    EXPECT_GT(size, most[i - 1] * 8 / 10);
  }
}

TEST_F(FitVerb, OtherVerbsWriteNothingWhereBytesAreTooFew) {
  for (const std::vector<std::string>& words :
       {std::vector<std::string>{"simplify", hills_, "-o", out("s.glb")},
        {"texture", hills_, "-o", out("s.glb")},
        {"lods", hills_, "-o", out("s")}}) {
    std::vector<std::string> all = words;
    all.insert(all.end(), {"--bytes", "700"});
    const Outcome outcome = fovea(all);
    EXPECT_EQ(outcome.code, 8) << words[0] << outcome.err;
    EXPECT_THAT(outcome.err, HasSubstr("no file takes 700 B or less: the smallest takes"));
    EXPECT_FALSE(std::filesystem::exists(words[3]));
  }
}

TEST_F(FitVerb, OtherVerbsRefuseWrongBytes) {
  const auto refuses = [&](const std::vector<std::string>& words, const std::string& why) {
    const Outcome outcome = fovea(words);
    EXPECT_EQ(outcome.code, 2) << why;
    EXPECT_THAT(outcome.err, HasSubstr(why));
  };
  refuses({"simplify", hills_, "-o", out("s.ply"), "--bytes", "7KB"}, "s.ply");
  refuses({"simplify", hills_, "-o", out("s.glb"), "--bytes", "7KB", "--textures", "--texture-bytes", "5000"},
          "both given");
  refuses({"texture", hills_, "-o", out("s.glb"), "--bytes", "7KB", "--texture-bytes", "5000"}, "both given");
  refuses({"texture", hills_, "-o", out("s.obj"), "--bytes", "7KB"}, "s.obj");
  refuses({"lods", hills_, "-o", out("s"), "--bytes", "7KB,9KB"}, "do not fall");
  refuses({"lods", hills_, "-o", out("s"), "--bytes", "7KB", "--triangles", "50"}, "several ways");
  refuses({"lods", hills_, "-o", out("s.glb"), "--bytes", "7KB"}, "--bytes needs a folder as output");
}

TEST_F(FitVerb, MatchesALikeness) {
  const Outcome outcome = fit({"-o", out("o.glb"), "--match", "psnr=25@128", "--json"});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_LT(std::filesystem::file_size(out("o.glb")), std::filesystem::file_size(hills_) / 2);
  const Outcome compared = fovea({"compare", hills_, out("o.glb"), "--views", "icosahedron", "--view-size",
                                  "128", "--distance-samples", "0", "--json"});
  EXPECT_GE(compared.json()["results"][0]["lit"]["psnr_foreground"], 25.0);
}

TEST_F(FitVerb, WhatCannotBeIsSaidAndNothingWritten) {
  const Outcome outcome = fit({"-o", out("o.glb"), "--bytes", "500"});
  EXPECT_EQ(outcome.code, 8);
  EXPECT_THAT(outcome.err, HasSubstr("the smallest takes"));
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
  refuses({"--bytes", "5KB,9KB"}, "numbers of bytes do not fall");
  refuses({"--bytes", "5KB,,1KB"}, "'' is no number of bytes");
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
