#pragma once

#include <cstdint>
#include <vector>

#include "fovea/base/math.h"
#include "fovea/cluster/clusters.h"

namespace fovea {

/// What is known of a cluster without looking at its triangles (Munaretti 2007, table 5.1).
struct ClusterProperties {
  std::uint64_t triangles = 0;
  std::uint64_t vertices = 0;  ///< Of its triangles; those on borders count for each cluster.
  // Of the saliency at these vertices:
  double total_saliency = 0;
  double mean_saliency = 0;
  double peak_saliency = 0;
  double base_saliency = 0;  ///< The least.
  double area = 0;
  Vec3d mean_normal;          ///< Of its triangles by area; unit, or 0 where they cancel out.
  double peak_deviation = 0;  ///< Largest angle of a triangle to that, radians; π without a mean.
  Sphere sphere;              ///< Around the middle of the box of its vertices.
};

/// Of each cluster, in world units. Throws Error(usage) if saliency [#V] or clusters are of another scene.
/// O(#F).
std::vector<ClusterProperties> cluster_properties(const SceneSurface& scene, const VertexField& saliency,
                                                  const Clusters& clusters);

/// Saliency as it counts within clusters (Munaretti 2007, equation 5.3):
///   S_ci = (S_i − min_c) / (max_c − min_c) + mean_c
/// A vertex of several clusters has the largest of what it is in each; where a cluster's saliency is the same
/// everywhere the first term is 0. [#V of the scene], 0 at vertices without triangles. Throws as
/// `cluster_properties`. O(#F).
VertexField local_saliency(const SceneSurface& scene, const VertexField& saliency, const Clusters& clusters);

}  // namespace fovea
