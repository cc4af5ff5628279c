#include "fovea/cluster/cluster_ground.h"

#include <algorithm>
#include <limits>
#include <utility>

namespace fovea {

namespace {

/// Between the least and the greatest value at a vertex with triangles.
std::vector<float> scaled(const Adjacency& adjacency, const VertexField& saliency) {
  std::vector<float> result(adjacency.vertex_count(), 0.0f);
  if (saliency.empty()) return result;
  float low = std::numeric_limits<float>::infinity(), high = -low;
  for (std::uint32_t v = 0; v < result.size(); ++v) {
    if (adjacency.corners(v).empty()) continue;
    low = std::min(low, saliency.values()[v]);
    high = std::max(high, saliency.values()[v]);
  }
  if (!(high > low)) return result;
  for (std::uint32_t v = 0; v < result.size(); ++v)
    result[v] = std::clamp((saliency.values()[v] - low) / (high - low), 0.0f, 1.0f);
  return result;
}

}  // namespace

ClusterGround::ClusterGround(Surface surface_, const VertexField& saliency, const Context& context)
    : surface(std::move(surface_)),
      adjacency(surface, context),
      graph(dual_graph(surface, context)),
      vertex_saliency(scaled(adjacency, saliency)) {
  face_saliency.reserve(surface.triangles.size());
  for (const auto& t : surface.triangles)
    face_saliency.push_back((vertex_saliency[t[0]] + vertex_saliency[t[1]] + vertex_saliency[t[2]]) / 3);
}

std::uint32_t ClusterGround::peak_vertex(std::uint32_t face) const {
  const auto& t = surface.triangles[face];
  return *std::min_element(t.begin(), t.end(), [&](std::uint32_t a, std::uint32_t b) {
    return std::pair(-vertex_saliency[a], a) < std::pair(-vertex_saliency[b], b);
  });
}

}  // namespace fovea
