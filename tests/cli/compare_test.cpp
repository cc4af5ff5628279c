#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "run_command.h"

namespace fovea::test {
namespace {

using ::testing::HasSubstr;

class CompareVerb : public ::testing::Test {
 protected:
  CompareVerb() { fovea({"simplify", grid_, "-o", small_, "--ratio", "0.1"}); }

  Folder folder_;
  std::string grid_ = write_grid(folder_, "grid.glb");
  std::string small_ = folder_ / "small.glb";
};

TEST_F(CompareVerb, ReportsEveryView) {
  const Outcome outcome =
      fovea({"compare", grid_, small_, grid_, "--views", "cube", "--view-size", "64", "--json"});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const nlohmann::json json = outcome.json();
  ASSERT_EQ(json["inputs"].size(), 3u);
  EXPECT_EQ(json["inputs"][0]["path"], grid_);
  EXPECT_EQ(json["inputs"][0]["triangles"], 1152);
  EXPECT_EQ(json["inputs"][1]["bytes"], std::filesystem::file_size(small_));
  ASSERT_EQ(json["results"].size(), 2u);
  const nlohmann::json &small = json["results"][0], &same = json["results"][1];
  EXPECT_EQ(small["path"], small_);
  EXPECT_EQ(small["views"].size(), 8u);
  EXPECT_GT(small["lit"]["flip"], 0);
  EXPECT_LT(small["lit"]["ms_ssim"], 1);
  EXPECT_GT(small["distance"]["mean_rel"], 0);
  EXPECT_EQ(same["lit"]["flip"], 0);
  EXPECT_TRUE(same["lit"]["psnr"].is_null()) << "infinite";
}

TEST_F(CompareVerb, PrintsATable) {
  const Outcome outcome = fovea({"compare", grid_, small_, "--views", "tetrahedron", "--view-size", "64"});
  EXPECT_EQ(outcome.code, 0);
  EXPECT_THAT(outcome.out, HasSubstr("MS-SSIM"));
  EXPECT_THAT(outcome.out, HasSubstr("small.glb"));
  EXPECT_THAT(outcome.out, HasSubstr("4 views"));
  EXPECT_THAT(outcome.out, HasSubstr("peak memory"));
  EXPECT_THAT(fovea({"compare", grid_, small_, "--views", "cube", "--view-size", "32", "--quiet"}).out,
              ::testing::Not(HasSubstr("peak memory")));
}

TEST_F(CompareVerb, ComparesAcrossFormats) {
  const std::string obj = folder_ / "grid.obj";
  ASSERT_EQ(fovea({"simplify", grid_, "-o", obj, "--ratio", "1"}).code, 0);
  const nlohmann::json json =
      fovea({"compare", grid_, obj, "--views", "tetrahedron", "--view-size", "64", "--json"}).json();
  EXPECT_LT(json["results"][0]["base_color"]["flip"], 0.01);
}

TEST_F(CompareVerb, WritesAPage) {
  const std::string page = folder_ / "page.html";
  const std::vector<std::string> words{"compare",     grid_, small_,     "--views", "tetrahedron",
                                       "--view-size", "48",  "--report", page};
  ASSERT_EQ(fovea(words).code, 0);
  EXPECT_THAT(read_text(page), HasSubstr("small.glb"));
  EXPECT_THAT(read_text(page), HasSubstr("</html>"));
  EXPECT_THAT(fovea(words).err, HasSubstr("--force"));
  EXPECT_EQ(fovea({"compare", grid_, small_, "--views", "tetrahedron", "--view-size", "48", "--report",
                   folder_ / "PAGE.HTML"})
                .code,
            0);
  EXPECT_THAT(fovea({"compare", grid_, small_, "--report", folder_ / "page.txt"}).err, HasSubstr(".html"));
}

TEST_F(CompareVerb, RefusesWhatItCannotDo) {
  EXPECT_THAT(fovea({"compare", grid_}).err, HasSubstr("MODEL is missing"));
  EXPECT_EQ(fovea({"compare", grid_, folder_ / "no.glb"}).code, 3);
  EXPECT_THAT(fovea({"compare", grid_, small_, "--time", "1"}).err, HasSubstr("--animation"));
  EXPECT_THAT(fovea({"compare", grid_, small_, "--views", "cameras"}).err,
              HasSubstr("grid.glb: the model has no cameras"));
  EXPECT_EQ(fovea({"compare", grid_, small_, "--view-size", "5"}).code, 2);
}

TEST_F(CompareVerb, SaysWhichModelLacksTheAnimation) {
  const std::string arm = folder_ / "arm.glb";
  ASSERT_EQ(fovea({"sample", "arm", "-o", arm, "--detail", "0.03"}).code, 0);
  const Outcome outcome = fovea({"compare", arm, arm, grid_, "--animation", "0"});
  EXPECT_EQ(outcome.code, 5);
  EXPECT_EQ(outcome.err, "fovea: error: " + grid_ + ": the model has no animation 0\n" +
                             "hint: it has none; leave out --animation\n");
}

}  // namespace
}  // namespace fovea::test
