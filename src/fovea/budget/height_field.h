#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "fovea/model/model.h"

namespace fovea {

/// Land: a grid of points, evenly apart along two axes of a mesh, with one height each.
struct HeightField {
  int columns = 0, rows = 0;  ///< Points along each side, 2 or more.
  int up = 1;           ///< The axis of heights (0 x, 1 y, 2 z). Columns go along the first of the others.
  bool turned = false;  ///< From above, rows lie clockwise of columns.
  std::vector<Vec3f> points;           ///< [rows × columns], in the mesh's space.
  std::vector<AttributeLayer> layers;  ///< Without corners: one value for each point.
  std::uint32_t mesh = 0;              ///< Index into the model's meshes.
  Part part;                           ///< The part of the mesh that it is.
  Mat4 to_world;
  std::size_t other_faces = 0;  ///< Of the mesh, that do not look up: walls and the underside of a block.
};

/// What was found in a model.
struct HeightFieldSearch {
  std::optional<HeightField> field;
  std::string why_not;  ///< Empty if it was found.
};

/// Looks whether a model is land: one mesh, shown once and unmoved, whose faces that look up (along any axis,
/// either way) are two for each cell of a regular grid, of one part, without seams. Steps of the grid may
/// differ by a hundredth, as integers of files round them. Faces that look elsewhere do not matter and are
/// counted. O(n log n).
HeightFieldSearch find_height_field(const Model& model);

/// What a vertex of a height field's triangulation is for.
enum class HeightError {
  largest,  ///< The largest distance along `up` that a grid point has from the triangles without it,
  squares,  ///< or the sum of its squares over all grid points there.
};

/// All triangulations of a height field by a restricted quadtree (von Herzen and Barr 1987; as in Balmelli,
/// Ayer and Vetterli 1998, Lindstrom et al. 1996): from two triangles on, the longest edge is split in its
/// middle, for both of its triangles at once, so that no vertex ever lies inside of an edge. An order of all
/// splits is found, by what they are for; any first part of it is a level. What a split is for counts as at
/// least as much as what all those are for that need it.
///
/// Grids of other sides than 2^n + 1 are taken for the corner of the next larger one, whose points beyond the
/// last column or row lie on it: triangles at these borders are more slender, and those that end up without
/// area are dropped. Nothing is resampled; the finest level has all points.
class QuadtreeLevels {
 public:
  /// `weights` [rows × columns] multiply distances (seen_detail.h); empty for 1 everywhere. Refers to the
  /// field, which must outlive it. Throws Error(limit) for more than 2^14 + 1 points along a side,
  /// Error(usage) for another number of weights. O(n log n) in the points of the larger grid.
  explicit QuadtreeLevels(const HeightField& field, HeightError error, std::span<const float> weights = {});

  std::size_t split_count() const { return errors_.size(); }
  /// Triangles after the first `splits`.
  std::uint64_t triangles_after(std::size_t splits) const { return triangles_[splits]; }
  /// The most splits that leave at most so many triangles.
  std::size_t splits_to(std::uint64_t triangles) const;
  /// What the next split is for; 0 after the last. With HeightError::largest no grid point is farther from
  /// the level.
  double error_after(std::size_t splits) const { return splits < errors_.size() ? errors_[splits] : 0.0; }
  /// The fewest splits that leave an error of at most `error`.
  std::size_t splits_for(double error) const;

  /// The mesh after the first `splits`: of the field's points, with its layers. O(#triangles + #points).
  TriMesh level(std::size_t splits) const;

 private:
  const HeightField& field_;
  int side_ = 0;                          // of the larger grid, in cells: 2^n
  std::vector<std::uint32_t> rank_;       // [(side + 1)²] place of the split at a point in the order
  std::vector<float> errors_;             // [#splits] falls
  std::vector<std::uint32_t> triangles_;  // [#splits + 1]
};

/// The model with a level in place of its land; walls and undersides are left out.
Model with_level(const Model& model, const HeightField& field, TriMesh level);

}  // namespace fovea
