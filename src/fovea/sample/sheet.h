#pragma once

#include <functional>

#include "fovea/base/math.h"
#include "fovea/model/weld.h"

namespace fovea::sample {

/// A patch of surface in columns × rows quads. Points are asked for by whole numbers, so that patches
/// which meet can give the same bits there. Columns cross rows counter-clockwise seen from outside.
struct Sheet {
  int columns = 1, rows = 1;
  std::function<Vec3d(int column, int row)> position;  ///< 0 … columns, 0 … rows
  std::function<Vec2d(int column, int row)> uv;
};

/// Appends the sheet's vertices, texture coordinates and triangles. A row whose points are one (a
/// pole) gets a fan; no triangle with two equal corners is made. Returns the first new vertex; vertex
/// (column, row) comes row (columns + 1) + column later.
std::size_t add_sheet(SplitPart& part, const Sheet& sheet);

/// A part with a material and an empty uv layer.
SplitPart make_part(int material);

/// Normals of `positions` over the part's triangles, smooth across vertices with equal positions,
/// weighted by angle (Thürmer & Wüthrich 1998). [#vertices × 3]
std::vector<float> smooth_normals(const SplitPart& part, const std::vector<Vec3f>& positions);

/// Appends `smooth_normals` of the part itself as a layer.
void add_normals(SplitPart& part);

/// The attribute of that meaning, or null.
VertexArray* find_attribute(SplitPart& part, Semantic semantic);

/// Columns or rows at a level of detail: `base` at 1, so that triangles grow with `detail`.
int scaled(int base, double detail);

}  // namespace fovea::sample
