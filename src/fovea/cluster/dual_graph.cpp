#include "fovea/cluster/dual_graph.h"

#include <algorithm>
#include <utility>

#include "fovea/base/parallel.h"
#include "fovea/cluster/bridges.h"
#include "fovea/surface/disjoint_sets.h"
#include "fovea/surface/half_edges.h"

namespace fovea {

namespace {

constexpr std::size_t kFaceGrain = 8192;

using Pair = std::pair<std::uint32_t, std::uint32_t>;

void measure(DualGraph& graph, const Surface& surface, const Context& context) {
  const std::size_t count = surface.triangles.size();
  graph.centers.resize(count);
  graph.normals.resize(count);
  graph.areas.resize(count);
  parallel_for(context, count, kFaceGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t f = begin; f < end; ++f) {
      const auto& t = surface.triangles[f];
      const Vec3d a = surface.position(t[0]), b = surface.position(t[1]), c = surface.position(t[2]);
      const Vec3d across = cross(b - a, c - a);
      graph.centers[f] = Vec3f((a + b + c) / 3.0);
      graph.normals[f] = Vec3f(normalized(across));
      graph.areas[f] = static_cast<float>(length(across) / 2);
    }
  });
}

std::vector<Pair> pairs_over_edges(const Surface& surface) {
  std::vector<std::array<VertexId, 3>> triangles;
  triangles.reserve(surface.triangles.size());
  for (const auto& t : surface.triangles)
    triangles.push_back({VertexId{t[0]}, VertexId{t[1]}, VertexId{t[2]}});
  std::vector<Pair> pairs;
  pairs.reserve(3 * triangles.size() / 2);
  for_each_edge(sorted_half_edges(triangles), [&](std::span<const HalfEdge> edge) {
    const auto link = [&](const HalfEdge& a, const HalfEdge& b) {
      if (a.triangle() != b.triangle()) pairs.emplace_back(a.triangle(), b.triangle());
    };
    for (std::size_t i = 1; i < edge.size(); ++i) link(edge[i - 1], edge[i]);
    if (edge.size() > 2) link(edge.front(), edge.back());
  });
  return pairs;
}

void add_links(DualGraph& graph, const std::vector<Pair>& pairs) {
  std::vector<std::uint32_t>& first = graph.first_link;
  first.assign(graph.face_count() + 1, 0);
  for (const auto& [a, b] : pairs) ++first[a + 1], ++first[b + 1];
  for (std::size_t f = 0; f < graph.face_count(); ++f) first[f + 1] += first[f];
  graph.links.resize(first.back());
  std::vector<std::uint32_t> next(first.begin(), first.end() - 1);
  for (const auto& [a, b] : pairs) {
    const auto distance = static_cast<float>(length(Vec3d(graph.centers[a]) - Vec3d(graph.centers[b])));
    graph.links[next[a]++] = {b, distance};
    graph.links[next[b]++] = {a, distance};
  }
  for (std::size_t f = 0; f < graph.face_count(); ++f)
    std::sort(graph.links.begin() + first[f], graph.links.begin() + first[f + 1],
              [](const DualGraph::Link& a, const DualGraph::Link& b) { return a.face < b.face; });
}

}  // namespace

DualGraph dual_graph(const Surface& surface, const Context& context) {
  DualGraph graph;
  measure(graph, surface, context);
  std::vector<Pair> pairs = pairs_over_edges(surface);
  DisjointSets pieces(graph.face_count());
  for (const auto& [a, b] : pairs) pieces.unite(a, b);
  const std::vector<Pair> between = bridges(graph.centers, pieces);
  pairs.insert(pairs.end(), between.begin(), between.end());
  add_links(graph, pairs);
  return graph;
}

}  // namespace fovea
