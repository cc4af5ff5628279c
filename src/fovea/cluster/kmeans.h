#pragma once

#include <cstdint>
#include <vector>

#include "fovea/base/context.h"
#include "fovea/cluster/clusters.h"
#include "fovea/cluster/dual_graph.h"

// Private to cluster/.

namespace fovea {

struct KMeans {
  std::vector<std::uint32_t> of_face;  ///< [#F], each of `centers.size()` clusters has one.
  std::vector<Vec3d> centers;          ///< Of the clusters.
  std::uint32_t rounds = 0;
  ClusterEnd end = ClusterEnd::converged;
};

/// Triangles by the nearest of several centres, which move to the mean of what they have, weighted by area
/// (Lloyd; Linde, Buzo, Gray 1980), until the mean squared distance falls by less than a thousandth or
/// `most_rounds` are over. Centres begin on `first_faces` (different ones); one that loses all its triangles
/// goes to the triangle that is farthest from its own. Clusters need not be connected. Parallel. O(rounds ·
/// #F · #clusters^(2/3)) on surfaces whose clusters are about alike in size.
KMeans k_means(const DualGraph& graph, const std::vector<std::uint32_t>& first_faces,
               std::uint32_t most_rounds, Context& context);

/// For each cluster that of its triangles which is nearest to its centre, ties by number; each has one.
/// O(#F).
std::vector<std::uint32_t> nearest_faces(const DualGraph& graph, const std::vector<std::uint32_t>& of_face,
                                         const std::vector<Vec3d>& centers);

}  // namespace fovea
