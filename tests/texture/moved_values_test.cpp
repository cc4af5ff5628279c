#include "fovea/texture/moved_values.h"

#include <gtest/gtest.h>

#include <cmath>

#include "support/meshes.h"
#include "support/textured.h"

namespace fovea {
namespace {

/// Bent by up to `strength` of its size in waves along both axes; borders slide.
WarpGrid waves(double strength) {
  constexpr int kCells = 32;
  WarpGrid grid(kCells, kCells);
  for (int j = 0; j <= kCells; ++j) {
    for (int i = 0; i <= kCells; ++i) {
      const double x = static_cast<double>(i) / kCells, y = static_cast<double>(j) / kCells;
      grid.set_node(i, j,
                    {x + strength * std::sin(3.14159265 * x) * std::cos(5 * y),
                     y + strength * std::sin(3.14159265 * y) * std::cos(4 * x)});
    }
  }
  return grid;
}

double area(const std::array<Vec2d, 3>& t) { return cross(t[1] - t[0], t[2] - t[0]); }

std::array<Vec2d, 3> triangle(const AtlasFace& face, const std::vector<Vec2d>& at) {
  return {at[face.value[0]], at[face.value[1]], at[face.value[2]]};
}

TEST(MovedValues, FollowTheWarp) {
  const Model model = test::textured(test::grid(8, 8), 1);
  const std::vector<AtlasFace> faces = atlas_faces(model, find_atlases(model).at(0));
  const WarpGrid grid = waves(0.05);
  const auto at = moved_values(faces, InverseWarp(grid));
  ASSERT_TRUE(at);
  for (const AtlasFace& face : faces) {
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec2d back = grid.source((*at)[face.value[k]]);
      EXPECT_NEAR(back.x, face.uv[k].x, 1e-9);
      EXPECT_NEAR(back.y, face.uv[k].y, 1e-9);
    }
    EXPECT_GT(area(triangle(face, *at)) * area(face.uv), 0);
  }
}

TEST(MovedValues, ThinTrianglesDoNotTurnOver) {
  // Rows as thin as a thousandth bend farther than they are high.
  Model model = test::textured(test::grid(2, 40), 1);
  AttributeLayer& uv = model.meshes[0].surface.layers[0];
  for (std::size_t i = 0; i < uv.size(); ++i) uv.values[2 * i + 1] = 0.4f + 0.04f * uv.values[2 * i + 1];
  const std::vector<AtlasFace> faces = atlas_faces(model, find_atlases(model).at(0));
  const WarpGrid grid = waves(0.08);
  const auto at = moved_values(faces, InverseWarp(grid));
  ASSERT_TRUE(at);
  for (const AtlasFace& face : faces) EXPECT_GT(area(triangle(face, *at)) * area(face.uv), 0);
}

TEST(MovedValues, LinesStayLinesAndPointsPoints) {
  // The lowest row of cells is a line of the texture, its last cell a point.
  Model model = test::textured(test::grid(8, 4), 1);
  AttributeLayer& uv = model.meshes[0].surface.layers[0];
  for (std::size_t i = 0; i < uv.size(); ++i) {
    float* const value = uv.values.data() + 2 * i;
    value[1] = std::max(0.25f, value[1]);
    if (value[1] == 0.25f) value[0] = std::min(value[0], 0.875f);
  }
  const std::vector<AtlasFace> faces = atlas_faces(model, find_atlases(model).at(0));
  const auto at = moved_values(faces, InverseWarp(waves(0.05)));
  ASSERT_TRUE(at);
  int lines = 0;
  for (const AtlasFace& face : faces) {
    if (area(face.uv) != 0) continue;
    ++lines;
    EXPECT_EQ(area(triangle(face, *at)), 0);
  }
  EXPECT_GE(lines, 16);
}

}  // namespace
}  // namespace fovea
