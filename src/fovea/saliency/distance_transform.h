#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace fovea {

/// A cell of a grid, from its top left.
struct GridCell {
  int x = 0, y = 0;
};

/// Steps of the chamfer distance: to a cell beside, across a corner, and by a knight's move (Borgefors 1986).
/// Five make a cell.
inline constexpr int kChamferEdge = 5, kChamferCorner = 7, kChamferKnight = 11;

/// The chamfer distance of each cell from the nearest source, [height × width]; at most 2 % off the straight
/// distance times five. Two passes, as paper 004 has it; sources must lie in the grid. Cells are far (at
/// least 2³⁰) if there is no source. O(width · height).
std::vector<std::int32_t> distance_transform(int width, int height, std::span<const GridCell> sources);

}  // namespace fovea
