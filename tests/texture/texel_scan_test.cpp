#include "fovea/texture/texel_scan.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include "fovea/base/random.h"

namespace fovea {
namespace {

TEST(TexelScan, ASquareOfTwoTrianglesHasEachTexelOnce) {
  Random random(3);
  for (int n = 0; n < 200; ++n) {
    std::array<Vec2d, 4> p;  // a convex quadrangle around (10, 10)
    for (std::size_t k = 0; k < 4; ++k) {
      const double angle = 1.5708 * (static_cast<double>(k) + random.uniform(0.05, 0.95));
      p[k] = {10 + 8 * std::cos(angle), 10 + 8 * std::sin(angle)};
      if (n % 2 == 0) p[k] = {std::round(2 * p[k].x) / 2, std::round(2 * p[k].y) / 2};
    }
    const auto texels = [&](std::array<Vec2d, 3> triangle) {
      std::vector<std::pair<std::int64_t, std::int64_t>> found;
      for_texel_rows(triangle, 1, [&](std::int64_t y, std::int64_t begin, std::int64_t end) {
        for (std::int64_t x = begin; x < end; ++x) found.push_back({x, y});
      });
      return found;
    };
    const auto both = [&](std::array<Vec2d, 3> a, std::array<Vec2d, 3> b) {
      auto all = texels(a);
      for (const auto& texel : texels(b)) all.push_back(texel);
      std::sort(all.begin(), all.end());
      EXPECT_EQ(std::adjacent_find(all.begin(), all.end()), all.end());
      return all;
    };
    EXPECT_EQ(both({p[0], p[1], p[2]}, {p[0], p[2], p[3]}), both({p[3], p[1], p[0]}, {p[3], p[1], p[2]}));
  }
}

TEST(TexelScan, StepsMeetOnlyTheirMultiples) {
  std::size_t count = 0;
  for_texel_rows({Vec2d{-30, -30}, Vec2d{30, -30}, Vec2d{-30, 30}}, 7,
                 [&](std::int64_t y, std::int64_t begin, std::int64_t end) {
                   EXPECT_EQ(y % 7, 0);
                   EXPECT_EQ(begin % 7, 0);
                   EXPECT_LE(begin, end);
                   ++count;
                 });
  EXPECT_EQ(count, 8u);  // −28 … 21
}

}  // namespace
}  // namespace fovea
