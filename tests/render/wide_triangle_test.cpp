#include "fovea/render/wide_triangle.h"

#include <gtest/gtest.h>

#include <set>
#include <utility>
#include <vector>

#include "fovea/base/random.h"

namespace fovea {
namespace {

constexpr int kSide = 61;  // the last column is not full
constexpr SampleRect kRect{0, 0, kSide, kSide};
using Corners = std::array<ScreenVertex, 3>;
using PixelSet = std::set<std::pair<int, int>>;

/// Small ones and such that are mostly off the picture; some have upright or level edges.
Corners random_triangle(Random& random) {
  const auto size = static_cast<int>(1 + random.below(3 * kSide));
  const std::int32_t steps[] = {1, kSubsamples / 2, 8 * kSubsamples}, step = steps[random.below(3)];
  const auto middle = [&] { return static_cast<int>(random.below(2 * kSide)) - kSide / 2; };
  const std::int32_t x = middle() * kSubsamples, y = middle() * kSubsamples;
  const auto near_by = [&](std::int32_t at) {
    const auto by = static_cast<std::int32_t>(random.below(static_cast<std::uint32_t>(size * kSubsamples)));
    return (at + by - size * kSubsamples / 2) / step * step;
  };
  Corners v;
  for (ScreenVertex& corner : v) corner = {near_by(x), near_by(y), 1};
  return v;
}

PixelSet by_spans(const Corners& v) {
  PixelSet samples;
  for_spans(v, kRect, [&](int y, int x0, int x1, const NearnessPlane&) {
    for (int x = x0; x < x1; ++x) samples.emplace(x, y);
  });
  return samples;
}

bool covers(const WideTriangle& triangle, int x, int y) {
  for (std::size_t k = 0; k < 3; ++k) {
    const std::uint32_t edge = triangle.a[k] * static_cast<std::uint32_t>(x) +
                               triangle.b[k] * static_cast<std::uint32_t>(y) + triangle.c[k];
    if (static_cast<std::int32_t>(edge) < 0) return false;
  }
  return true;
}

TEST(WideTriangle, CoversTheSamplesOfItsSpans) {
  Random random(61);
  for (int i = 0; i < 3000; ++i) {
    const Corners v = random_triangle(random);
    if (double_area(v) == 0) continue;
    ASSERT_TRUE(WideTriangle::fits(v));
    const WideTriangle triangle(v, kRect);
    const PixelSet expected = by_spans(v);
    PixelSet samples;
    for (int y = triangle.box.top; y < triangle.box.bottom; ++y) {
      const int left = triangle.box.left / kColumn * kColumn;
      for (int x = left; x < triangle.box.right; ++x) {
        if (covers(triangle, x, y)) samples.emplace(x, y);
      }
    }
    ASSERT_EQ(samples, expected) << i;
  }
}

TEST(WideTriangle, RowsHaveAllSamplesAndFewMore) {
  Random random(62);
  std::size_t rows_in_all = 0, needed_in_all = 0;
  for (int i = 0; i < 3000; ++i) {
    const Corners v = random_triangle(random);
    const SampleBox box = sample_box(v, kRect);
    if (double_area(v) == 0 || box.empty()) continue;
    const int first = box.left / kColumn, count = (box.right - 1) / kColumn - first + 1;
    std::vector<RowRange> rows(static_cast<std::size_t>(count)), needed(rows.size());
    find_rows(v, box, rows.data());
    for (const auto& [x, y] : by_spans(v)) {
      const auto column = static_cast<std::size_t>(x / kColumn - first);
      ASSERT_LE(rows[column].begin, y) << i;
      ASSERT_GT(rows[column].end, y) << i;
      needed[column].begin = std::min(needed[column].begin, y);
      needed[column].end = std::max(needed[column].end, y + 1);
    }
    for (std::size_t c = 0; c < rows.size(); ++c) {
      if (rows[c].empty()) continue;
      ASSERT_TRUE(rows[c].begin >= box.top && rows[c].end <= box.bottom);
      rows_in_all += static_cast<std::size_t>(rows[c].end - rows[c].begin);
      if (!needed[c].empty()) needed_in_all += static_cast<std::size_t>(needed[c].end - needed[c].begin);
    }
  }
  EXPECT_LT(static_cast<double>(rows_in_all), 1.2 * static_cast<double>(needed_in_all));
}

TEST(WideTriangle, LargeOnesDoNotFit) {
  constexpr std::int32_t kFar = 1 << 28;
  EXPECT_FALSE(WideTriangle::fits({{{-kFar, 0, 1}, {kFar, 0, 1}, {0, kFar, 1}}}));
  EXPECT_FALSE(WideTriangle::fits({{{0, 0, 1}, {1024 * kSubsamples, 0, 1}, {0, 1, 1}}}));
  EXPECT_TRUE(WideTriangle::fits({{{0, 0, 1}, {1023 * kSubsamples, 0, 1}, {0, 1, 1}}}));
}

}  // namespace
}  // namespace fovea
