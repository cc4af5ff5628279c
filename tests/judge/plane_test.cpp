#include "fovea/judge/plane.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace fovea {
namespace {

Plane numbers(int width, int height) {
  Plane plane(width, height);
  for (std::size_t i = 0; i < plane.values.size(); ++i)
    plane.values[i] = static_cast<float>((7 * i * i + 3 * i) % 31);
  return plane;
}

TEST(Plane, GaussianKernelsAddUpToOne) {
  const std::vector<float> kernel = gaussian_kernel(1.5, 5);
  ASSERT_EQ(kernel.size(), 11u);
  float sum = 0;
  for (const float w : kernel) sum += w;
  EXPECT_NEAR(sum, 1, 1e-6);
  EXPECT_NEAR(kernel[5] / kernel[6], std::exp(1 / (2 * 1.5 * 1.5)), 1e-5);
  EXPECT_EQ(kernel[2], kernel[8]);
}

TEST(Plane, FiltersAsTheSumOverTheWindow) {
  const Plane plane = numbers(9, 7);
  const std::vector<float> kx{1, 2, 4}, ky{3, 5, 7, 11, 13};
  for (const Border border : {Border::crop, Border::replicate}) {
    const Plane out = filter(plane, kx, ky, border);
    const int sx = border == Border::crop ? 1 : 0, sy = border == Border::crop ? 2 : 0;
    ASSERT_EQ(out.width, 9 - 2 * sx);
    ASSERT_EQ(out.height, 7 - 2 * sy);
    for (int y = 0; y < out.height; ++y) {
      for (int x = 0; x < out.width; ++x) {
        float expected = 0;
        for (int j = 0; j < 5; ++j) {
          for (int i = 0; i < 3; ++i) {
            const int from_x = std::clamp(x + sx + i - 1, 0, 8), from_y = std::clamp(y + sy + j - 2, 0, 6);
            expected +=
                kx[static_cast<std::size_t>(i)] * ky[static_cast<std::size_t>(j)] * plane.row(from_y)[from_x];
          }
        }
        EXPECT_FLOAT_EQ(out.row(y)[x], expected);
      }
    }
  }
}

TEST(Plane, HalvingTakesMeansAndDropsTheOddLast) {
  const Plane plane = numbers(5, 4), half = halved(plane);
  ASSERT_EQ(half.width, 2);
  ASSERT_EQ(half.height, 2);
  EXPECT_FLOAT_EQ(half.row(1)[1],
                  (plane.row(2)[2] + plane.row(2)[3] + plane.row(3)[2] + plane.row(3)[3]) / 4);
}

TEST(Plane, MeansCountOnlyTheMask) {
  Plane plane(3, 1), mask(3, 1);
  plane.values = {1, 10, 100};
  mask.values = {1, 0, 0.25f};
  EXPECT_DOUBLE_EQ(mean(plane), 37);
  EXPECT_DOUBLE_EQ(mean(plane, &mask), 50.5);
  mask.values = {0, 0, 0};
  EXPECT_DOUBLE_EQ(mean(plane, &mask), 0);
}

TEST(Plane, LumaOfGreyIsGrey) {
  Image8 grey(1, 1, 3, ColorEncoding::srgb), one(1, 1, 1, ColorEncoding::srgb);
  grey.pixels = {100, 100, 100};
  one.pixels = {100};
  EXPECT_NEAR(luma(grey).values[0], 100, 1e-4);
  EXPECT_EQ(luma(one).values[0], 100);
}

}  // namespace
}  // namespace fovea
