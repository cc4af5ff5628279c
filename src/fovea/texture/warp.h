#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "fovea/base/context.h"
#include "fovea/base/math.h"
#include "fovea/base/options.h"
#include "fovea/model/image.h"

namespace fovea {

/// A regular grid of cells over an image, bent: cell (i, j) of the new image shows what its four nodes
/// enclose in the old one. Coordinates are those of textures, 0 … 1, v down. Between nodes it is linear over
/// the two triangles of a cell, which the diagonal from its upper left to its lower right makes.
class WarpGrid {
 public:
  WarpGrid() = default;
  /// Nothing is moved.
  WarpGrid(int columns, int rows);

  int columns() const { return columns_; }
  int rows() const { return rows_; }
  /// Where node (i, j) lies in the old image; i 0 … columns, j 0 … rows.
  Vec2d node(int i, int j) const { return nodes_[index(i, j)]; }
  void set_node(int i, int j, Vec2d at) { nodes_[index(i, j)] = at; }

  /// What the new image shows at `target`; beyond the square the nearest of its border.
  Vec2d source(Vec2d target) const;
  /// Area of the smallest triangle that a cell's corner makes with its two neighbours, over that of a cell of
  /// the regular grid's; above 0 if no cell folds over.
  double smallest_corner() const;

 private:
  std::size_t index(int i, int j) const {
    return static_cast<std::size_t>(j) * static_cast<std::size_t>(columns_ + 1) + static_cast<std::size_t>(i);
  }

  int columns_ = 0, rows_ = 0;
  std::vector<Vec2d> nodes_;  // [(rows + 1) × (columns + 1)]
};

/// Where points of the old image are in the new one: the inverse of a grid without folds. Refers to the grid.
class InverseWarp {
 public:
  /// O(cells).
  explicit InverseWarp(const WarpGrid& grid);
  /// Beyond the square the nearest of its border. Some cells are looked at.
  Vec2d target(Vec2d source) const;

 private:
  const WarpGrid& grid_;
  std::vector<std::uint32_t> begin_, cell_;  // cells that overlap each field of a regular grid
};

struct WarpOptions {
  /// Cells of the grid along the longer side; the paper has a cell for 4 × 4 texels.
  std::int64_t cells = 128;
  /// Share of a round's move that goes to what keeps cells rigid, 0 … 1; 0 is relaxation alone, as Balmelli
  /// et al. ("Space-optimized texture maps", 2002) have it.
  double rigidity = 0.1;
  /// The least importance, as a part of the greatest, 0 … 1: how far cells may be stretched.
  double floor = 0.05;
  std::int64_t rounds = 100;  ///< Of each level, at most.
  double tolerance = 1e-3;    ///< A level is settled when no node moves farther, in cells.
  /// What lies beyond the right border is what lies at the left one, and so above and below (an image that
  /// repeats): nodes across from each other slide alike. No options for users; images say so.
  bool joined_u = false, joined_v = false;
};
OptionList describe(WarpOptions& options);

struct Warp {
  WarpGrid grid;
  std::int64_t rounds = 0;  ///< Of all levels.
  double last_move = 0;     ///< Farthest that a node went in the last round, in cells.
  bool settled = false;     ///< Every level came to rest.
};

/// Bends a grid over an image so that what is important gets more of the new image: texels along a line are
/// as dense as `importance` is high (Yang et al. 2016, section 4.2.2). Each round relaxes (eq. 12–13: a node
/// goes to its four neighbours, weighted by the importance of the cells between) and regularises (eq. 15–18:
/// each cell asks its corners to form the original square, rotated as fits best). Border nodes slide along
/// the border, corners stay. A move that would fold a cell is halved until it does not.
///
/// Departs from the paper: without the second term of eq. 14, which takes back what the first does (with it
/// eq. 12 does not change under conformal maps, and a regular grid is at rest whatever is important); from
/// coarse grids to fine ones, as on a fine grid alone hundreds of rounds move nothing far; both moves of a
/// round are mixed by `rigidity`.
///
/// `importance` [h × w × 1] 0 or more, of any size and of the image's proportions; all 0 counts as even.
/// O(cells · rounds), parallel. Throws Error(usage) for options out of range and for importance that is not
/// finite or below 0, Error(cancelled).
Warp warp(const ImageF& importance, const WarpOptions& options, Context& context);

}  // namespace fovea
