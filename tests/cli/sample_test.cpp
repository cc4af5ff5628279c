#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "fovea/io/image_file.h"
#include "run_command.h"

namespace fovea::test {
namespace {

using ::testing::HasSubstr;

/// Land of a user's own.
class SampleVerb : public ::testing::Test {
 protected:
  SampleVerb() {
    Image8 heights(9, 5, 1, ColorEncoding::linear), texture(16, 8, 3, ColorEncoding::srgb);
    for (std::size_t i = 0; i < heights.pixels.size(); ++i)
      heights.pixels[i] = static_cast<std::uint8_t>(i * 5);
    for (std::size_t i = 0; i < texture.pixels.size(); ++i) texture.pixels[i] = static_cast<std::uint8_t>(i);
    write_image(heights, heights_, false);
    write_image(texture, texture_, false);
  }

  Outcome terrain(std::vector<std::string> more) const {
    more.insert(more.begin(), {"sample", "terrain", "-o", land_, "--force"});
    return fovea(more);
  }

  Folder folder_;
  std::string heights_ = folder_ / "heights.png", texture_ = folder_ / "land.jpg",
              land_ = folder_ / "land.glb";
};

TEST_F(SampleVerb, MakesLandOfAMapAndAPicture) {
  const Outcome outcome = terrain(
      {"--heights", heights_, "--texture", texture_, "--land-width", "90", "--relief", "51", "--json"});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_EQ(outcome.json()["after"]["triangles"], 2 * 8 * 4);
  EXPECT_EQ(outcome.json()["inputs"][0]["path"], heights_);
  EXPECT_EQ(outcome.json()["inputs"][1]["format"], "jpg");
  const nlohmann::json info = fovea({"info", land_, "--json"}).json();
  EXPECT_EQ(info["images"][0]["mime_type"], "image/jpeg");
  EXPECT_EQ(info["images"][0]["bytes"], std::filesystem::file_size(texture_));
  // From the middle of the first pixel to that of the last.
  const nlohmann::json low = info["bounds"]["low"], high = info["bounds"]["high"];
  EXPECT_NEAR(high[0].get<double>() - low[0].get<double>(), 80, 1e-4);
  EXPECT_NEAR(high[1].get<double>() - low[1].get<double>(), 51 * 220 / 255.0, 1e-4);
}

TEST_F(SampleVerb, SaysWhatIsWrongWithAMap) {
  EXPECT_THAT(terrain({"--heights", texture_, "--texture", texture_}).err,
              HasSubstr("land.jpg: the height map is in colour"));
  const std::string text = folder_.write("text.png", "no image");
  EXPECT_THAT(terrain({"--heights", text, "--texture", texture_}).err,
              HasSubstr("text.png: the image is not of a known format"));
  EXPECT_THAT(terrain({"--heights", heights_, "--texture", text}).err,
              HasSubstr("text.png: the image is not of a known format"));
  EXPECT_EQ(terrain({"--heights", folder_ / "none.png", "--texture", texture_}).code, 3);
  EXPECT_THAT(terrain({"--heights", heights_, "--texture", texture_, "--detail", "2"}).err,
              HasSubstr("no more detail than its pixels"));
  // Options that would do nothing.
  EXPECT_THAT(terrain({"--heights", heights_}).err, HasSubstr("--heights needs --texture"));
  EXPECT_THAT(terrain({"--relief", "3"}).err, HasSubstr("--relief needs --heights"));
  EXPECT_THAT(fovea({"sample", "vase", "-o", land_, "--heights", heights_, "--texture", texture_}).err,
              HasSubstr("--heights needs the NAME terrain"));
  EXPECT_EQ(folder_.names(), (std::vector<std::string>{"heights.png", "land.jpg", "text.png"}));
}

}  // namespace
}  // namespace fovea::test
