#include "fovea/texture/fill.h"

#include <gtest/gtest.h>

#include <vector>

namespace fovea {
namespace {

TEST(FillUndrawn, GoesOnFromWhatIsDrawn) {
  Image8 image(9, 5, 2, ColorEncoding::srgb);
  std::vector<std::uint8_t> drawn(45, 0);
  // A column of one value on the left and one of another on the right.
  for (int y = 0; y < 5; ++y) {
    drawn[static_cast<std::size_t>(9 * y)] = drawn[static_cast<std::size_t>(9 * y + 8)] = 1;
    image.at(0, y)[0] = 100, image.at(0, y)[1] = 7;
    image.at(8, y)[0] = 200, image.at(8, y)[1] = 7;
  }
  const Image8 before = image;
  fill_undrawn(image, drawn, Context());
  for (int y = 0; y < 5; ++y) {
    EXPECT_EQ(*image.at(0, y), *before.at(0, y));
    EXPECT_EQ(*image.at(8, y), *before.at(8, y));
    EXPECT_LT(*image.at(1, y), 150) << "nearer to the left column";
    EXPECT_GT(*image.at(7, y), 150) << "nearer to the right column";
    for (int x = 0; x < 9; ++x) {
      EXPECT_GE(*image.at(x, y), 100);
      EXPECT_LE(*image.at(x, y), 200);
      EXPECT_EQ(image.at(x, y)[1], 7);
    }
  }
}

TEST(FillUndrawn, GoesOnAlongABorderAsItEnds) {
  // Stripes across the border of the drawn left half: what is beside each is like it, not like their mean.
  Image8 image(32, 32, 1, ColorEncoding::srgb);
  std::vector<std::uint8_t> drawn(32 * 32, 0);
  for (int y = 0; y < 32; ++y) {
    for (int x = 0; x < 16; ++x) {
      *image.at(x, y) = y / 8 % 2 == 0 ? 40 : 200;
      drawn[static_cast<std::size_t>(32 * y + x)] = 1;
    }
  }
  fill_undrawn(image, drawn, Context());
  for (int x = 16; x < 19; ++x) {
    for (const int y : {4, 12, 20, 28}) EXPECT_EQ(*image.at(x, y), *image.at(15, y)) << x << ' ' << y;
  }
}

TEST(GrowDrawn, TakesTheEightAround) {
  std::vector<std::uint8_t> drawn(5 * 4, 0);
  drawn[5 * 1 + 4] = 1;
  grow_drawn(drawn, 5, 4, Context());
  for (int y = 0; y < 4; ++y)
    for (int x = 0; x < 5; ++x)
      EXPECT_EQ(drawn[static_cast<std::size_t>(5 * y + x)] != 0, x >= 3 && y <= 2) << x << ' ' << y;
}

TEST(FillUndrawn, OneTexelFillsAll) {
  Image8 image(13, 1, 1, ColorEncoding::srgb);
  std::vector<std::uint8_t> drawn(13, 0);
  drawn[5] = 1;
  *image.at(5, 0) = 42;
  fill_undrawn(image, drawn, Context());
  for (int x = 0; x < 13; ++x) EXPECT_EQ(*image.at(x, 0), 42);
}

TEST(FillUndrawn, NothingDrawnOrAllDrawnChangesNothing) {
  Image8 image(3, 3, 1, ColorEncoding::srgb);
  for (std::size_t i = 0; i < 9; ++i) image.pixels[i] = static_cast<std::uint8_t>(i);
  const std::vector<std::uint8_t> before = image.pixels;
  fill_undrawn(image, std::vector<std::uint8_t>(9, 0), Context());
  EXPECT_EQ(image.pixels, before);
  fill_undrawn(image, std::vector<std::uint8_t>(9, 1), Context());
  EXPECT_EQ(image.pixels, before);
}

}  // namespace
}  // namespace fovea
