#pragma once

#include <cstdint>
#include <vector>

#include "fovea/cluster/cluster_ground.h"

// Private to cluster/.

namespace fovea {

/// Makes clusters connected on the graph: of each the piece with the largest area stays (ties by its first
/// triangle); the others join what stays around them, each where their common border is longest (in links if
/// it has no length, then by number), from there outwards until all have. O(#F log #F) a ring.
void connect(const ClusterGround& ground, std::vector<std::uint32_t>& of_face, std::size_t count);

}  // namespace fovea
