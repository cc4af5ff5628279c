#include "fovea/texture/image_ways.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "fovea/base/random.h"
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
  Model model = test::textured(test::grid(3, 3), 1);
  std::vector<AtlasFace> faces = atlas_faces(model, find_atlases(model).at(0));
  ImageSights sights{model, faces, {}, {512}};
  Image8 image = noise(64);
  ImageUse use{.is_used = true, .meaning = {TexelMeaning::Kind::color}};
  ImageLoss loss{sights, image, use, {}};

  ImageLimits limits(TextureFormat format, int half_octaves = 4, double most_bytes = 1e9) const {
    return {use, format, 64, 64, half_octaves, most_bytes};
  }
  std::vector<ImageWay> ways(const ImageLimits& limits, std::span<const AtlasFace> shown = {}) const {
    return image_ways(image, limits, shown, loss, {});
  }
};

TEST_F(ImageWays, AreWhatTheyWouldBeAsFiles) {
  for (const ImageWay& way : ways(limits(TextureFormat::webp))) {
    const Image8 small = way.width == 64 ? image
                                         : resized(image, way.width, way.height, use.meaning, use.wrap_u,
                                                   use.wrap_v, {});
    const EncodedTexture file = encode_at(small, way.file->format, way.file->quality, Content::colors);
    EXPECT_EQ(way.bytes, static_cast<double>(file.bytes.size()));
    EXPECT_EQ(way.psnr_db, file.psnr_db);
  }
}

TEST_F(ImageWays, AreOfEachSizeWithoutLossToo) {
  std::vector<int> widths;
  for (const ImageWay& way : ways(limits(TextureFormat::png))) {
    widths.push_back(way.width);
    EXPECT_EQ(way.file->quality, 0);
    EXPECT_EQ(way.losses[0] == 0, way.width == 64);
  }
  EXPECT_THAT(widths, testing::ElementsAre(16, 23, 32, 45, 64));
}

TEST_F(ImageWays, NoneTakesTooManyBytesButTheSmallestOfAll) {
  for (const ImageWay& way : ways(limits(TextureFormat::jpeg, 4, 2000))) EXPECT_LT(way.bytes, 2000);
  EXPECT_THAT(ways(limits(TextureFormat::jpeg, 4, 10)), testing::SizeIs(1));
}

TEST_F(ImageWays, AreFilledBetweenTrianglesAndAsTheyAre) {
  // Triangles in the left half only.
  for (AtlasFace& face : faces)
    for (Vec2d& uv : face.uv) uv.x *= 0.5;
  const auto filled = [](const ImageWay& way) { return way.file->fill; };
  const std::vector<ImageWay> found = ways(limits(TextureFormat::png, 2), faces);
  EXPECT_EQ(std::ranges::count_if(found, filled), 2);  // at its own size nothing is filled
  EXPECT_EQ(found.size(), 5u);
}

TEST_F(ImageWays, FinerOnesAreOfOtherQualities) {
  const ImageLimits asked = limits(TextureFormat::jpeg);
  const std::vector<ImageWay> coarse = ways(asked),
                              fine = finer_ways(coarse, 3000, image, asked, {}, loss, {});
  EXPECT_FALSE(fine.empty());
  for (const ImageWay& way : fine) {
    EXPECT_TRUE(std::ranges::none_of(coarse, [&](const ImageWay& other) {
      return other.width == way.width && other.file == way.file;
    }));
  }
}

}  // namespace
}  // namespace fovea
