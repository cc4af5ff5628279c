#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <csignal>

#include "fovea/io/image_codec.h"
#include "run_command.h"

namespace fovea::test {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;

class RenderVerb : public ::testing::Test {
 protected:
  std::string out(const std::string& name) const { return folder_ / name; }
  Image8 picture(const std::string& name) const {
    const std::string bytes = read_text(out(name));
    return decode_image({reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()});
  }

  Folder folder_;
  std::string grid_ = write_grid(folder_, "grid.glb");
};

TEST_F(RenderVerb, DrawsASheetOfAllViews) {
  const Outcome outcome = fovea({"render", grid_, "-o", out("sheet.png"), "--width", "40", "--height", "30",
                                 "--columns", "5", "--json"});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const nlohmann::json json = outcome.json();
  EXPECT_EQ(json["views"].size(), 24u);
  EXPECT_EQ(json["inputs"][0]["path"], grid_);
  EXPECT_EQ(json["outputs"][0]["format"], "png");
  EXPECT_EQ(json["outputs"][0]["bytes"], std::filesystem::file_size(out("sheet.png")));
  EXPECT_EQ(json["outputs"][0]["width"], 200);
  EXPECT_EQ(json["outputs"][0]["height"], 150);
  const Image8 sheet = picture("sheet.png");
  EXPECT_EQ(sheet.width, 200);
  EXPECT_EQ(sheet.height, 150);
  // The last place of the sheet has no view and is background.
  EXPECT_EQ(sheet.at(199, 149)[0], 128);
}

TEST_F(RenderVerb, DrawsOneViewInTheFormatOfTheExtension) {
  for (const char* name : {"a.png", "a.jpg", "a.webp"}) {
    ASSERT_EQ(fovea({"render", grid_, "-o", out(name), "--view", "17", "--width", "64", "--height", "64",
                     "--background", "#ff0000"})
                  .code,
              0);
    const Image8 image = picture(name);
    EXPECT_EQ(image.width, 64);
    EXPECT_NEAR(image.at(0, 0)[0], 255, 8);  // JPEG is not exact
    EXPECT_NEAR(image.at(0, 0)[1], 0, 8);
    EXPECT_LT(image.at(32, 32)[0], 240) << "the model is in the middle";
  }
}

TEST_F(RenderVerb, ASizeIsBothSidesAndASideWins) {
  const auto size = [&](std::vector<std::string> words) {
    words.insert(words.begin(), {"render", grid_, "-o", out("x.png"), "--view", "1", "--force"});
    EXPECT_EQ(fovea(words).code, 0);
    const Image8 image = picture("x.png");
    return std::pair(image.width, image.height);
  };
  EXPECT_EQ(size({}), std::pair(512, 512));
  EXPECT_EQ(size({"--view-size", "48"}), std::pair(48, 48));
  EXPECT_EQ(size({"--width", "32", "--view-size", "48"}), std::pair(32, 48));
}

TEST_F(RenderVerb, SaysWhatWasDrawn) {
  const Outcome outcome = fovea({"render", grid_, "-o", out("x.png"), "--view-size", "16"});
  EXPECT_THAT(outcome.out, HasSubstr(grid_ + " -> " + out("x.png") + "\n24 views of "));
  EXPECT_THAT(outcome.out, HasSubstr("peak memory"));
}

TEST_F(RenderVerb, StopsBetweenViews) {
  Running running({"render", grid_, "-o", out("x.png"), "--views", "fibonacci", "--view-count", "400",
                   "--view-size", "256", "--samples", "8", "--threads", "1", "--verbose"});
  ASSERT_TRUE(running.wait_for_talk());
  running.send(SIGINT);
  EXPECT_EQ(running.wait().code, 130);
  EXPECT_EQ(folder_.names(), std::vector<std::string>{"grid.glb"});
}

TEST_F(RenderVerb, DrawsTheSameForAnyThreads) {
  ASSERT_EQ(fovea({"render", grid_, "-o", out("one.png"), "--threads", "1", "--width", "64"}).code, 0);
  ASSERT_EQ(fovea({"render", grid_, "-o", out("two.png"), "--threads", "2", "--width", "64"}).code, 0);
  EXPECT_EQ(read_text(out("one.png")), read_text(out("two.png")));
}

TEST_F(RenderVerb, ShowsAFieldAsHeat) {
  const std::string csv = folder_.write("height.csv", [] {
    std::string text;
    for (int i = 0; i < 25 * 25; ++i) text += std::to_string(i) + "\n";
    return text;
  }());
  const Outcome outcome = fovea(
      {"render", grid_, "-o", out("heat.png"), "--pass", "field", "--field", csv, "--view", "17", "--json"});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_EQ(outcome.json()["field"]["low"], 0);
  EXPECT_EQ(outcome.json()["field"]["high"], 624);
}

TEST_F(RenderVerb, RefusesWhatItCannotDo) {
  struct Case {
    std::vector<std::string> words;
    int code;
    const char* message;
  };
  const Case cases[] = {
      {{}, 2, "for example -o picture.png"},
      {{"-o", out("x.glb")}, 2, "pictures are not written as .glb"},
      {{"-o", out("x.png"), "--view-count", "5"},
       2,
       "--view-count needs --views fibonacci, orbit or cameras"},
      {{"-o", out("x.png"), "--pass", "field"}, 2, "--field"},
      {{"-o", out("x.png"), "--field", "_HEAT"}, 2, "--pass field"},
      {{"-o", out("x.png"), "--pass", "field", "--field", "_HEAT"},
       5,
       "grid.glb: no mesh has a vertex attribute \"_HEAT\""},
      {{"-o", out("x.png"), "--background", "red"}, 2, "#RRGGBB"},
      {{"-o", out("x.png"), "--view", "25"}, 2, "24 views"},
      {{"-o", out("x.png"), "--views", "cameras"}, 5, "grid.glb: the model has no cameras"},
      {{"-o", out("x.png"), "--time", "1"}, 2, "--animation"},
      {{"-o", out("x.png"), "--animation", "3"}, 5, "it has none; leave out --animation"},
      {{"-o", out("x.png"), "--width", "0"}, 2, "1..32768"},
      {{"-o", out("x.png"), "--width", "30000", "--columns", "3"}, 2, "65536"},
      {{"-o", folder_ / "no/x.png"}, 7, "folder"},
  };
  for (const Case& c : cases) {
    std::vector<std::string> words{"render", grid_};
    words.insert(words.end(), c.words.begin(), c.words.end());
    const Outcome outcome = fovea(words);
    EXPECT_EQ(outcome.code, c.code) << outcome.err;
    EXPECT_THAT(outcome.err, HasSubstr(c.message));
    EXPECT_THAT(outcome.out, IsEmpty());
  }
  EXPECT_EQ(folder_.names(), std::vector<std::string>{"grid.glb"}) << "nothing is left behind";
}

}  // namespace
}  // namespace fovea::test
