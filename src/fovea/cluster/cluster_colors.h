#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "fovea/cluster/clusters.h"

namespace fovea {

/// A colour for each cluster, as display values: one of twelve, clearly different from those of the clusters
/// that it shares a vertex with unless there are too many of these. O(#F log #F).
std::vector<std::array<std::uint8_t, 3>> cluster_colors(const SceneSurface& scene, const Clusters& clusters);

}  // namespace fovea
