#include "fovea/texture/encode.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "fovea/base/random.h"
#include "fovea/io/image_codec.h"
#include "fovea/model/image_error.h"
#include "support/pictures.h"

namespace fovea {
namespace {

constexpr double kNoLoss = std::numeric_limits<double>::infinity();

Image8 two_toned(int width, int height) {
  Image8 image(width, height, 3, ColorEncoding::srgb);
  for (std::size_t i = 0; i < image.pixels.size(); ++i) image.pixels[i] = i % 3 == 0 ? 200 : 30;
  return image;
}

class EncodeToPsnr : public ::testing::TestWithParam<TextureFormat> {};

TEST_P(EncodeToPsnr, IsAsNearAsAskedAndSaysHowNear) {
  const Image8 image = test::pattern(300, 200);
  for (const double wanted : {25.0, 35.0, 42.0}) {
    const EncodedTexture found = encode_to_psnr(image, GetParam(), wanted, Content::data);
    EXPECT_EQ(image_info(found.bytes).mime_type, mime_type(GetParam()));
    EXPECT_GE(found.psnr_db, wanted);
    const double measured = psnr(mean_squared_error(image, decode_image(found.bytes)));
    EXPECT_DOUBLE_EQ(found.psnr_db, measured);
  }
}

INSTANTIATE_TEST_SUITE_P(Formats, EncodeToPsnr,
                         ::testing::Values(TextureFormat::png, TextureFormat::jpeg, TextureFormat::webp));

TEST(EncodeToPsnr, IsTheLowestQualityThatIsNearEnough) {
  const Image8 image = test::pattern(300, 200);
  const EncodedTexture found = encode_to_psnr(image, TextureFormat::jpeg, 35, Content::data);
  ASSERT_GT(found.quality, 1);
  EXPECT_LT(psnr(mean_squared_error(image, decode_image(encode_jpeg(image, found.quality - 1)))), 35);
}

TEST(EncodeToPsnr, LargeImagesAreMeasuredWhole) {
  const Image8 image = test::pattern(1500, 700);
  const EncodedTexture found = encode_to_psnr(image, TextureFormat::jpeg, 38, Content::data);
  EXPECT_GE(found.psnr_db, 38);
  EXPECT_DOUBLE_EQ(found.psnr_db, psnr(mean_squared_error(image, decode_image(found.bytes))));
}

// WebP halves the resolution of colours whatever its quality.
TEST(EncodeToPsnr, WhatNoQualityReachesIsStoredWithoutLoss) {
  const Image8 image = test::pattern(64, 64);
  const EncodedTexture found = encode_to_psnr(image, TextureFormat::webp, 60, Content::data);
  EXPECT_EQ(found.quality, 0);
  EXPECT_EQ(decode_image(found.bytes).pixels, image.pixels);
  EXPECT_EQ(encode_to_psnr(image, TextureFormat::webp, kNoLoss, Content::data).psnr_db, kNoLoss);
  EXPECT_EQ(encode_to_psnr(image, TextureFormat::jpeg, kNoLoss, Content::data).quality, 100);
}

TEST(EncodeToPsnr, EvenColorsAreSmallerWithoutLoss) {
  const EncodedTexture found = encode_to_psnr(two_toned(800, 600), TextureFormat::webp, 40, Content::data);
  EXPECT_EQ(found.quality, 0);
  EXPECT_EQ(decode_image(found.bytes).pixels, two_toned(800, 600).pixels);
}

TEST(EncodeToPsnr, AlphaAndGreyComeThrough) {
  for (const int channels : {1, 2, 4}) {
    Image8 image(40, 30, channels, ColorEncoding::srgb);
    for (std::size_t i = 0; i < image.pixels.size(); ++i)
      image.pixels[i] = static_cast<std::uint8_t>(i * 7 / static_cast<std::size_t>(channels) % 256);
    for (const TextureFormat format : {TextureFormat::png, TextureFormat::webp})
      EXPECT_GE(encode_to_psnr(image, format, 30, Content::data).psnr_db, 30) << channels;
  }
}

// What a person sees least, a difference of colour alone, counts least.
TEST(EncodingPsnr, ColorsAreBrightnessMostly) {
  Image8 grey(8, 8, 3, ColorEncoding::srgb), brighter = grey, bluer = grey;
  for (std::size_t i = 0; i < grey.pixels.size(); ++i) {
    grey.pixels[i] = 100;
    brighter.pixels[i] = 110;
    bluer.pixels[i] = i % 3 == 2 ? 110 : 100;
  }
  EXPECT_NEAR(encoding_psnr(grey, brighter, Content::colors), psnr(100 * 6 / 8.0), 1e-9);
  EXPECT_GT(encoding_psnr(grey, bluer, Content::colors), encoding_psnr(grey, brighter, Content::colors) + 5);
  EXPECT_DOUBLE_EQ(encoding_psnr(grey, brighter, Content::data), psnr(100));
  EXPECT_EQ(encoding_psnr(grey, grey, Content::colors), kNoLoss);
}

/// Black, but for a square of thin coloured lines.
Image8 lines(int side) {
  Image8 image(side, side, 3, ColorEncoding::srgb);
  for (int y = 32; y < 48; ++y) {
    for (int x = 32; x < 48; ++x) {
      if (x % 4 == 0) image.at(x, y)[1] = 200;
      if (y % 5 == 0) image.at(x, y)[2] = 180;
    }
  }
  return image;
}

TEST(EncodingPsnr, WhatIsBlackAllAroundCountsAsIfItWereNot) {
  const Image8 small = lines(48), large = lines(480);
  Image8 worse = small, large_worse = large;
  for (int y = 32; y < 48; ++y) {
    for (int x = 32; x < 48; ++x) worse.at(x, y)[1] = large_worse.at(x, y)[1] = 30;
  }
  const double found = encoding_psnr(large, large_worse, Content::colors);
  EXPECT_DOUBLE_EQ(found, encoding_psnr(small, worse, Content::colors));
  const double whole = psnr(mean_squared_error(large, large_worse));
  EXPECT_LT(found, whole - 15);
}

TEST(EncodeToPsnr, ThinLinesKeepTheirColors) {
  const Image8 image = lines(256);
  const EncodedTexture found = encode_to_psnr(image, TextureFormat::webp, 40, Content::colors);
  const Image8 decoded = decode_image(found.bytes);
  EXPECT_GE(found.psnr_db, 40);
  for (int y = 33; y < 35; ++y) EXPECT_NEAR(decoded.at(36, y)[1], 200, 40);
}

TEST(EncodeToPsnr, LargeImagesWithLittleInThemAreFoundToBeNearEnough) {
  const EncodedTexture found = encode_to_psnr(lines(1200), TextureFormat::jpeg, 35, Content::colors);
  EXPECT_GE(found.psnr_db, 35);
  EXPECT_GT(found.quality, 1);
}

TEST(EncodeToPsnr, OneTexel) {
  for (const TextureFormat format : {TextureFormat::png, TextureFormat::jpeg, TextureFormat::webp})
    EXPECT_FALSE(encode_to_psnr(two_toned(1, 1), format, 40, Content::data).bytes.empty());
}

TEST(EncodingPsnr, LooksAtWhatCounts) {
  // Noise nobody sees on the left does not ask for quality on the right.
  Random random(3);
  Image8 image(512, 256, 3, ColorEncoding::srgb);
  std::vector<std::uint8_t> right(std::size_t{512} * 256, 0);
  for (int y = 0; y < 256; ++y) {
    for (int x = 0; x < 512; ++x) {
      right[static_cast<std::size_t>(512 * y + x)] = x >= 256 ? 1 : 0;
      for (int k = 0; k < 3; ++k)
        image.at(x, y)[k] =
            static_cast<std::uint8_t>(x < 256 ? 255 * random.uniform() : 100 + 50 * std::sin(0.05 * (x + y)));
    }
  }
  const EncodedTexture all = encode_to_psnr(image, TextureFormat::jpeg, 40, Content::colors),
                       some = encode_to_psnr(image, TextureFormat::jpeg, 40, Content::colors, right);
  EXPECT_GE(some.psnr_db, 40);
  EXPECT_LT(some.bytes.size(), all.bytes.size() / 2);
  const Image8 decoded = decode_image(some.bytes);
  EXPECT_GE(encoding_psnr(image, decoded, Content::colors, right), 40);
  EXPECT_LT(encoding_psnr(image, decoded, Content::colors), 35);
  // Nothing that counts is no reason to be bad.
  const std::vector<std::uint8_t> none(right.size(), 0);
  EXPECT_EQ(encoding_psnr(image, decoded, Content::colors, none),
            encoding_psnr(image, decoded, Content::colors));
}

}  // namespace
}  // namespace fovea
