#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "fovea/cluster/cluster_ground.h"
#include "fovea/cluster/radix_heap.h"

// Private to cluster/.

namespace fovea {

/// What growing clusters knows of one of them so far.
class GrowingCluster {
 public:
  explicit GrowingCluster(float start_saliency) : start_(start_saliency) {}

  void add(Vec3f normal, float saliency, float area);
  /// What it takes to go on from a triangle to a neighbour (Munaretti 2007, equation 5.1), but for the
  /// distance between them.
  double step_cost(float from_saliency, float to_saliency, Vec3f to_normal) const;

 private:
  float start_;
  Vec3d normal_sum_, normal_;
  double saliency_sum_ = 0, area_ = 0;
  float mean_ = 0;
};

/// Grows clusters from seeds over a whole surface: searches for shortest paths on the dual graph, of all
/// clusters at once, each triangle taken by the first to reach it. A step costs by equation 5.1 with the
/// means of the cluster at the time; where saliency is 0 everywhere this is the cost of Sander et al. 2003,
/// direction times distance.
class Growth {
 public:
  explicit Growth(const ClusterGround& ground);

  /// The cluster of each triangle, [#F], from seed vertices, at most as many as there are triangles; vertices
  /// may repeat. Each cluster first takes a triangle of its own: of the free ones around its seed the most
  /// salient, else the nearest on the graph; then, one cluster after the other, what else is free around the
  /// seed. So none is empty, and all are connected. O(#F log #F).
  const std::vector<std::uint32_t>& grow(std::span<const std::uint32_t> seeds);

 private:
  struct Face {
    Vec3f normal;
    float saliency = 0;
    double cost = 0;  ///< Of the best way here that is queued.
    float area = 0;
    std::uint32_t cluster = 0;
  };
  struct Step {
    std::uint32_t face = 0, cluster = 0;
  };

  std::uint32_t first_face(std::uint32_t seed);
  std::uint32_t nearest_free(std::uint32_t face);
  void begin_around(std::uint32_t seed, std::uint32_t first, std::uint32_t cluster);
  void take(std::uint32_t face, std::uint32_t cluster);
  void queue_around(std::uint32_t face, std::uint32_t cluster, double cost);

  const ClusterGround& ground_;
  std::vector<Face> faces_;
  std::vector<GrowingCluster> clusters_;
  RadixHeap<Step> queue_;
  std::vector<std::uint32_t> of_face_;
  std::vector<std::uint32_t> visit_, wave_;  // [#F], the search that was here last; the triangles of a search
  std::uint32_t search_ = 0;
};

}  // namespace fovea
