#include "fovea/sample/sheet.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "support/meshes.h"

namespace fovea::sample {
namespace {

/// Cone with its tip at row `rows`: the last row is one point.
Sheet cone(int columns, int rows) {
  Sheet sheet;
  sheet.columns = columns;
  sheet.rows = rows;
  sheet.position = [=](int column, int row) {
    const double angle = 2 * std::numbers::pi * (column % columns) / columns;
    const double radius = 1 - static_cast<double>(row) / rows;
    return Vec3d{radius * std::cos(angle), radius * std::sin(angle), static_cast<double>(row)};
  };
  sheet.uv = [=](int column, int row) {
    return Vec2d{static_cast<double>(column) / columns, static_cast<double>(row) / rows};
  };
  return sheet;
}

TEST(Sheet, APoleIsAFan) {
  SplitPart part = make_part(3);
  EXPECT_EQ(add_sheet(part, cone(8, 4)), 0u);
  EXPECT_EQ(part.part.material, 3);
  EXPECT_EQ(part.positions.size(), 45u);
  EXPECT_EQ(part.indices.size() / 3, 8u * (2 * 3 + 1));
}

TEST(Sheet, ASecondOneIsAppended) {
  SplitPart part = make_part(0);
  add_sheet(part, cone(8, 4));
  EXPECT_EQ(add_sheet(part, cone(5, 2)), 45u);
  EXPECT_EQ(find_attribute(part, Semantic::uv)->values.size(), 2 * part.positions.size());
  EXPECT_EQ(test::weld_part(part).face_count(), 8u * 7 + 5u * 3);
}

TEST(Sheet, NormalsAreTheSameOnBothSidesOfASeam) {
  SplitPart part = make_part(0);
  add_sheet(part, cone(8, 4));
  add_normals(part);
  const std::vector<float>& normals = find_attribute(part, Semantic::normal)->values;
  for (std::size_t row = 0; row < 4; ++row) {
    const std::size_t first = row * 9, last = row * 9 + 8;
    EXPECT_EQ(part.positions[first], part.positions[last]);
    for (std::size_t k = 0; k < 3; ++k) EXPECT_EQ(normals[3 * first + k], normals[3 * last + k]);
    EXPECT_GT(normals[3 * first], 0.0f) << "outwards";
  }
  EXPECT_EQ(find_attribute(part, Semantic::tangent), nullptr);
}

TEST(Sheet, ScaledGrowsWithTheRootAndHasAFloor) {
  EXPECT_EQ(scaled(100, 1), 100);
  EXPECT_EQ(scaled(100, 4), 200);
  EXPECT_EQ(scaled(100, 0.0001), 4);
}

}  // namespace
}  // namespace fovea::sample
