#include "fovea/texture/shrink.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <utility>

#include "fovea/base/error.h"
#include "fovea/base/random.h"
#include "fovea/io/image_codec.h"
#include "fovea/texture/image_use.h"
#include "support/meshes.h"
#include "support/pictures.h"
#include "support/reading.h"
#include "support/textured.h"

namespace fovea {
namespace {

using ::testing::HasSubstr;
using Kind = TexelMeaning::Kind;

/// What photographs have and formulas lack: no row is like another, so that files shrink with their images.
Image8 picture(int width, int height) {
  Image8 image = test::pattern(width, height);
  Random random(11);
  for (std::uint8_t& x : image.pixels) x = static_cast<std::uint8_t>(x / 2 + 100 * random.uniform());
  return image;
}

EncodedImage png(const Image8& image) { return {"", "image/png", "", encode_png(image), ""}; }

Image8 with_alpha(int size, std::uint8_t alpha) {
  Image8 image(size, size, 4, ColorEncoding::srgb);
  const Image8 colors = picture(size, size);
  for (int y = 0; y < size; ++y) {
    for (int x = 0; x < size; ++x) {
      std::copy_n(colors.at(x, y), 3, image.at(x, y));
      image.at(x, y)[3] = x < size / 2 ? 255 : alpha;
    }
  }
  return image;
}

/// A material whose base colour is image 0 and whose normal map is image 1.
Model two_images() {
  Model model;
  model.images = {png(picture(64, 32)), png(picture(40, 40))};
  model.textures = {{0, 0, "", ""}, {1, -1, "", ""}};
  model.samplers = {{Wrap::clamp, Wrap::mirror, {}, {}, ""}};
  Material material;
  material.base_color = TextureRef{0, 0, {}};
  material.normal = TextureRef{1, 0, {}};
  model.materials = {material};
  return model;
}

Shrunk shrink(const Model& model, const ShrinkOptions& options) {
  Context context;
  return shrink_textures(model, options, {}, context);
}

TEST(ImageUses, AreThoseOfAllMaterials) {
  Model model = two_images();
  model.images.push_back(png(picture(4, 4)));
  Material mask;
  mask.base_color = TextureRef{0, 0, {}};
  mask.alpha_mode = AlphaMode::mask;
  mask.alpha_cutoff = 0.3;
  mask.json = R"({"extensions": {"KHR_materials_clearcoat": {"clearcoatNormalTexture": {"index": 1}}}})";
  model.materials.push_back(mask);
  const std::vector<ImageUse> uses = image_uses(model);
  EXPECT_EQ(uses[0].meaning.kind, Kind::color);
  EXPECT_TRUE(uses[0].alpha_counts);
  EXPECT_EQ(uses[0].meaning.alpha_cutoff, 0.3);
  // The first material shows what alpha hides in the other.
  EXPECT_FALSE(uses[0].meaning.transparent);
  EXPECT_EQ(uses[0].wrap_u, Wrap::clamp);
  EXPECT_EQ(uses[0].wrap_v, Wrap::mirror);
  EXPECT_EQ(uses[1].meaning.kind, Kind::normal);
  EXPECT_FALSE(uses[1].is_ambiguous);
  EXPECT_EQ(uses[1].wrap_u, Wrap::repeat);  // no sampler
  EXPECT_FALSE(uses[2].is_used);
}

TEST(ImageUses, DifferentMeaningsAreAmbiguous) {
  Model model = two_images();
  model.materials[0].emissive = TextureRef{1, 0, {}};
  EXPECT_TRUE(image_uses(model)[1].is_ambiguous);
  model = two_images();
  model.materials[0].json = R"({"extensions": {"KHR_materials_sheen": {"sheenColorTexture": {"index": 0}}}})";
  EXPECT_FALSE(image_uses(model)[0].is_ambiguous);
}

TEST(ImageUses, NonsenseInExtensionsIsPassedOver) {
  for (const char* json :
       {"", "{", "[]", R"({"extensions": 3})", R"({"extensions": {"X": {"aTexture": {"index": 99}}}})",
        R"({"extensions": {"X": {"aTexture": {"index": "0"}, "bTexture": 4}}})"}) {
    Model model = two_images();
    model.materials[0].json = json;
    EXPECT_FALSE(image_uses(model)[0].is_ambiguous) << json;
  }
}

TEST(ShrinkTextures, NothingAskedChangesNothing) {
  const Model model = two_images();
  const Shrunk found = shrink(model, {});
  EXPECT_EQ(found.model.images, model.images);
  EXPECT_EQ(found.images[0].after.bytes, found.images[0].before.bytes);
  EXPECT_EQ(found.images[0].kept_because, "");
}

TEST(ShrinkTextures, SidesAreScaledAndLimited) {
  ShrinkOptions options;
  options.scale = 0.5;
  options.max_side = 16;
  const Shrunk found = shrink(two_images(), options);
  const ImageInfo color = image_info(found.model.images[0].bytes),
                  normal = image_info(found.model.images[1].bytes);
  EXPECT_EQ(color.width, 16);
  EXPECT_EQ(color.height, 8);
  EXPECT_EQ(normal.width, 16);
  EXPECT_EQ(found.images[1].after.width, 16);
  EXPECT_EQ(found.images[0].after.bytes, found.model.images[0].bytes.size());
  EXPECT_LT(found.images[0].after.bytes, found.images[0].before.bytes);
  options.scale = 1e-4;
  EXPECT_EQ(image_info(shrink(two_images(), options).model.images[0].bytes).width, 1);
}

TEST(ShrinkTextures, FormatsFollowAlphaThatCounts) {
  Model model = two_images();
  model.images[0] = png(with_alpha(64, 0));
  ShrinkOptions options;
  options.output.format = TextureOutput::jpeg;
  options.output.psnr_db = 30;
  options.scale = 0.5;
  EXPECT_EQ(shrink(model, options).model.images[0].mime_type, "image/jpeg");  // opaque: nobody reads alpha
  model.materials[0].alpha_mode = AlphaMode::blend;
  EXPECT_EQ(shrink(model, options).model.images[0].mime_type, "image/png");
  options.output.format = TextureOutput::webp;
  const Model webp = shrink(model, options).model;
  EXPECT_EQ(webp.images[0].mime_type, "image/webp");
  EXPECT_EQ(image_info(webp.images[0].bytes).channels, 4);
}

TEST(ShrinkTextures, FilesNeverGrow) {
  Model model = two_images();
  model.images[0] = {"", "image/jpeg", "", encode_jpeg(picture(64, 32), 20), ""};
  ShrinkOptions options;
  options.output.format = TextureOutput::png;
  const Shrunk same = shrink(model, options);
  EXPECT_EQ(same.model.images[0], model.images[0]);
  EXPECT_THAT(same.images[0].kept_because, HasSubstr("larger"));
  options = {};
  options.scale = 0.95;
  options.output.psnr_db = 60;
  const Shrunk smaller = shrink(model, options);
  EXPECT_LT(smaller.model.images[0].bytes.size(), model.images[0].bytes.size());
  EXPECT_EQ(image_info(smaller.model.images[0].bytes).width, 61);
}

TEST(ShrinkTextures, WhatCannotBeReadStaysAndTheOthersAreNotLost) {
  Model model = two_images();
  model.images[0].bytes.resize(model.images[0].bytes.size() / 2);
  model.images.push_back({"", "image/ktx2", "", {1, 2, 3}, ""});
  ShrinkOptions options;
  options.scale = 0.5;
  Context context;
  const Shrunk found = shrink_textures(model, options, {}, context);
  EXPECT_EQ(found.model.images[0], model.images[0]);
  EXPECT_EQ(found.model.images[2], model.images[2]);
  EXPECT_EQ(image_info(found.model.images[1].bytes).width, 20);
  std::uint64_t told = 0;
  for (const Diagnostic& diagnostic : context.diagnostics()) told += diagnostic.count;
  EXPECT_EQ(told, 2u);
}

TEST(ShrinkTextures, OptionsAreChecked) {
  ShrinkOptions options;
  options.scale = 0;
  test::expect_error([&] { shrink(two_images(), options); }, ErrorKind::usage, "");
  options = {};
  options.scales = {1};
  test::expect_error([&] { shrink(two_images(), options); }, ErrorKind::usage, "");
  options.scales = {1, 1.5};
  test::expect_error([&] { shrink(two_images(), options); }, ErrorKind::usage, "");
  options = {};
  options.shown_pixels = -1;
  test::expect_error([&] { shrink(two_images(), options); }, ErrorKind::usage, "");
  options = {};
  options.max_bytes = 0;
  test::expect_error([&] { shrink(two_images(), options); }, ErrorKind::usage, "");
}

TEST(ShrinkTextures, ScalesAreThoseOfEachImageAndObeyTheOtherLimits) {
  ShrinkOptions options;
  options.scales = {0.25, 1};
  const Shrunk found = shrink(two_images(), options);
  EXPECT_EQ(found.images[0].after.width, 16);
  EXPECT_EQ(found.images[0].reason, SizeReason::seen);
  EXPECT_EQ(found.model.images[1], two_images().images[1]);
  EXPECT_EQ(found.images[1].reason, SizeReason::none);
  options.max_side = 10;
  EXPECT_EQ(shrink(two_images(), options).images[0].after.width, 10);
  EXPECT_EQ(shrink(two_images(), options).images[0].reason, SizeReason::asked);
}

/// A square that shows two images as colours: one full of detail, one of a single even slope.
Model detailed_and_flat() {
  Image8 flat(128, 128, 3, ColorEncoding::srgb);
  for (int y = 0; y < 128; ++y) {
    for (int x = 0; x < 128; ++x) flat.at(x, y)[0] = static_cast<std::uint8_t>(x + y / 2);
  }
  Model model = test::textured(test::grid(2, 2), 2);
  model.images = {png(picture(128, 128)), png(flat)};
  model.materials[0].emissive = std::exchange(model.materials[0].normal, {});
  return model;
}

std::uint64_t bytes_of(const Model& model) {
  std::uint64_t sum = 0;
  for (const EncodedImage& image : model.images) sum += image.bytes.size();
  return sum;
}

TEST(ShrinkTextures, BytesGoToWhereDetailIs) {
  const Model model = detailed_and_flat();
  for (const TextureOutput format : {TextureOutput::keep, TextureOutput::webp, TextureOutput::jpeg}) {
    ShrinkOptions options;
    options.output.format = format;
    for (const int bytes : {30000, 6000}) {
      options.max_bytes = bytes;
      const Shrunk found = shrink(model, options);
      EXPECT_LE(found.bytes, static_cast<std::uint64_t>(bytes));
      EXPECT_EQ(found.bytes, bytes_of(found.model));
      EXPECT_GE(found.images[0].after.bytes, 3 * found.images[1].after.bytes) << bytes;
      EXPECT_EQ(found.images[0].reason, SizeReason::bytes);
    }
  }
}

TEST(ShrinkTextures, BytesAreUsedUp) {
  // Of an image of so many texels only every third quality is tried, 5 % apart here, until what is left is
  // spent.
  Model model = test::textured(test::grid(2, 2), 1);
  model.images[0] = png(picture(600, 600));
  ShrinkOptions options;
  options.output.format = TextureOutput::jpeg;
  options.max_bytes = 60000;
  EXPECT_GT(shrink(model, options).bytes, 58800u);
}

TEST(ShrinkTextures, BytesThatSufficeChangeNothing) {
  const Model model = detailed_and_flat();
  ShrinkOptions options;
  options.max_bytes = static_cast<std::int64_t>(bytes_of(model));
  EXPECT_EQ(shrink(model, options).model.images, model.images);
}

TEST(ShrinkTextures, BytesThatCannotBeReachedAreTold) {
  Model model = detailed_and_flat();
  model.images.push_back({"", "image/ktx2", "", std::vector<std::uint8_t>(5000), ""});
  ShrinkOptions options;
  options.max_bytes = 4000;
  Context context;
  const Shrunk found = shrink_textures(model, options, {}, context);
  EXPECT_GT(found.bytes, 5000u);
  EXPECT_LT(found.bytes, 6000u);
  EXPECT_EQ(found.model.images[2], model.images[2]);
  const std::vector<Diagnostic> told = context.diagnostics();
  EXPECT_TRUE(std::ranges::any_of(told, [](const Diagnostic& d) { return d.code == "bytes-missed"; }));
}

TEST(ShrinkTextures, BytesObeyTheOtherLimits) {
  ShrinkOptions options;
  options.max_bytes = 20000;
  options.scale = 0.5;
  options.scales = {1, 0.25};
  const Shrunk found = shrink(detailed_and_flat(), options);
  EXPECT_LE(found.images[0].after.width, 64);
  EXPECT_LE(found.images[1].after.width, 32);
  EXPECT_LE(found.bytes, 20000u);
}

TEST(ShrinkTextures, HalvesKeepWhatPicturesShowBetweenCharts) {
  ShrinkOptions options;
  options.scale = 0.5;
  options.output.format = TextureOutput::png;
  const auto is_plain = [&](int side) {
    const Model model = test::small_charts(side);
    const Image8 half =
        resized(decode_image(model.images[0].bytes), side / 2, side / 2, {}, Wrap::repeat, Wrap::repeat, {});
    return decode_image(shrink(model, options).model.images[0].bytes).pixels == half.pixels;
  };
  // Pictures of 512² to 2048² show smaller copies of a large image, and texels of a small one one by one.
  EXPECT_TRUE(is_plain(2048));
  EXPECT_FALSE(is_plain(80));
}

TEST(ShrinkTextures, WhereNoWarpIsTakenPicturesDecideAboutFillingToo) {
  ShrinkOptions options;
  options.scale = 0.25;
  options.output.format = TextureOutput::png;
  options.warp.floor = 1;  // every cell is as important as the others
  const auto is_plain = [&](int side) {
    const Model model = test::small_charts(side);
    const Shrunk found = shrink(model, options);
    EXPECT_THAT(found.atlases.at(0).fixed_because, HasSubstr("gain nothing"));
    const Image8 quarter =
        resized(decode_image(model.images[0].bytes), side / 4, side / 4, {}, Wrap::repeat, Wrap::repeat, {});
    return decode_image(found.model.images[0].bytes).pixels == quarter.pixels;
  };
  EXPECT_TRUE(is_plain(2048));
  EXPECT_FALSE(is_plain(80));
}

TEST(ShrinkTextures, TexelsMoveWhereASideBecomesAQuarterOrLess) {
  ShrinkOptions options;
  options.scale = 0.3;
  const auto why = [&] { return shrink(detailed_and_flat(), options).atlases.at(0).fixed_because; };
  EXPECT_THAT(why(), testing::HasSubstr("a quarter"));
  options.scale = 0.25;
  EXPECT_THAT(why(), testing::Not(testing::HasSubstr("a quarter")));
  options.scale = 0.3;
  options.moves = TexelMoves::saliency;  // published ways move always
  EXPECT_THAT(why(), testing::Not(testing::HasSubstr("a quarter")));
}

TEST(ShrinkTextures, BytesLeaveTexelsWhereTheyAre) {
  ShrinkOptions options;
  options.max_bytes = 6000;
  const Shrunk found = shrink(detailed_and_flat(), options);
  EXPECT_NE(found.atlases.at(0).fixed_because, "");
  options.moves = TexelMoves::saliency;
  test::expect_error([&] { shrink(detailed_and_flat(), options); }, ErrorKind::usage, "");
}

TEST(ShrinkTextures, PicturesDecideWhetherAllSidesAreHalvedAlike) {
  const Model model = detailed_and_flat();
  ShrinkOptions options;
  options.max_bytes = 6000;
  const Shrunk by_estimate = shrink(model, options);
  ASSERT_NE(by_estimate.images[0].after.width, by_estimate.images[1].after.width);
  std::vector<int> seen;  // widths of image 0 of what is halved alike
  options.lost = [&](const Model& tried) {
    EXPECT_LE(bytes_of(tried), 6000u);
    const int a = decode_image(tried.images[0].bytes).width, b = decode_image(tried.images[1].bytes).width;
    if (a == b) seen.push_back(a);
    return a == b ? 1.0 / a : 1.0;  // the larger the better, of the two alike
  };
  const Shrunk by_pictures = shrink(model, options);
  ASSERT_FALSE(seen.empty());
  EXPECT_EQ(by_pictures.images[0].after.width, *std::ranges::max_element(seen));
  EXPECT_EQ(by_pictures.images[0].after.width, by_pictures.images[1].after.width);
  options.lost = [](const Model&) { return 1.0; };  // of what loses as much estimates are kept
  EXPECT_EQ(shrink(model, options).model.images, by_estimate.model.images);
}

TEST(ShrinkTextures, WhatWouldOnlyGrowDoesNotKeepOthersFromBeingHalved) {
  Model model = detailed_and_flat();
  model.images[1] = png(Image8(128, 128, 3, ColorEncoding::srgb));  // a file of a few bytes
  ShrinkOptions options;
  options.output.format = TextureOutput::jpeg;
  options.max_bytes = 6000;
  std::vector<int> seen;
  options.lost = [&](const Model& tried) {
    EXPECT_EQ(tried.images[1], model.images[1]);
    seen.push_back(decode_image(tried.images[0].bytes).width);
    return 1.0;
  };
  shrink(model, options);
  EXPECT_GT(seen.size(), 1u);
  EXPECT_THAT(seen, testing::Contains(64));
}

TEST(ShrinkTextures, PicturesDecideWhetherAllFilesAreAsNear) {
  Model model = detailed_and_flat();
  Image8 faint = picture(128, 128);
  for (std::uint8_t& x : faint.pixels) x = static_cast<std::uint8_t>(120 + x / 8);
  model.images[1] = png(faint);
  ShrinkOptions options;
  options.output.format = TextureOutput::jpeg;
  options.max_bytes = 20000;
  // How much nearer one file is to its image than the other, in dB.
  const auto apart = [&](const Model& made) {
    std::array<double, 2> psnr{};
    for (std::size_t i = 0; i < 2; ++i) {
      const Image8 file = decode_image(made.images[i].bytes);
      const Image8 plain = resized(decode_image(model.images[i].bytes), file.width, file.height, {},
                                   Wrap::repeat, Wrap::repeat, {});
      psnr[i] = encoding_psnr(plain, file, Content::colors);
    }
    return std::abs(psnr[0] - psnr[1]);
  };
  EXPECT_GT(apart(shrink(model, options).model), 3);
  options.lost = [&](const Model& tried) {
    return apart(tried) + 1000.0 / decode_image(tried.images[0].bytes).width;
  };
  EXPECT_LT(apart(shrink(model, options).model), 1);
}

TEST(ShrinkTextures, PicturesDecideWhatColorsAreWorth) {
  Model model = test::textured(test::grid(2, 2), 2);
  model.images = {png(picture(128, 128)), png(picture(128, 128))};  // base colour and normals
  ShrinkOptions options;
  options.output.format = TextureOutput::jpeg;
  options.max_bytes = 9000;
  const Shrunk by_estimate = shrink(model, options);
  for (const std::size_t liked : {0, 1}) {
    options.lost = [&](const Model& tried) {
      return 1.0 / static_cast<double>(tried.images[liked].bytes.size());
    };
    const Shrunk by_pictures = shrink(model, options);
    EXPECT_GT(by_pictures.images[liked].after.bytes, by_estimate.images[liked].after.bytes) << liked;
    EXPECT_LE(by_pictures.bytes, 9000u);
  }
}

TEST(ShrinkTextures, BytesAreTheSameForAnyNumberOfThreads) {
  ShrinkOptions options;
  options.max_bytes = 9000;
  options.output.format = TextureOutput::webp;
  Context one, four;
  one.threads = 1;
  four.threads = 4;
  const Model model = detailed_and_flat();
  EXPECT_EQ(shrink_textures(model, options, {}, one).model.images,
            shrink_textures(model, options, {}, four).model.images);
}

}  // namespace
}  // namespace fovea
