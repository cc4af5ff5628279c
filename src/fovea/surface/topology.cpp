#include "fovea/surface/topology.h"

#include <algorithm>
#include <span>
#include <utility>

#include "fovea/surface/disjoint_sets.h"

namespace fovea {

namespace {

std::size_t next_corner(std::size_t c) { return c % 3 == 2 ? c - 2 : c + 1; }

/// The edge from a corner's vertex to that of the next corner of its triangle.
struct HalfEdge {
  std::uint64_t ends = 0;  ///< Smaller vertex above, larger below: the same for both directions.
  std::uint32_t corner = 0;
  bool forward = true;  ///< From the smaller to the larger vertex.
  friend bool operator<(const HalfEdge& a, const HalfEdge& b) {
    return std::pair(a.ends, a.corner) < std::pair(b.ends, b.corner);
  }
  /// Corners of the triangle at the smaller and the larger end.
  std::size_t low_corner() const { return forward ? corner : next_corner(corner); }
  std::size_t high_corner() const { return forward ? next_corner(corner) : corner; }
};

std::vector<HalfEdge> sorted_half_edges(const TriMesh& mesh) {
  std::vector<HalfEdge> edges(3 * mesh.face_count());
  for (std::size_t c = 0; c < edges.size(); ++c) {
    const std::uint64_t from = mesh.vertex(CornerId{c}).value;
    const std::uint64_t to = mesh.vertex(CornerId{next_corner(c)}).value;
    edges[c] = {std::min(from, to) << 32 | std::max(from, to), static_cast<std::uint32_t>(c), from < to};
  }
  std::sort(edges.begin(), edges.end());
  return edges;
}

/// Calls `f` with the half-edges of each edge.
template <class F>
void for_each_edge(std::span<const HalfEdge> sorted, F&& f) {
  for (std::size_t begin = 0, end = 0; begin < sorted.size(); begin = end) {
    while (end < sorted.size() && sorted[end].ends == sorted[begin].ends) ++end;
    f(sorted.subspan(begin, end - begin));
  }
}

bool is_seam(const TriMesh& mesh, const HalfEdge& a, const HalfEdge& b) {
  return std::any_of(mesh.layers.begin(), mesh.layers.end(), [&](const AttributeLayer& layer) {
    return layer.corner_value[a.low_corner()] != layer.corner_value[b.low_corner()] ||
           layer.corner_value[a.high_corner()] != layer.corner_value[b.high_corner()];
  });
}

}  // namespace

EdgeCounts count_edges(const TriMesh& mesh) {
  EdgeCounts counts;
  for_each_edge(sorted_half_edges(mesh), [&](std::span<const HalfEdge> edge) {
    ++counts.total;
    if (edge.size() == 1) {
      ++counts.boundary;
    } else if (edge.size() > 2 || edge[0].forward == edge[1].forward) {
      ++counts.non_manifold;
    } else {
      ++counts.interior;
      counts.seam += is_seam(mesh, edge[0], edge[1]);
      counts.part_border += mesh.face_part[edge[0].corner / 3] != mesh.face_part[edge[1].corner / 3];
    }
  });
  return counts;
}

Components components(const TriMesh& mesh) {
  DisjointSets sets(mesh.vertex_count());
  for (const auto& [a, b, c] : mesh.triangles) {
    sets.unite(a.index(), b.index());
    sets.unite(a.index(), c.index());
  }
  Components result{Field<FaceId, std::uint32_t>(mesh.face_count()), 0};
  std::vector<std::uint32_t> number(mesh.vertex_count(), kInvalid);
  for (std::size_t f = 0; f < mesh.face_count(); ++f) {
    std::uint32_t& n = number[sets.find(mesh.triangles[f][0].index())];
    if (n == kInvalid) n = result.count++;
    result.of_face[FaceId{f}] = n;
  }
  return result;
}

std::uint64_t count_bow_ties(const TriMesh& mesh) {
  // Corners of a vertex belong to one fan if a chain of shared edges joins them.
  DisjointSets corners(3 * mesh.face_count());
  for_each_edge(sorted_half_edges(mesh), [&](std::span<const HalfEdge> edge) {
    for (const HalfEdge& h : edge.subspan(1)) {
      corners.unite(edge[0].low_corner(), h.low_corner());
      corners.unite(edge[0].high_corner(), h.high_corner());
    }
  });
  std::vector<std::uint32_t> fans(mesh.vertex_count(), 0);
  for (std::size_t c = 0; c < 3 * mesh.face_count(); ++c) {
    if (corners.find(c) == c) ++fans[mesh.vertex(CornerId{c}).index()];
  }
  return static_cast<std::uint64_t>(std::count_if(fans.begin(), fans.end(), [](auto n) { return n > 1; }));
}

}  // namespace fovea
