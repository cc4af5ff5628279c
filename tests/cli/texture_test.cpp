#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <filesystem>

#include "fovea/io/image_codec.h"
#include "fovea/io/read.h"
#include "run_command.h"

namespace fovea::test {
namespace {

using ::testing::HasSubstr;

class TextureVerb : public ::testing::Test {
 protected:
  TextureVerb() { fovea({"sample", "vase", "-o", vase_, "--detail", "0.05"}); }

  std::string out(const std::string& name) const { return folder_ / name; }
  static Outcome texture(std::vector<std::string> words) {
    words.insert(words.begin(), "texture");
    return fovea(words);
  }
  static Model model(const std::string& path) {
    Context context;
    return read_model(path, {}, context);
  }

  Folder folder_;
  std::string vase_ = folder_ / "vase.glb";
};

TEST_F(TextureVerb, MakesImagesSmallerAndSaysSo) {
  const Outcome outcome = texture({vase_, "-o", out("small.glb"), "--max-texture", "128", "--json"});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const nlohmann::json json = outcome.json();
  const Model before = model(vase_), after = model(out("small.glb"));
  ASSERT_EQ(json["images"].size(), before.images.size());
  EXPECT_EQ(image_info(after.images[0].bytes).width, 128);
  EXPECT_EQ(json["images"][0]["after"]["width"], 128);
  EXPECT_EQ(json["images"][0]["before"]["bytes"], before.images[0].bytes.size());
  EXPECT_EQ(json["images"][0]["after"]["bytes"], after.images[0].bytes.size());
  EXPECT_EQ(json["before"]["triangles"], json["after"]["triangles"]);
  EXPECT_EQ(json["outputs"][0]["bytes"], std::filesystem::file_size(out("small.glb")));
}

TEST_F(TextureVerb, WebpNeedsItsExtension) {
  ASSERT_EQ(texture({vase_, "-o", out("webp.gltf"), "--texture-format", "webp", "--texture-psnr", "30"}).code,
            0);
  EXPECT_THAT(read_text(out("webp.gltf")), HasSubstr("EXT_texture_webp"));
  EXPECT_EQ(model(out("webp.gltf")).images[0].mime_type, "image/webp");
}

TEST_F(TextureVerb, TexelsMoveAndWhatSteersThemCanBeSeen) {
  const Outcome outcome =
      texture({vase_, "-o", out("small.glb"), "--texture-scale", "0.25", "--maps", out("map.png"), "--json"});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const nlohmann::json atlas = outcome.json()["atlases"].at(0);
  EXPECT_EQ(atlas["fixed_because"], "");
  EXPECT_LT(atlas["loss"].get<double>(), atlas["plain_loss"].get<double>());
  EXPECT_NE(model(out("small.glb")).meshes[0].surface.find(Semantic::uv)->values,
            model(vase_).meshes[0].surface.find(Semantic::uv)->values);
  for (const char* map : {"saliency", "distortion", "coverage", "detail", "importance"})
    EXPECT_TRUE(std::filesystem::exists(out(std::string("map-") + map + ".png"))) << map;
  // They are files like others.
  EXPECT_EQ(
      texture({vase_, "-o", out("other.glb"), "--texture-scale", "0.25", "--maps", out("map.png")}).code, 2);
  EXPECT_FALSE(std::filesystem::exists(out("other.glb")));
}

TEST_F(TextureVerb, ThePublishedWaysCanBeAskedFor) {
  for (const char* way : {"saliency", "frequency"}) {
    const Outcome outcome = texture(
        {vase_, "-o", out("small.glb"), "--texture-scale", "0.25", "--warp", way, "--force", "--json"});
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    EXPECT_EQ(outcome.json()["atlases"].at(0)["fixed_because"], "") << way;
  }
  const Outcome outcome = texture({vase_, "-o", out("small.glb"), "--texture-scale", "0.25", "--warp", "none",
                                   "--warp-cells", "64", "--force"});
  EXPECT_EQ(outcome.code, 2);
  EXPECT_THAT(outcome.err, HasSubstr("--warp"));
}

TEST_F(TextureVerb, OddImagesAreHandledOrKeptWithAWord) {
  ASSERT_EQ(fovea({"sample", "vase", "-o", out("odd.gltf"), "--detail", "0.05"}).code, 0);
  const std::string image = out("odd_image0.png");
  const auto shrink = [&] {
    return texture(
        {out("odd.gltf"), "-o", out("odd-small.glb"), "--texture-scale", "0.25", "--force", "--json"});
  };
  const auto write = [&](int width, int height, int channels) {
    Image8 picture(width, height, channels, ColorEncoding::srgb);
    for (std::size_t i = 0; i < picture.pixels.size(); ++i)
      picture.pixels[i] = static_cast<std::uint8_t>(i * i / 7);
    const std::vector<std::uint8_t> bytes = encode_png(picture);
    folder_.write("odd_image0.png", {bytes.begin(), bytes.end()});
  };
  for (const auto& [width, height, channels] :
       {std::array{1, 1, 3}, {1, 9, 1}, {301, 17, 3}, {64, 48, 1}, {33, 70, 2}, {50, 50, 4}}) {
    write(width, height, channels);
    const Outcome outcome = shrink();
    ASSERT_EQ(outcome.code, 0) << width << " x " << height << ": " << outcome.err;
    EXPECT_LE(outcome.json()["images"][0]["after"]["bytes"], outcome.json()["images"][0]["before"]["bytes"]);
    EXPECT_EQ(image_info(model(out("odd-small.glb")).images[0].bytes).width,
              outcome.json()["images"][0]["after"]["width"]);
  }
  folder_.write("odd_image0.png", read_text(image).substr(0, 100));
  const Outcome damaged = shrink();
  EXPECT_EQ(damaged.code, 0) << damaged.err;
  EXPECT_THAT(damaged.json()["images"][0]["kept_because"].get<std::string>(), HasSubstr("damaged"));
}

TEST_F(TextureVerb, NothingAskedIsAnError) {
  const Outcome outcome = texture({vase_, "-o", out("same.glb")});
  EXPECT_EQ(outcome.code, 2);
  EXPECT_THAT(outcome.err, HasSubstr("--max-texture"));
  EXPECT_FALSE(std::filesystem::exists(out("same.glb")));
}

TEST_F(TextureVerb, ValuesOutOfRangeAreRefused) {
  for (const auto& [option, value] : {std::pair{"--texture-scale", "0"},
                                      {"--texture-scale", "1.5"},
                                      {"--max-texture", "-3"},
                                      {"--texture-size", "0"},
                                      {"--texture-size", "-512"},
                                      {"--texture-size", "big"},
                                      {"--texture-bytes", "0"},
                                      {"--texture-bytes", "-1"},
                                      {"--texture-bytes", "10k"},
                                      {"--texture-psnr", "5"},
                                      {"--texture-format", "gif"}}) {
    const Outcome outcome = texture({vase_, "-o", out("bad.glb"), option, value});
    EXPECT_EQ(outcome.code, 2) << option << value;
    EXPECT_THAT(outcome.err, HasSubstr(option));
  }
}

TEST_F(TextureVerb, EachImageIsAsLargeAsItIsSeen) {
  const Outcome outcome = texture({vase_, "-o", out("seen.glb"), "--texture-size", "64", "--json"});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const nlohmann::json image = outcome.json()["images"][0];
  const double per_pixel = image["texels_per_pixel"], width = image["before"]["width"];
  EXPECT_EQ(image["reason"], "seen");
  // The next half of a half, or the one before if that is nearly enough (kSpare: 2^-0.25).
  const double after = image["after"]["width"];
  EXPECT_GT(after * per_pixel / width, 0.84);
  EXPECT_LT(after * per_pixel / width, 1.69);
  EXPECT_EQ(width / after, std::exp2(std::round(std::log2(width / after))));
  EXPECT_LT(after, width);
  const Outcome text = texture({vase_, "-o", out("seen2.glb"), "--texture-size", "64"});
  EXPECT_THAT(text.out, HasSubstr("texels per pixel"));
  // From nearby nothing is too large.
  const Outcome near = texture({vase_, "-o", out("near.glb"), "--texture-size", "65536", "--json"});
  EXPECT_EQ(near.json()["images"][0]["reason"], "none");
}

TEST_F(TextureVerb, ImagesFitIntoBytes) {
  const Outcome outcome = texture(
      {vase_, "-o", out("bytes.glb"), "--texture-bytes", "20000", "--texture-format", "webp", "--json"});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  std::uint64_t sum = 0;
  for (const EncodedImage& image : model(out("bytes.glb")).images) sum += image.bytes.size();
  EXPECT_LE(sum, 20000u);
  EXPECT_GT(sum, 10000u);
  EXPECT_EQ(outcome.json()["reached"], true);
  EXPECT_EQ(outcome.json()["images"][0]["reason"], "bytes");
}

TEST_F(TextureVerb, BytesThatCannotBeReachedAreAMiss) {
  const Outcome outcome = texture({vase_, "-o", out("few.glb"), "--texture-bytes", "10", "--json"});
  EXPECT_EQ(outcome.code, 8);
  EXPECT_EQ(outcome.json()["reached"], false);
  EXPECT_TRUE(std::filesystem::exists(out("few.glb")));
  EXPECT_THAT(outcome.err, HasSubstr("--allow-miss"));
  EXPECT_EQ(texture({vase_, "-o", out("few2.glb"), "--texture-bytes", "10", "--allow-miss"}).code, 0);
}

TEST_F(TextureVerb, BytesAreSpentByPicturesFromTheViews) {
  const auto within = [&](const char* views) {
    return texture({vase_, "-o", out("views.glb"), "--force", "--texture-bytes", "20000", "--views", views});
  };
  EXPECT_EQ(within("octahedron").code, 0);
  const Outcome outcome = within("cameras");
  EXPECT_EQ(outcome.code, 5);
  EXPECT_THAT(outcome.err, HasSubstr("camera"));
}

TEST_F(TextureVerb, OptionsThatDoNothingAloneAreRefused) {
  EXPECT_EQ(texture({vase_, "-o", out("x.glb"), "--max-texture", "64", "--views", "cube"}).code, 2);
  EXPECT_EQ(texture({vase_, "-o", out("x.glb"), "--max-texture", "64", "--allow-miss"}).code, 2);
}

TEST_F(TextureVerb, AModelWithoutTexturesComesThrough) {
  const std::string square = folder_.write("square.obj", square_obj());
  EXPECT_EQ(texture({square, "-o", out("square.glb"), "--texture-scale", "0.5"}).code, 0);
}

TEST_F(TextureVerb, SimplifyBakesTexturesAnew) {
  const Outcome outcome =
      fovea({"simplify", vase_, "-o", out("baked.glb"), "--ratio", "0.1", "--metric", "quadric", "--textures",
             "--texture-scale", "0.5", "--new-normal-maps", "--json"});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const nlohmann::json json = outcome.json();
  ASSERT_FALSE(json["atlases"].empty());
  EXPECT_EQ(json["atlases"][0]["not_rebaked_because"], "");
  EXPECT_GT(json["atlases"][0]["rebaked_texels"], 0);
  EXPECT_LT(json["images"][0]["after"]["bytes"], json["images"][0]["before"]["bytes"]);
  const Model before = model(vase_), after = model(out("baked.glb"));
  EXPECT_GE(after.images.size(), before.images.size());
  EXPECT_TRUE(after.materials[0].normal);
}

TEST_F(TextureVerb, SimplifyCanLeaveTexturesAlone) {
  const std::vector<std::string> words{"simplify", vase_,      "-o",      out("small.glb"), "--ratio",
                                       "0.1",      "--metric", "quadric", "--force",        "--json"};
  EXPECT_FALSE(fovea(words).json().contains("images"));
  const Model before = model(vase_);
  EXPECT_EQ(model(out("small.glb")).images[0].bytes, before.images[0].bytes);
  std::vector<std::string> smaller = words;
  smaller.insert(smaller.end(), {"--textures", "--rebake", "off", "--max-texture", "64"});
  const nlohmann::json json = fovea(smaller).json();
  EXPECT_EQ(json["images"][0]["after"]["width"], 64);
  EXPECT_FALSE(json["atlases"][0].contains("rebaked_texels"));
}

TEST_F(TextureVerb, OptionsOfTexturesNeedThem) {
  for (const std::vector<std::string>& extra : {std::vector<std::string>{"--max-texture", "64"},
                                                {"--new-normal-maps"},
                                                {"--rebake", "off"},
                                                {"--warp", "none"},
                                                {"--texture-psnr", "30"},
                                                {"--warp-cells", "8"}}) {
    std::vector<std::string> words{"simplify", vase_, "-o", out("bad.glb"), "--ratio", "0.5"};
    words.insert(words.end(), extra.begin(), extra.end());
    const Outcome outcome = fovea(words);
    EXPECT_EQ(outcome.code, 2) << extra[0];
    EXPECT_THAT(outcome.err, HasSubstr("--textures")) << extra[0];
  }
  const Outcome outcome = fovea({"simplify", vase_, "-o", out("bad.glb"), "--ratio", "0.5", "--textures",
                                 "--rebake", "off", "--new-normal-maps"});
  EXPECT_EQ(outcome.code, 2);
  EXPECT_THAT(outcome.err, HasSubstr("--rebake"));
}

TEST_F(TextureVerb, SimplifyWithoutImagesSaysThatThereAreNone) {
  const std::string square = folder_.write("square.obj", square_obj());
  const Outcome outcome =
      fovea({"simplify", square, "-o", out("square.glb"), "--ratio", "1", "--textures", "--new-normal-maps"});
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_THAT(outcome.out, HasSubstr("textures none"));
}

}  // namespace
}  // namespace fovea::test
