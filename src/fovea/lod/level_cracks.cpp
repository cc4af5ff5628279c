#include "fovea/lod/level_cracks.h"

#include <algorithm>
#include <functional>
#include <utility>
#include <vector>

#include "fovea/model/key_table.h"

namespace fovea {

namespace {

using Edge = std::pair<std::uint32_t, std::uint32_t>;

Edge edge(std::uint32_t a, std::uint32_t b) { return {std::min(a, b), std::max(a, b)}; }

/// Calls f(begin, end) for each run of equal edges in a sorted list.
void for_runs(const auto& sorted, const auto& edge_of, const auto& f) {
  for (std::size_t begin = 0, end = 0; begin < sorted.size(); begin = end) {
    while (end < sorted.size() && edge_of(sorted[end]) == edge_of(sorted[begin])) ++end;
    f(begin, end);
  }
}

}  // namespace

struct CrackFinder::Edges {
  std::vector<std::uint32_t> place;  ///< [#nodes], the first node that is where each is.
  /// Of the original, once for each triangle on them: between its own nodes, as others at that place may be
  /// those of a vertex that comes there later.
  std::vector<Edge> borders;
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
  // What a vertex is to readers, too (model/weld.h): a place at rest and in all morph targets.
  std::vector<KeyTable> tables;
  std::vector<std::vector<std::uint32_t>> first(hierarchy.vertices.size());  // [#meshes][#places]
  for (const LevelVertices& vertices : hierarchy.vertices)
    tables.emplace_back(3 * (1 + vertices.position_morphs.size()), vertices.positions.size());
  std::vector<std::uint32_t> key;
  for (std::uint32_t node = 0; node < hierarchy.node_count(); ++node) {
    const std::uint32_t mesh = mesh_of[node], vertex = hierarchy.vertex[node];
    const LevelVertices& vertices = hierarchy.vertices[mesh];
    key.clear();
    const auto add = [&](Vec3f p) {
      for (const float x : {p.x, p.y, p.z}) key.push_back(KeyTable::word(x));
    };
    add(vertices.positions[vertex]);
    for (const auto& morph : vertices.position_morphs) add(morph[vertex]);
    const std::uint32_t place = tables[mesh].insert(key);
    if (place == first[mesh].size()) first[mesh].push_back(node);
    original->place.push_back(first[mesh][place]);
  }
  struct Side {
    Edge places, nodes;
  };
  std::vector<Side> sides;
  for (const auto& c : hierarchy.corners) {
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t a = c[k], b = c[(k + 1) % 3];
      sides.push_back({edge(original->place[a], original->place[b]), {a, b}});
    }
  }
  std::ranges::sort(sides, {}, &Side::places);
  for_runs(
      sides, [](const Side& side) { return side.places; },
      [&](std::size_t begin, std::size_t end) {
        if ((end - begin) % 2 == 0) return;
        for (std::size_t i = begin; i < end; ++i) original->borders.push_back(sides[i].nodes);
      });
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
  std::ranges::sort(edges);
  std::size_t cracks = 0;
  for_runs(edges, std::identity(), [&](std::size_t begin, std::size_t end) {
    cracks += end - begin == 1 && !std::ranges::binary_search(borders, edges[begin]);
  });
  return cracks;
}

}  // namespace fovea
