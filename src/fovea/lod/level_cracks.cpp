#include "fovea/lod/level_cracks.h"

#include <algorithm>
#include <numeric>
#include <tuple>
#include <utility>
#include <vector>

namespace fovea {

namespace {

using Edge = std::pair<std::uint32_t, std::uint32_t>;

Edge edge(std::uint32_t a, std::uint32_t b) { return {std::min(a, b), std::max(a, b)}; }

/// Each edge once, sorted, of those that come so many times that `wanted(times)`.
std::vector<Edge> those(std::vector<Edge> edges, const auto& wanted) {
  std::ranges::sort(edges);
  std::vector<Edge> result;
  for (std::size_t begin = 0, end = 0; begin < edges.size(); begin = end) {
    while (end < edges.size() && edges[end] == edges[begin]) ++end;
    if (wanted(end - begin)) result.push_back(edges[begin]);
  }
  return result;
}

}  // namespace

struct CrackFinder::Edges {
  std::vector<std::uint32_t> place;  ///< [#nodes], the first node that is where each is.
  std::vector<Edge> borders;         ///< Of the original, between nodes that stand for their place.
};

CrackFinder::CrackFinder(const VertexHierarchy& hierarchy) : hierarchy_(hierarchy) {
  auto original = std::make_unique<Edges>();
  std::vector<std::uint32_t> mesh_of(hierarchy.node_count(), kInvalid);
  for (const LevelPart& part : hierarchy.parts) {
    for (std::uint32_t f = part.first_face; f < part.end_face; ++f) {
      for (std::uint32_t node : hierarchy.corners[f]) {
        for (; node != kInvalid && mesh_of[node] == kInvalid; node = hierarchy.parent[node])
          mesh_of[node] = part.mesh;
      }
    }
  }
  const auto key = [&](std::uint32_t node) {
    const LevelVertices& vertices = hierarchy.vertices[mesh_of[node]];
    const Vec3f p = vertices.positions[hierarchy.vertex[node]];
    return std::tuple(mesh_of[node], p.x, p.y, p.z);
  };
  std::vector<std::uint32_t> order(hierarchy.node_count());
  std::iota(order.begin(), order.end(), 0u);
  std::ranges::sort(order, {}, [&](std::uint32_t node) { return std::pair(key(node), node); });
  original->place.resize(order.size());
  for (std::size_t i = 0; i < order.size(); ++i) {
    const bool again = i > 0 && key(order[i]) == key(order[i - 1]);
    original->place[order[i]] = again ? original->place[order[i - 1]] : order[i];
  }
  std::vector<Edge> edges;
  for (const auto& c : hierarchy.corners) {
    for (std::size_t k = 0; k < 3; ++k)
      edges.push_back(edge(original->place[c[k]], original->place[c[(k + 1) % 3]]));
  }
  original->borders = those(std::move(edges), [](std::size_t times) { return times % 2 == 1; });
  original_ = std::move(original);
}

CrackFinder::~CrackFinder() = default;

std::size_t CrackFinder::count(const StepBits& taken) const {
  std::vector<std::uint32_t> target(hierarchy_.node_count());
  for (std::size_t i = target.size(); i-- > 0;) {
    const std::uint32_t step = hierarchy_.step[i];
    target[i] =
        step != kInvalid && taken.has(step) ? target[hierarchy_.parent[i]] : static_cast<std::uint32_t>(i);
  }
  const auto place = [&](std::uint32_t node) { return original_->place[target[node]]; };
  std::vector<Edge> edges, borders;
  for (std::size_t f = 0; f < hierarchy_.face_count(); ++f) {
    const std::uint32_t step = hierarchy_.removed_by[f];
    if (step != kInvalid && taken.has(step)) continue;
    const auto& c = hierarchy_.corners[f];
    for (std::size_t k = 0; k < 3; ++k) edges.push_back(edge(place(c[k]), place(c[(k + 1) % 3])));
  }
  for (const auto& [a, b] : original_->borders) borders.push_back(edge(place(a), place(b)));
  std::ranges::sort(borders);
  const std::vector<Edge> open = those(std::move(edges), [](std::size_t times) { return times == 1; });
  return static_cast<std::size_t>(
      std::ranges::count_if(open, [&](const Edge& e) { return !std::ranges::binary_search(borders, e); }));
}

}  // namespace fovea
