#include "fovea/render/scan_convert.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <utility>

#include "fovea/base/random.h"

namespace fovea {
namespace {

using Corners = std::array<ScreenVertex, 3>;

/// Nearness of a triangle in samples of the grid.
std::map<std::pair<int, int>, float> drawn(const Corners& v, const SampleRect& rect) {
  std::map<std::pair<int, int>, float> samples;
  for_spans(v, rect, [&](int y, int x0, int x1, const NearnessPlane& plane) {
    plane.for_row(y, x0, x1, [&](int x, float nearness) {
      const bool is_new = samples.try_emplace({rect.left + x, rect.top + y}, nearness).second;
      EXPECT_TRUE(is_new && x >= 0 && x < rect.width && y >= 0 && y < rect.height);
    });
  });
  return samples;
}

bool contains(const SampleRect& rect, std::pair<int, int> sample) {
  return sample.first >= rect.left && sample.first < rect.left + rect.width && sample.second >= rect.top &&
         sample.second < rect.top + rect.height;
}

/// Corners are on and off the picture, on whole and half samples too.
Corners any_triangle(Random& random, int size) {
  const std::int32_t step = random.below(2) == 0 ? 1 : kSubsamples / 2;
  const auto place = [&] {
    const auto at =
        static_cast<std::int32_t>(random.below(static_cast<std::uint32_t>(3 * size * kSubsamples)));
    return (at - size * kSubsamples) / step * step;
  };
  Corners v;
  for (ScreenVertex& c : v) c = {place(), place(), static_cast<float>(random.uniform(1, 2))};
  return v;
}

TEST(ScanConvert, APartOfThePictureHasTheSamplesThatTheWholeHasThere) {
  constexpr int kSize = 40;
  Random random(51);
  for (int i = 0; i < 500; ++i) {
    const Corners v = any_triangle(random, kSize);
    const auto whole = drawn(v, {0, 0, kSize, kSize});
    // Narrow parts are tried sample by sample, wide ones are cut by the edges.
    const auto below = [&](int n) { return static_cast<int>(random.below(static_cast<std::uint32_t>(n))); };
    const int left = below(kSize), top = below(kSize);
    const SampleRect part{left, top, 1 + below(kSize - left), 1 + below(kSize - top)};
    const auto samples = drawn(v, part);
    std::size_t expected = 0;
    for (const auto& [sample, nearness] : whole) {
      if (!contains(part, sample)) continue;
      ++expected;
      ASSERT_TRUE(samples.contains(sample)) << sample.first << ", " << sample.second;
    }
    EXPECT_EQ(samples.size(), expected);
  }
}

TEST(ScanConvert, NearnessIsNeverBeyondThatOfTheCorners) {
  Random random(52);
  for (int i = 0; i < 500; ++i) {
    const Corners v = any_triangle(random, 40);
    const auto [low, high] = std::minmax({v[0].nearness, v[1].nearness, v[2].nearness});
    for (const auto& [sample, nearness] : drawn(v, {0, 0, 40, 40})) {
      EXPECT_GE(nearness, low);
      EXPECT_LE(nearness, high);
    }
  }
}

TEST(ScanConvert, TheWindingDoesNotMatter) {
  Random random(53);
  for (int i = 0; i < 200; ++i) {
    const Corners v = any_triangle(random, 20);
    EXPECT_EQ(drawn(v, {0, 0, 20, 20}), drawn({v[0], v[2], v[1]}, {0, 0, 20, 20}));
  }
}

}  // namespace
}  // namespace fovea
