#include "fovea/texture/warp.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

#include "fovea/base/error.h"
#include "fovea/base/random.h"
#include "support/reading.h"

namespace fovea {
namespace {

/// Importance by a formula of texture coordinates.
ImageF importance(int width, int height, const std::function<double(double, double)>& f) {
  ImageF image(width, height, 1, ColorEncoding::linear);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      *image.at(x, y) = static_cast<float>(f((x + 0.5) / width, (y + 0.5) / height));
  return image;
}

ImageF noise(int width, int height) {
  Random random(3);
  return importance(width, height, [&](double, double) { return std::pow(random.uniform(), 4); });
}

ImageF spot(int size) {
  return importance(size, size, [](double u, double v) {
    return std::exp(-((u - 0.4) * (u - 0.4) + (v - 0.6) * (v - 0.6)) / 0.02);
  });
}

Warp warped(const ImageF& image, const WarpOptions& options = {}, int threads = 1) {
  Context context;
  context.threads = threads;
  return warp(image, options, context);
}

/// Area in the old image of the new image's cell there, over that of a cell that nothing moved.
double area_at(const WarpGrid& grid, Vec2d target) {
  const double h = 0.25 / grid.columns();
  const Vec2d p = grid.source({target.x - h, target.y - h}), q = grid.source({target.x + h, target.y - h}),
              r = grid.source({target.x - h, target.y + h});
  return cross(q - p, r - p) / (4 * h * h);
}

TEST(WarpGrid, SourceIsTheNodesAndLinearBetween) {
  WarpGrid grid(2, 1);
  grid.set_node(1, 0, {0.7, 0});
  grid.set_node(1, 1, {0.6, 1});
  EXPECT_DOUBLE_EQ(grid.source({0.5, 0}).x, 0.7);
  EXPECT_DOUBLE_EQ(grid.source({0.5, 1}).x, 0.6);
  EXPECT_DOUBLE_EQ(grid.source({0.25, 0}).x, 0.35);
  EXPECT_DOUBLE_EQ(grid.source({0.25, 0.5}).x, 0.3);  // on the diagonal, from (0, 0) to (0.6, 1)
  EXPECT_DOUBLE_EQ(grid.source({2, -1}).x, 1);
}

TEST(InverseWarp, IsTheInverse) {
  const Warp found = warped(noise(96, 64));
  const InverseWarp inverse(found.grid);
  Random random(5);
  for (int n = 0; n < 2000; ++n) {
    const Vec2d p{random.uniform(), random.uniform()};
    const Vec2d back = inverse.target(found.grid.source(p)), forth = found.grid.source(inverse.target(p));
    EXPECT_NEAR(back.x, p.x, 1e-9);
    EXPECT_NEAR(back.y, p.y, 1e-9);
    EXPECT_NEAR(forth.x, p.x, 1e-9);
    EXPECT_NEAR(forth.y, p.y, 1e-9);
  }
}

TEST(Warp, EvenImportanceMovesNothing) {
  for (const double value : {0.0, 0.3}) {
    const Warp found = warped(importance(64, 32, [&](double, double) { return value; }));
    EXPECT_TRUE(found.settled);
    EXPECT_EQ(found.grid.columns(), 128);
    EXPECT_EQ(found.grid.rows(), 64);
    EXPECT_NEAR(found.grid.smallest_corner(), 1, 1e-9);
  }
}

// Along a line cells become as small as importance is high: σ h is the same everywhere.
TEST(Warp, RelaxationAloneSpreadsImportanceEvenly) {
  WarpOptions options;
  options.rigidity = 0;
  options.rounds = 3000;
  options.tolerance = 1e-5;
  options.cells = 32;
  options.floor = 0.2;
  const auto sigma = [](double u) { return std::exp(1.2 * u); };
  const Warp found = warped(importance(256, 256, [&](double u, double) { return sigma(u); }), options);
  EXPECT_TRUE(found.settled);
  double least = 1e9, most = 0;
  for (int i = 1; i + 1 < 32; ++i) {
    const double left = found.grid.node(i, 20).x, right = found.grid.node(i + 1, 20).x;
    const double value = 0.2 + 0.8 * sigma((left + right) / 2) / sigma(1);  // with the floor
    least = std::min(least, value * (right - left));
    most = std::max(most, value * (right - left));
  }
  // Exact to second order in a cell's size.
  EXPECT_LT(most / least, 1.05);
}

TEST(Warp, TheImportantGetsMoreOfTheImage) {
  const Warp found = warped(spot(128));
  const InverseWarp inverse(found.grid);
  EXPECT_LT(area_at(found.grid, inverse.target({0.4, 0.6})), 0.6);
  EXPECT_GT(area_at(found.grid, inverse.target({0.9, 0.1})), 1.05);
}

TEST(Warp, RigidCellsStayNearerToSquares) {
  const auto longest_over_shortest = [](const WarpGrid& grid) {
    double most = 1;
    for (int j = 1; j + 1 < grid.rows(); ++j) {
      for (int i = 1; i + 1 < grid.columns(); ++i) {
        const Vec2d a = grid.node(i, j), b = grid.node(i + 1, j), c = grid.node(i, j + 1);
        const double x = std::hypot(b.x - a.x, b.y - a.y), y = std::hypot(c.x - a.x, c.y - a.y);
        most = std::max(most, std::max(x, y) / std::min(x, y));
      }
    }
    return most;
  };
  WarpOptions free;
  free.rigidity = 0;
  EXPECT_LT(longest_over_shortest(warped(noise(64, 64)).grid),
            longest_over_shortest(warped(noise(64, 64), free).grid));
}

TEST(Warp, NoCellFoldsAndTheBorderHolds) {
  for (const double rigidity : {0.0, 0.5, 1.0}) {
    for (const ImageF& image : {noise(61, 200), noise(1, 1), noise(300, 7), spot(40)}) {
      WarpOptions options;
      options.rigidity = rigidity;
      options.floor = 0.01;
      const WarpGrid grid = warped(image, options).grid;
      EXPECT_GT(grid.smallest_corner(), 0);
      for (int i = 0; i <= grid.columns(); ++i) {
        EXPECT_EQ(grid.node(i, 0).y, 0);
        EXPECT_EQ(grid.node(i, grid.rows()).y, 1);
      }
      for (int j = 0; j <= grid.rows(); ++j) {
        EXPECT_EQ(grid.node(0, j).x, 0);
        EXPECT_EQ(grid.node(grid.columns(), j).x, 1);
      }
    }
  }
}

TEST(Warp, JoinedBordersSlideAlike) {
  WarpOptions options;
  const Warp apart = warped(noise(64, 48), options);
  options.joined_u = options.joined_v = true;
  const Warp joined = warped(noise(64, 48), options);
  EXPECT_GT(joined.grid.smallest_corner(), 0);
  double most = 0;
  for (int j = 0; j <= joined.grid.rows(); ++j) {
    EXPECT_NEAR(joined.grid.node(0, j).y, joined.grid.node(joined.grid.columns(), j).y, 1e-12);
    most = std::max(most, std::abs(apart.grid.node(0, j).y - apart.grid.node(apart.grid.columns(), j).y));
  }
  for (int i = 0; i <= joined.grid.columns(); ++i)
    EXPECT_NEAR(joined.grid.node(i, 0).x, joined.grid.node(i, joined.grid.rows()).x, 1e-12);
  EXPECT_GT(most, 1e-4);  // which they would not do by themselves
}

TEST(Warp, ThreadsDoNotMatter) {
  const WarpGrid one = warped(noise(90, 90), {}, 1).grid, four = warped(noise(90, 90), {}, 4).grid;
  for (int j = 0; j <= one.rows(); ++j)
    for (int i = 0; i <= one.columns(); ++i) EXPECT_EQ(one.node(i, j), four.node(i, j));
}

TEST(Warp, NonsenseIsRefused) {
  Context context;
  const auto with = [&](float value) {
    return [&, value] { warp(importance(4, 4, [&](double, double) { return value; }), {}, context); };
  };
  test::expect_error(with(-1), ErrorKind::usage, "");
  test::expect_error(with(std::numeric_limits<float>::quiet_NaN()), ErrorKind::usage, "");
  WarpOptions options;
  options.rigidity = 2;
  test::expect_error([&] { warp(spot(8), options, context); }, ErrorKind::usage, "");
}

}  // namespace
}  // namespace fovea
