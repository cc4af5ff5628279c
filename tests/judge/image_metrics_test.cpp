#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "fovea/base/error.h"
#include "fovea/judge/flip.h"
#include "fovea/judge/silhouette.h"
#include "fovea/judge/ssim.h"
#include "fovea/model/image_error.h"
#include "support/pictures.h"

namespace fovea {
namespace {

// The values below were computed for the same two pictures by programs that share no code with Fovea: PSNR
// and SSIM by scikit-image 0.19 (structural_similarity of Rec. 601 luma with Gaussian weights, truncated
// at 3.5 σ, mean over the interior), MS-SSIM by the same formula in double precision with SciPy's Gaussian
// filter, FLIP by an evaluator in JavaScript whose FLIP equals NVIDIA's own tool to 1e-6.
class ImageMetrics : public ::testing::Test {
 protected:
  Image8 image_ = test::pattern(256, 200);
  Image8 test_ = test::distorted(image_);
};

TEST_F(ImageMetrics, PsnrIsThatOfOthers) {
  EXPECT_NEAR(psnr(mean_squared_error(image_, test_)), 16.346654, 1e-6);
}

TEST_F(ImageMetrics, SsimIsThatOfOthers) {
  EXPECT_NEAR(SsimReference(image_).score(test_).ssim, 0.7225788, 1e-6);
}

TEST_F(ImageMetrics, MultiScaleSsimIsThatOfOthers) {
  EXPECT_NEAR(SsimReference(image_).score(test_).ms_ssim, 0.8858005, 1e-6);
}

TEST_F(ImageMetrics, FlipIsThatOfOthers) {
  const Plane map = FlipReference(image_).map(test_);
  EXPECT_NEAR(mean(map), 0.2507133, 1e-6);
  EXPECT_NEAR(map.row(30)[30], 0.964323, 1e-5);
  EXPECT_NEAR(map.row(150)[200], 0.194005, 1e-5);
}

TEST_F(ImageMetrics, NothingIsBetterThanTheSame) {
  EXPECT_EQ(psnr(mean_squared_error(image_, image_)), INFINITY);
  EXPECT_NEAR(SsimReference(image_).score(image_).ssim, 1, 1e-6);
  EXPECT_NEAR(SsimReference(image_).score(image_).ms_ssim, 1, 1e-6);
  EXPECT_EQ(mean(FlipReference(image_).map(image_)), 0);
}

TEST_F(ImageMetrics, DifferencesCountWhereTheMaskIs) {
  // The inverted square is at 20 … 40; elsewhere in the upper left nothing differs.
  Plane square(256, 200), clean(256, 200);
  for (int y = 0; y < 100; ++y) {
    for (int x = 0; x < 120; ++x) {
      const bool inside = x >= 20 && x < 40 && y >= 20 && y < 40;
      square.row(y)[x] = inside ? 1.0f : 0.0f;
      clean.row(y)[x] = x >= 60 && y >= 60 && y < 90 ? 1.0f : 0.0f;
    }
  }
  EXPECT_EQ(mean_squared_error(image_, test_, clean.values), 0);
  EXPECT_GT(mean_squared_error(image_, test_, square.values), 5000);
  const SsimReference ssim(image_);
  EXPECT_NEAR(ssim.score(test_, &clean).ssim_masked, 1, 1e-6);
  EXPECT_LT(ssim.score(test_, &square).ssim_masked, 0.2);
  EXPECT_GT(ssim.score(test_, &clean).ms_ssim_masked, ssim.score(test_, &square).ms_ssim_masked + 0.1);
  EXPECT_GT(mean(FlipReference(image_).map(test_), &square), 0.5);
}

TEST_F(ImageMetrics, FlipForgivesFineNoiseFromFarAway) {
  Image8 noisy = image_;
  for (int y = 0; y < noisy.height; ++y) {
    for (int x = 0; x < noisy.width; ++x) {
      for (int k = 0; k < 3; ++k) {
        const int value = noisy.at(x, y)[k] + ((x + y) % 2 == 0 ? 8 : -8);
        noisy.at(x, y)[k] = static_cast<std::uint8_t>(std::clamp(value, 0, 255));
      }
    }
  }
  const double near = mean(FlipReference(image_, 20).map(noisy)),
               far = mean(FlipReference(image_, 120).map(noisy));
  EXPECT_LT(far, 0.6 * near);
}

TEST_F(ImageMetrics, SmallImagesHaveFewerScales) {
  const Image8 small = test::pattern(40, 30), other = test::distorted(small);
  const double value = SsimReference(small).score(other).ms_ssim;
  EXPECT_GT(value, 0);
  EXPECT_LT(value, 1);
  EXPECT_THROW(SsimReference(test::pattern(10, 40)), Error);
}

TEST_F(ImageMetrics, ShapesMustAgree) {
  EXPECT_THROW(mean_squared_error(image_, test::pattern(255, 200)), Error);
  EXPECT_THROW(FlipReference(image_).map(test::pattern(255, 200)), Error);
  EXPECT_THROW(SsimReference(image_).score(test::pattern(255, 200)), Error);
  EXPECT_THROW(FlipReference(Image8(20, 20, 1, ColorEncoding::srgb)), Error);
}

TEST(Silhouette, IsTheSharedPartOfBoth) {
  Image8 a(4, 1, 1, ColorEncoding::linear), b = a;
  EXPECT_EQ(silhouette_iou(a, b), 1) << "nothing to see in both";
  a.pixels = {255, 255, 0, 0};
  b.pixels = {0, 255, 255, 0};
  EXPECT_DOUBLE_EQ(silhouette_iou(a, b), 1.0 / 3);
  b.pixels = {255, 51, 0, 0};
  EXPECT_DOUBLE_EQ(silhouette_iou(a, b), 0.6);
  EXPECT_EQ(mean(foreground(a, b)), 0.5);
}

}  // namespace
}  // namespace fovea
