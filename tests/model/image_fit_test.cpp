#include "fovea/model/image_fit.h"

#include <gtest/gtest.h>

#include "support/pictures.h"

namespace fovea {
namespace {

Image8 constant(int width, int height, std::uint8_t value) {
  Image8 image(width, height, 1, ColorEncoding::srgb);
  image.pixels.assign(image.pixels.size(), value);
  return image;
}

TEST(ImageFit, LargeImagesAreReduced) {
  const Image8 image = test::pattern(64, 48);
  EXPECT_EQ(fitted(image, 64 * 48, Context()).width, 64);
  const Image8 half = fitted(image, 64 * 48 - 1, Context());
  ASSERT_EQ(half.width, 32);
  ASSERT_EQ(half.height, 24);
  const int sum = image.at(10, 6)[1] + image.at(11, 6)[1] + image.at(10, 7)[1] + image.at(11, 7)[1];
  EXPECT_EQ(half.at(5, 3)[1], (sum + 2) / 4);
  const Image8 line = fitted(constant(1000, 1, 7), 10, Context());
  EXPECT_LE(line.width, 10);
  EXPECT_EQ(line.height, 1);
  EXPECT_EQ(line.at(3, 0)[0], 7);
  EXPECT_EQ(fitted(constant(5, 5, 7), 0, Context()).pixels.size(), 1u);
}

}  // namespace
}  // namespace fovea
