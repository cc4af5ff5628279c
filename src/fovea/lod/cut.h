#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "fovea/lod/multi_tessellation.h"
#include "fovea/model/model.h"

namespace fovea {

/// A set of steps, closed under what they need: which have been taken, 0 or 1. [#steps]
using Cut = std::vector<std::uint8_t>;

/// Triangles that are left.
std::uint64_t triangles_of(const MultiTessellation& levels, const Cut& cut);

/// The first steps, until no more than so many triangles are left, or there are no more steps.
Cut cut_at_triangles(const MultiTessellation& levels, std::uint64_t triangles);

/// All steps but those that take the last triangles of a mesh.
Cut cut_leaving_meshes(const Model& original, const MultiTessellation& levels);

/// As many steps as there are whose error is at most this, in scene units.
Cut cut_at_error(const MultiTessellation& levels, double error);

/// As many steps as there are with which each triangle keeps to what is allowed at its vertices: `allowed`
/// [#vertices of all meshes] is the largest error at each vertex of the original, 0 or more. A vertex that
/// others were merged into allows as much as the strictest of them. The smallest mesh that the record has
/// under this rule. O(#steps): milliseconds for a million triangles.
Cut cut_within(const MultiTessellation& levels, std::span<const float> allowed);

/// The same, with all that is allowed multiplied by the smallest factor with which no more than so many
/// triangles are left, to a thousandth; `factor` receives it. What allows nothing stays as it is, so more can
/// be left.
Cut cut_within(const MultiTessellation& levels, std::span<const float> allowed, std::uint64_t triangles,
               double* factor = nullptr);

/// The original with its meshes as a cut leaves them. O(#steps + #F · #layers).
Model level_of(const Model& original, const MultiTessellation& levels, const Cut& cut);

}  // namespace fovea
