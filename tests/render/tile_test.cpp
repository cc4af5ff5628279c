#include "fovea/render/tile.h"

#include <gtest/gtest.h>

#include <array>
#include <map>
#include <memory>

#include "fovea/base/random.h"

namespace fovea {
namespace {

ScreenTriangle triangle(std::array<std::array<std::int32_t, 2>, 3> corners, std::uint32_t id = 0,
                        std::array<float, 3> nearness = {1, 1, 1}) {
  ScreenTriangle t;
  t.triangle = id;
  for (std::size_t k = 0; k < 3; ++k) t.v[k] = {corners[k][0], corners[k][1], nearness[k]};
  return t;
}

std::array<std::int32_t, 2> random_corner(Random& random, int size) {
  return {static_cast<std::int32_t>(random.below(static_cast<std::uint32_t>(size * kSubsamples))),
          static_cast<std::int32_t>(random.below(static_cast<std::uint32_t>(size * kSubsamples)))};
}

/// The samples of a triangle in the first tile, drawn onto nothing.
std::map<std::uint32_t, int> covered(const SampleGrid& grid, const std::vector<ScreenTriangle>& triangles) {
  const auto tile = std::make_unique<TileSamples>(grid, 0, 0);
  std::vector<BlendedSample> samples;
  for (const ScreenTriangle& t : triangles) tile->blend(t, samples);
  std::map<std::uint32_t, int> counts;
  for (const BlendedSample& s : samples) ++counts[s.sample];
  return counts;
}

/// Inside by the sign of three cross products; on an edge only at the top or left. Literal and slow.
bool is_inside(const ScreenTriangle& t, std::int64_t x, std::int64_t y) {
  std::array<ScreenVertex, 3> v = t.v;
  const auto side = [](const ScreenVertex& p, const ScreenVertex& q, std::int64_t px, std::int64_t py) {
    return (std::int64_t{q.x} - p.x) * (py - p.y) - (std::int64_t{q.y} - p.y) * (px - p.x);
  };
  if (side(v[0], v[1], v[2].x, v[2].y) < 0) std::swap(v[1], v[2]);
  for (std::size_t k = 0; k < 3; ++k) {
    const ScreenVertex &p = v[k], &q = v[(k + 1) % 3];
    const std::int64_t s = side(p, q, x, y);
    const bool is_top = p.y == q.y && q.x > p.x, is_left = q.y < p.y;
    if (s < 0 || (s == 0 && !is_top && !is_left)) return false;
  }
  return side(v[0], v[1], v[2].x, v[2].y) != 0;
}

TEST(Tile, CoversWhatLiesInside) {
  Random random(5);
  for (const int size : {3, 9, 40}) {
    for (int i = 0; i < 200; ++i) {
      // Corners on whole and half samples too, so that edges run through samples.
      const std::int32_t step = i % 2 == 0 ? 1 : kSubsamples / 2;
      std::array<std::array<std::int32_t, 2>, 3> corners;
      for (auto& c : corners) {
        c = random_corner(random, size);
        for (auto& x : c) x = x / step * step;
      }
      const ScreenTriangle t = triangle(corners);
      const SampleGrid grid{size, size, 1};
      const auto counts = covered(grid, {t});
      for (int y = 0; y < size; ++y) {
        for (int x = 0; x < size; ++x) {
          const bool inside =
              is_inside(t, x * kSubsamples + kSubsamples / 2, y * kSubsamples + kSubsamples / 2);
          EXPECT_EQ(counts.count(static_cast<std::uint32_t>(y * SampleGrid::kTileSamples + x)), inside);
        }
      }
    }
  }
}

//   a---b
//   |\ /|     four triangles around a point in the middle
//   | m |
//   |/ \|
//   d---c
TEST(Tile, NeighboursCoverEachSampleOnce) {
  Random random(6);
  for (int i = 0; i < 100; ++i) {
    constexpr std::int32_t kEnd = 32 * kSubsamples;
    const std::array<std::int32_t, 2> a{0, 0}, b{kEnd, 0}, c{kEnd, kEnd}, d{0, kEnd};
    std::array<std::int32_t, 2> m = random_corner(random, 32);
    if (i % 2 == 0)
      m = {m[0] / kSubsamples * kSubsamples + kSubsamples / 2,
           m[1] / kSubsamples * kSubsamples + kSubsamples / 2};
    const auto counts = covered(
        {32, 32, 1}, {triangle({a, b, m}), triangle({b, c, m}), triangle({c, d, m}), triangle({d, a, m})});
    EXPECT_EQ(counts.size(), 32u * 32u);
    for (const auto& [sample, count] : counts) EXPECT_EQ(count, 1);
  }
}

TEST(Tile, TilesShareATriangleWithoutGapOrOverlap) {
  const SampleGrid grid{300, 200, 1};
  const ScreenTriangle t = triangle({{{-500 * kSubsamples, 100 * kSubsamples},
                                      {900 * kSubsamples, -300 * kSubsamples},
                                      {250 * kSubsamples + 77, 700 * kSubsamples}}});
  for (int row = 0; row < grid.rows(); ++row) {
    for (int column = 0; column < grid.columns(); ++column) {
      const auto tile = std::make_unique<TileSamples>(grid, column, row);
      std::vector<BlendedSample> samples;
      tile->blend(t, samples);
      std::size_t inside = 0;
      for (int y = 0; y < tile->height(); ++y) {
        for (int x = 0; x < tile->width(); ++x) {
          inside += is_inside(t, (column * 128 + x) * std::int64_t{kSubsamples} + kSubsamples / 2,
                              (row * 128 + y) * std::int64_t{kSubsamples} + kSubsamples / 2);
        }
      }
      EXPECT_EQ(samples.size(), inside);
    }
  }
}

TEST(Tile, TheNearerOfCrossingTrianglesIsSeen) {
  const SampleGrid grid{16, 16, 1};
  const auto tile = std::make_unique<TileSamples>(grid, 0, 0);
  constexpr std::int32_t kFar = 64 * kSubsamples;
  // The nearness of the first is x, that of the second 8 everywhere.
  tile->draw(triangle({{{0, -kFar}, {48 * kSubsamples, -kFar}, {0, 2 * kFar}}}, 1, {0, 48, 0}));
  tile->draw(triangle({{{-kFar, -kFar}, {3 * kFar, -kFar}, {-kFar, 3 * kFar}}}, 2, {8, 8, 8}));
  for (int x = 0; x < 16; ++x) {
    EXPECT_EQ(tile->triangle(x, 3), x < 8 ? 2u : 1u) << x;
    EXPECT_NEAR(tile->nearness(x, 3), std::max(8.0, x + 0.5), 1e-5);
  }
}

TEST(Tile, OfEquallyNearTheFirstStays) {
  const auto tile = std::make_unique<TileSamples>(SampleGrid{4, 4, 1}, 0, 0);
  const std::array<std::array<std::int32_t, 2>, 3> all{
      {{-kSubsamples * 9, -kSubsamples * 9}, {kSubsamples * 40, 0}, {0, kSubsamples * 40}}};
  tile->draw(triangle(all, 7));
  tile->draw(triangle(all, 8));
  EXPECT_EQ(tile->triangle(1, 1), 7u);
  std::vector<BlendedSample> samples;
  tile->blend(triangle(all, 9), samples);
  EXPECT_TRUE(samples.empty()) << "a blended surface on an opaque one is behind it";
}

}  // namespace
}  // namespace fovea
