#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "fovea/cluster/cluster_ground.h"

// Private to cluster/.

namespace fovea {

/// Vertices to begin with: `count` picked at random among the 5 · `count` most salient (Munaretti 2007,
/// section 5.1), ties by number. Vertices without triangles do not count; where there are too few, those
/// repeat. O(#V log #V).
std::vector<std::uint32_t> salient_seeds(const ClusterGround& ground, std::size_t count, std::uint64_t seed);

/// Triangles far from each other: the first at random, each further one that whose way over the graph to the
/// nearest so far is longest, ties by number. `count` is at most #F. O(#F log² #F) mostly.
std::vector<std::uint32_t> spread_faces(const DualGraph& graph, std::size_t count, std::uint64_t seed);

/// For each cluster the vertex to grow from next: the peak vertex of the triangle that is farthest from its
/// border, where a step counts as long as its distance times saliency over the greatest in the cluster
/// (equation 5.2); ties by number. A cluster without border keeps its seed. Parallel. O(#F log #F).
std::vector<std::uint32_t> inner_seeds(const ClusterGround& ground, std::span<const std::uint32_t> of_face,
                                       std::span<const std::uint32_t> seeds, const Context& context);

}  // namespace fovea
