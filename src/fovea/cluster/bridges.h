#pragma once

#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "fovea/base/math.h"
#include "fovea/surface/disjoint_sets.h"

// Private to cluster/.

namespace fovea {

/// Pairs of near points that make one set of several, one fewer than there are sets; `sets` is one
/// afterwards. Not the shortest pairs but those that meet first in the cells of an octree, from its finest
/// level up; within a cell its first point along a Z-order curve stands for all. O(#points log #points),
/// however many sets.
std::vector<std::pair<std::uint32_t, std::uint32_t>> bridges(std::span<const Vec3f> points,
                                                             DisjointSets& sets);

}  // namespace fovea
