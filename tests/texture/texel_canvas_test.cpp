#include "fovea/texture/texel_canvas.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace fovea {
namespace {

using Weights = std::array<double, 3>;

float larger(float a, float b) { return std::max(a, b); }

TEST(Barycentric, IsOneAtItsCorner) {
  const std::array<Vec2d, 3> triangle{{{1, 1}, {5, 2}, {2, 7}}};
  const Barycentric barycentric(triangle);
  for (std::size_t k = 0; k < 3; ++k) {
    const Weights weights = barycentric.at(triangle[k]);
    for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(weights[i], i == k ? 1 : 0, 1e-12);
  }
  const Weights outside = clamped(barycentric.at({0, 0}));
  for (const double w : outside) EXPECT_GE(w, 0);
  EXPECT_NEAR(outside[0] + outside[1] + outside[2], 1, 1e-12);
}

TEST(Barycentric, WithoutAreaAllIsAtTheFirstCorner) {
  const Barycentric barycentric({{{1, 1}, {2, 2}, {3, 3}}});
  EXPECT_EQ(barycentric.at({2, 2}), (Weights{1, 0, 0}));
}

TEST(TexelCanvas, DrawsALinearFunctionAtTexelCentres) {
  TexelCanvas<float> canvas(8, 8);
  const std::array<Vec2d, 3> triangle{{{0, 0}, {8, 0}, {0, 8}}};
  const auto x_of = [](const Weights& w) { return static_cast<float>(8 * w[1]); };
  canvas.draw(triangle, {}, x_of, larger);
  for (int y = 0; y < 8; ++y) {
    for (int x = 0; x < 8; ++x) {
      EXPECT_EQ(canvas.is_drawn(x, y), x + y + 1 < 8) << x << ' ' << y;
      if (canvas.is_drawn(x, y)) {
        EXPECT_NEAR(canvas.at(x, y), static_cast<float>(x) + 0.5f, 1e-5f);
      }
    }
  }
}

TEST(TexelCanvas, MergesWhatComesTogetherAndWrapsWhatLiesOutside) {
  TexelCanvas<float> canvas(4, 4);
  Sampler sampler;
  const std::array<Vec2d, 3> triangle{{{0, 0}, {4, 0}, {0, 4}}};
  const std::array<Vec2d, 3> beyond{{{4, 4}, {8, 4}, {4, 8}}};
  canvas.draw(
      triangle, sampler, [](const Weights&) { return 2.0f; }, larger);
  canvas.draw(
      beyond, sampler, [](const Weights&) { return 1.0f; }, larger);
  EXPECT_EQ(canvas.at(0, 0), 2);
  canvas.draw(
      beyond, sampler, [](const Weights&) { return 3.0f; }, larger);
  EXPECT_EQ(canvas.at(0, 0), 3);
}

TEST(TexelCanvas, SmallTrianglesLeaveAMarkAndGuttersGrow) {
  TexelCanvas<int> canvas(9, 9);
  const auto first = [](int a, int) { return a; };
  canvas.draw(
      {{{4.1, 4.1}, {4.2, 4.1}, {4.1, 4.2}}}, {}, [](const Weights&) { return 7; }, first);
  canvas.grow(2, first);
  for (int y = 0; y < 9; ++y) {
    for (int x = 0; x < 9; ++x) {
      const bool near = std::abs(x - 4) + std::abs(y - 4) <= 2;
      EXPECT_EQ(canvas.is_drawn(x, y), near);
      EXPECT_EQ(canvas.at(x, y), near ? 7 : 0);
    }
  }
}

}  // namespace
}  // namespace fovea
