#include "fovea/texture/image_ways.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "fovea/base/random.h"
#include "fovea/io/image_codec.h"
#include "fovea/texture/bake.h"
#include "support/meshes.h"
#include "support/textured.h"

namespace fovea {
namespace {

/// Noise, of which every texel takes bytes.
Image8 noise(int size) {
  Image8 image(size, size, 3, ColorEncoding::srgb);
  Random random(3);
  for (std::uint8_t& x : image.pixels) x = static_cast<std::uint8_t>(255 * random.uniform());
  return image;
}

class ImageWays : public testing::Test {
 protected:
  Model model_ = test::textured(test::grid(3, 3), 1);
  std::vector<AtlasFace> faces_ = atlas_faces(model_, find_atlases(model_).at(0));
  ImageSights sights_{model_, faces_, {}, {512}};
  Image8 image_ = noise(64);
  ImageUse use_{.is_used = true, .meaning = {TexelMeaning::Kind::color}};
  ImageLoss loss_{sights_, image_, use_, {}};

  ImageLimits limits(TextureFormat format, int side = 64, double most_bytes = 1e9) const {
    return {use_, format, side, side, most_bytes};
  }
  std::vector<ImageWay> ways(const ImageLimits& limits, std::span<const AtlasFace> shown = {}) const {
    return image_ways(image_, limits, shown, loss_, {});
  }
};

TEST_F(ImageWays, AreWhatTheyWouldBeAsFiles) {
  for (const ImageWay& way : ways(limits(TextureFormat::webp))) {
    const Image8 small = way.width == 64 ? image_ : resized_for_way(image_, way.width, way.height, use_, {});
    const std::vector<std::uint8_t> file = encode_texture(small, way.file->format, way.file->quality);
    EXPECT_EQ(way.bytes, static_cast<double>(file.size()));
    EXPECT_EQ(way.losses, loss_.of(way.file->quality == 0 ? small : decode_image(file), {}));
  }
}

TEST_F(ImageWays, AreOfEachSizeWithoutLossToo) {
  std::vector<int> widths;
  for (const ImageWay& way : ways(limits(TextureFormat::png))) {
    widths.push_back(way.width);
    EXPECT_EQ(way.file->quality, 0);
    EXPECT_EQ(way.losses[0] == 0, way.width == 64);
  }
  // Of PNG, which has no quality, also sizes between the halves.
  EXPECT_THAT(widths,
              testing::ElementsAre(2, 3, 4, 5, 6, 7, 8, 10, 11, 13, 16, 19, 23, 27, 32, 38, 45, 54, 64));
}

TEST_F(ImageWays, NoneTakesTooManyBytesButTheSmallestOfAll) {
  for (const ImageWay& way : ways(limits(TextureFormat::jpeg, 64, 2000))) EXPECT_LT(way.bytes, 2000);
  EXPECT_THAT(ways(limits(TextureFormat::jpeg, 64, 10)), testing::SizeIs(1));
}

TEST_F(ImageWays, AreFilledBetweenTrianglesAndAsTheyAre) {
  // Triangles in the left half only.
  for (AtlasFace& face : faces_)
    for (Vec2d& uv : face.uv) uv.x *= 0.5;
  const auto filled = [](const ImageWay& way) { return way.file->fill; };
  const std::vector<ImageWay> found = ways(limits(TextureFormat::png, 40), faces_);
  EXPECT_EQ(std::ranges::count_if(found, filled), 17);  // 2, 3, ..., 38 and 40 texels
  EXPECT_EQ(found.size(), 34u);
  // At its own size nothing is filled.
  EXPECT_EQ(ways(limits(TextureFormat::png), faces_).size(), 37u);
}

TEST(LargeImageWays, AreAlsoUnfilledWherePicturesShowWhatLiesBetween) {
  // Filled images take fewer bytes; but smaller copies show some of what lies between charts, and halves keep
  // that.
  const Model model = test::small_charts(640);
  const std::vector<AtlasFace> faces = atlas_faces(model, find_atlases(model).at(0));
  const Image8 image = decode_image(model.images[0].bytes);
  const auto ways = [&](std::span<const AtlasFace> shown) {
    const ImageUse use{.is_used = true, .meaning = {TexelMeaning::Kind::color}};
    const ImageSights sights(model, faces, {}, {400});
    const ImageLimits limits{use, TextureFormat::jpeg, 320, 320, 1e9};
    return image_ways(image, limits, shown, ImageLoss(sights, image, use, {}), {});
  };
  const auto is_large = [](const ImageWay& way) { return way.width == 320; };
  const auto is_unfilled = [&](const ImageWay& way) { return is_large(way) && !way.file->fill; };
  EXPECT_GT(std::ranges::count_if(ways(faces), is_unfilled), 0);
  EXPECT_EQ(std::ranges::count_if(ways({}), is_unfilled), std::ranges::count_if(ways({}), is_large));
}

TEST_F(ImageWays, FinerOnesAreOfOtherQualities) {
  const ImageLimits asked = limits(TextureFormat::jpeg);
  const std::vector<ImageWay> coarse = ways(asked),
                              fine = finer_ways(coarse, 3000, image_, asked, {}, loss_, {});
  EXPECT_FALSE(fine.empty());
  for (const ImageWay& way : fine) {
    EXPECT_TRUE(std::ranges::none_of(
        coarse, [&](const ImageWay& other) { return other.width == way.width && other.file == way.file; }));
  }
}

}  // namespace
}  // namespace fovea
