#include "fovea/io/triangulate.h"

#include <gtest/gtest.h>

#include <cmath>

namespace fovea {
namespace {

/// Sum of the signed areas of the triangles, and of their sizes; equal if none is flipped.
struct Areas {
  double signed_sum = 0, size_sum = 0;
};

Areas areas(const std::vector<Vec3f>& polygon, std::span<const std::array<std::uint32_t, 3>> triangles,
            Vec3d up) {
  Areas result;
  for (const auto& t : triangles) {
    const Vec3d a(polygon[t[0]]), b(polygon[t[1]]), c(polygon[t[2]]);
    const double area = dot(cross(b - a, c - a), up) / 2;
    result.signed_sum += area;
    result.size_sum += std::abs(area);
  }
  return result;
}

TEST(Triangulate, FewerThanThreeCornersGiveNothing) {
  Triangulator triangulator;
  EXPECT_TRUE(triangulator.run({}).empty());
  const std::vector<Vec3f> two = {{0, 0, 0}, {1, 0, 0}};
  EXPECT_TRUE(triangulator.run(two).empty());
}

TEST(Triangulate, TriangleStaysAsItIs) {
  Triangulator triangulator;
  const std::vector<Vec3f> polygon = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  const auto triangles = triangulator.run(polygon);
  ASSERT_EQ(triangles.size(), 1u);
  EXPECT_EQ(triangles[0], (std::array<std::uint32_t, 3>{0, 1, 2}));
}

//      2
//     /|        The dent is at 3: the diagonal must be 1-3, not 0-2.
//    / 3 .
//   0------1
TEST(Triangulate, ConcaveQuadIsCutAtItsDent) {
  const std::vector<Vec3f> corners = {{0, 0, 0}, {4, 0, 0}, {1, 4, 0}, {1, 1, 0}};
  Triangulator triangulator;
  for (std::size_t turn = 0; turn < 4; ++turn) {  // wherever the polygon begins
    std::vector<Vec3f> polygon;
    for (std::size_t i = 0; i < 4; ++i) polygon.push_back(corners[(i + turn) % 4]);
    const Areas a = areas(polygon, triangulator.run(polygon), {0, 0, 1});
    EXPECT_DOUBLE_EQ(a.signed_sum, a.size_sum) << "beginning at " << turn;
    EXPECT_DOUBLE_EQ(a.signed_sum, 6.5);
  }
}

TEST(Triangulate, CombIsCoveredOnceWithoutFlips) {
  // A comb with 20 teeth in the plane x = 0. Where teeth meet the corner is there twice, and all those
  // corners lie on one line.
  std::vector<Vec3f> polygon = {{0, 0, -1}, {0, 40, -1}};
  for (int tooth = 19; tooth >= 0; --tooth) {
    const auto y = static_cast<float>(2 * tooth);
    polygon.insert(polygon.end(), {{0, y + 2, 0}, {0, y + 1.5f, 5}, {0, y + 0.5f, 5}, {0, y, 0}});
  }
  // The base is 40 × 1; each tooth has parallel sides of 2 and 1, and height 5.
  const double expected = 40 * 1 + 20 * (2 + 1) / 2.0 * 5;
  Triangulator triangulator;
  const auto triangles = triangulator.run(polygon);
  EXPECT_EQ(triangles.size(), polygon.size() - 2);
  const Areas a = areas(polygon, triangles, {1, 0, 0});
  EXPECT_NEAR(a.size_sum, expected, 1e-9);
  EXPECT_NEAR(std::abs(a.signed_sum), expected, 1e-9);
}

TEST(Triangulate, KeepsTheWinding) {
  const std::vector<Vec3f> polygon = {{0, 0, 0}, {0, 2, 0}, {1, 1, 0}, {2, 2, 0}, {2, 0, 0}};  // clockwise
  Triangulator triangulator;
  EXPECT_DOUBLE_EQ(areas(polygon, triangulator.run(polygon), {0, 0, 1}).signed_sum, -3.0);
}

TEST(Triangulate, PolygonsWithoutAreaStillGiveTheirTriangles) {
  const std::vector<Vec3f> line = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {3, 0, 0}, {1, 0, 0}};
  const std::vector<Vec3f> crossed = {{0, 0, 0}, {2, 2, 0}, {2, 0, 0}, {0, 2, 0}, {1, 5, 0}};
  Triangulator triangulator;
  EXPECT_EQ(triangulator.run(line).size(), 3u);
  EXPECT_EQ(triangulator.run(crossed).size(), 3u);
}

TEST(Triangulate, VeryLargePolygonsStayLinear) {
  // A star with 200 000 corners would take 10¹⁰ steps ear by ear: the test would run into its time limit.
  std::vector<Vec3f> star;
  for (int i = 0; i < 200'000; ++i) {
    const double angle = 2 * 3.14159265358979 * i / 200'000, radius = i % 2 ? 1.0 : 2.0;
    star.emplace_back(static_cast<float>(radius * std::cos(angle)),
                      static_cast<float>(radius * std::sin(angle)), 0.0f);
  }
  Triangulator triangulator;
  EXPECT_EQ(triangulator.run(star).size(), star.size() - 2);
}

}  // namespace
}  // namespace fovea
