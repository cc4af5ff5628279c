#include "fovea/surface/facing_point.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "fovea/base/random.h"

namespace fovea {
namespace {

/// A square of side 2 at height z, facing up or down: two triangles.
void add_square(Surface& surface, float z, bool up) {
  const auto first = static_cast<std::uint32_t>(surface.positions.size());
  for (const auto& [x, y] : {std::pair{-1.0f, -1.0f}, {1.0f, -1.0f}, {1.0f, 1.0f}, {-1.0f, 1.0f}})
    surface.positions.emplace_back(x, y, z);
  for (std::uint32_t k : {1u, 2u}) {
    if (up) {
      surface.triangles.push_back({first, first + k, first + k + 1});
    } else {
      surface.triangles.push_back({first, first + k + 1, first + k});
    }
  }
}

FacingPoint::Query query(Vec3d point, Vec3d normal, double most) { return {point, normal, most, 0}; }

TEST(FacingPoint, TakesTheSideThatFacesTheSameWay) {
  Surface wall;
  add_square(wall, 0.01f, true);
  add_square(wall, 0, false);
  const FacingPoint tree(wall, std::vector<std::uint32_t>(4, 0));
  // Nearer to the back, and even behind it.
  for (const double z : {0.012, 0.001, -0.03}) {
    for (const auto& hit : {tree.along_normal(query({0.3, 0.1, z}, {0, 0, 1}, 1)),
                            tree.nearest(query({0.3, 0.1, z}, {0, 0, 1}, 1))}) {
      ASSERT_TRUE(hit);
      EXPECT_LT(hit->triangle, 2u);
      EXPECT_NEAR(hit->distance, std::abs(z - 0.01), 1e-8);
      EXPECT_NEAR(hit->point.x, 0.3, 1e-8);
    }
    EXPECT_GE(tree.along_normal(query({0.3, 0.1, z}, {0, 0, -1}, 1))->triangle, 2u);
  }
}

TEST(FacingPoint, FindsNothingTooFarOrOfAnotherKind) {
  Surface surface;
  add_square(surface, 0, true);
  const FacingPoint tree(surface, {3, 3});
  const FacingPoint::Query near{{0, 0.2, 0.5}, {0, 0, 1}, 0.6, 3};
  EXPECT_TRUE(tree.along_normal(near));
  EXPECT_TRUE(tree.nearest(near));
  for (const auto& [most, kind] : {std::pair{0.4, 3u}, {0.6, 2u}}) {
    const FacingPoint::Query other{near.point, near.normal, most, kind};
    EXPECT_FALSE(tree.along_normal(other));
    EXPECT_FALSE(tree.nearest(other));
  }
  // Beside it nothing is along the normal, but something is near.
  EXPECT_FALSE(tree.along_normal({{1.2, 0, 0}, {0, 0, 1}, 1, 3}));
  EXPECT_NEAR(tree.nearest({{1.2, 0, 0}, {0, 0, 1}, 1, 3})->distance, 0.2, 1e-7);
  const Surface nothing;
  EXPECT_FALSE(FacingPoint(nothing, {}).nearest(near));
  EXPECT_FALSE(FacingPoint(nothing, {}).along_normal(near));
}

TEST(FacingPoint, FindsWhatLookingAtEveryTriangleFinds) {
  Random random(6);
  Surface soup;
  for (std::uint32_t i = 0; i < 60; ++i) {
    const auto uniform = [&] { return static_cast<float>(random.uniform(-1, 1)); };
    const Vec3f middle{uniform(), uniform(), uniform()};
    for (int k = 0; k < 3; ++k)
      soup.positions.push_back(middle + Vec3f{uniform(), uniform(), uniform()} * 0.3f);
    soup.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
  }
  const FacingPoint tree(soup, std::vector<std::uint32_t>(60, 0));
  int found = 0;
  for (int i = 0; i < 200; ++i) {
    const auto point = [&] {
      return Vec3d{random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)};
    };
    const FacingPoint::Query asked{point(), normalized(point()), 0.4, 0};
    double nearest = std::numeric_limits<double>::infinity();
    for (const auto& t : soup.triangles) {
      const Vec3d a = soup.position(t[0]), b = soup.position(t[1]), c = soup.position(t[2]);
      if (!(dot(normalized(cross(b - a, c - a)), asked.normal) > 0.25)) continue;
      nearest = std::min(nearest, length(closest_on_triangle(asked.point, a, b, c).point - asked.point));
    }
    const auto hit = tree.nearest(asked);
    ASSERT_EQ(hit.has_value(), nearest <= 0.4);
    if (!hit) continue;
    ++found;
    EXPECT_NEAR(hit->distance, nearest, 1e-7);
    // What lies along the normal is no nearer.
    if (const auto along = tree.along_normal(asked)) {
      EXPECT_GE(along->distance, nearest - 1e-6);
      EXPECT_LT(length(cross(along->point - asked.point, asked.normal)), 1e-6);
    }
  }
  EXPECT_GT(found, 50);
}

TEST(FacingPoint, WorksAtAnySize) {
  for (const float size : {1e-30f, 1e-12f, 1e15f, 1e30f}) {
    const double s = static_cast<double>(size);
    Surface wall;
    add_square(wall, 0.01f, true);
    add_square(wall, 0, false);
    for (Vec3f& p : wall.positions) p = p * size;
    const FacingPoint tree(wall, std::vector<std::uint32_t>(4, 0));
    for (const auto& hit : {tree.along_normal(query({0.3 * s, 0.1 * s, 0}, {0, 0, 1}, s)),
                            tree.nearest(query({0.3 * s, 0.1 * s, 0}, {0, 0, 1}, s))}) {
      ASSERT_TRUE(hit) << size;
      EXPECT_LT(hit->triangle, 2u) << size;
      EXPECT_NEAR(hit->distance / s, 0.01, 1e-6) << size;
    }
  }
}

}  // namespace
}  // namespace fovea
