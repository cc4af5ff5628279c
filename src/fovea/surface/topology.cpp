#include "fovea/surface/topology.h"

#include <algorithm>
#include <span>
#include <utility>

#include "fovea/surface/disjoint_sets.h"
#include "fovea/surface/half_edges.h"

namespace fovea {

namespace {

bool is_seam(const TriMesh& mesh, const HalfEdge& a, const HalfEdge& b) {
  return std::any_of(mesh.layers.begin(), mesh.layers.end(), [&](const AttributeLayer& layer) {
    return layer.corner_value[a.low_corner()] != layer.corner_value[b.low_corner()] ||
           layer.corner_value[a.high_corner()] != layer.corner_value[b.high_corner()];
  });
}

}  // namespace

EdgeCounts count_edges(const TriMesh& mesh) {
  EdgeCounts counts;
  for_each_edge(sorted_half_edges(mesh.triangles), [&](std::span<const HalfEdge> edge) {
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
  for_each_edge(sorted_half_edges(mesh.triangles), [&](std::span<const HalfEdge> edge) {
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
