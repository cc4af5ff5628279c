#include "fovea/sample/paint.h"

#include <gtest/gtest.h>

#include <cmath>

namespace fovea::sample {
namespace {

TEST(Paint, ColoursByTexelCentreWithTUpwards) {
  Image8 image(4, 2, 3, ColorEncoding::srgb);
  Context context;
  paint(image, {0, 0, 4, 2}, 0, context, [](double s, double t) { return Color{s, t, 0}; });
  EXPECT_EQ(image.at(0, 0)[0], 32) << "s = 1/8";
  EXPECT_EQ(image.at(3, 0)[0], 223) << "s = 7/8";
  EXPECT_EQ(image.at(0, 0)[1], 191) << "t = 3/4 in the upper row";
  EXPECT_EQ(image.at(0, 1)[1], 64);
}

TEST(Paint, FillsTheGutterAndNothingElse) {
  Image8 image(10, 10, 3, ColorEncoding::srgb);
  Context context;
  paint(image, {4, 4, 2, 2}, 1, context, [](double, double) { return Color{1, 1, 1}; });
  int white = 0;
  for (int y = 0; y < 10; ++y) {
    for (int x = 0; x < 10; ++x) white += image.at(x, y)[0] == 255;
  }
  EXPECT_EQ(white, 16);
  EXPECT_EQ(image.at(3, 3)[0], 255);
  EXPECT_EQ(image.at(2, 3)[0], 0);
}

TEST(Paint, ChartsBeyondTheImageAreCut) {
  Image8 image(4, 4, 3, ColorEncoding::srgb);
  Context context;
  paint(image, {-10, -10, 30, 30}, 5, context, [](double, double) { return Color{2, -1, 0.5}; });
  EXPECT_EQ(image.at(3, 3)[0], 255) << "colours are clamped";
  EXPECT_EQ(image.at(3, 3)[1], 0);
}

TEST(Chart, UvRunsFromItsLowerLeftCorner) {
  const Chart chart{100, 200, 50, 40};
  const Vec2d low = chart.uv(0, 0, 1000, 1000), high = chart.uv(1, 1, 1000, 1000);
  EXPECT_DOUBLE_EQ(low.x, 0.1);
  EXPECT_DOUBLE_EQ(low.y, 0.24);
  EXPECT_DOUBLE_EQ(high.x, 0.15);
  EXPECT_DOUBLE_EQ(high.y, 0.2);
}

TEST(Figure, DistanceToATaperedStroke) {
  Figure figure;
  add_line(figure, {{{0, 0}, 1}, {{10, 0}, 2}});
  EXPECT_DOUBLE_EQ(figure.distance({-3, 0}), 2);
  EXPECT_DOUBLE_EQ(figure.distance({15, 0}), 3);
  EXPECT_DOUBLE_EQ(figure.distance({5, 4}), 2.5);
  EXPECT_LT(figure.distance({5, 0}), 0);
}

TEST(Figure, SofteningOnlyAdds) {
  Figure hard, soft;
  for (Figure* f : {&hard, &soft}) add_line(*f, {{{-1, 0}, 0.2}, {{0, 0}, 0.2}, {{0, 1}, 0.2}});
  soft.softness = 0.1;
  for (double x = -1.5; x < 1; x += 0.1) {
    const double filled = hard.distance({x, 0.3}) - soft.distance({x, 0.3});
    // Equal but for rounding far from the corner; a quarter of the softness at most in it.
    EXPECT_GE(filled, -1e-12);
    EXPECT_LE(filled, 0.025 + 1e-12);
  }
}

TEST(SmoothStep, RisesAndFalls) {
  EXPECT_EQ(smooth_step(0, 1, -1), 0.0);
  EXPECT_EQ(smooth_step(0, 1, 0.5), 0.5);
  EXPECT_EQ(smooth_step(0, 1, 2), 1.0);
  EXPECT_EQ(smooth_step(1, 0, 2), 0.0);
}

}  // namespace
}  // namespace fovea::sample
