#include "fovea/simplify/collapse_mesh.h"

#include <numeric>
#include <utility>

namespace fovea {

CollapseMesh::CollapseMesh(std::vector<std::array<std::uint32_t, 3>> faces, std::size_t vertex_count)
    : face_vertex(std::move(faces)),
      corner_next(3 * face_vertex.size()),
      corner_edge(3 * face_vertex.size()),
      vertex_corner(vertex_count, kInvalid),
      live_faces(face_vertex.size()) {
  // Rings, built backwards so that they list corners in rising order.
  for (std::size_t i = corner_next.size(); i-- > 0;) {
    const auto c = static_cast<std::uint32_t>(i);
    std::uint32_t& first = vertex_corner[vertex(c)];
    if (first == kInvalid) {
      corner_next[c] = c;
    } else {
      corner_next[c] = corner_next[first];
      corner_next[first] = c;
    }
    if (first == kInvalid) first = c;  // the last corner closes the ring
  }
  // Edges: each is numbered at its smaller end.
  edge_vertex.reserve(face_vertex.size() * 3 / 2 + 3);
  std::vector<std::uint32_t> seen_from(vertex_count, kInvalid), edge_to(vertex_count);
  for (std::uint32_t v = 0; v < vertex_count; ++v) {
    const auto number = [&](std::uint32_t half_edge, std::uint32_t other) {
      if (other < v) return;
      if (seen_from[other] != v) {
        seen_from[other] = v;
        edge_to[other] = static_cast<std::uint32_t>(edge_vertex.size());
        edge_vertex.push_back({v, other});
      }
      corner_edge[half_edge] = edge_to[other];
    };
    for_ring(v, [&](std::uint32_t c) {
      number(c, vertex(next(c)));
      number(previous(c), vertex(previous(c)));
    });
  }
}

void CollapseMesh::unlink_corner(std::uint32_t c) {
  const std::uint32_t v = vertex(c);
  if (corner_next[c] == c) {
    vertex_corner[v] = kInvalid;
    return;
  }
  std::uint32_t before = c;
  while (corner_next[before] != c) before = corner_next[before];
  corner_next[before] = corner_next[c];
  if (vertex_corner[v] == c) vertex_corner[v] = before;
}

std::vector<std::uint8_t> count_edge_faces(const CollapseMesh& mesh) {
  std::vector<std::uint8_t> count(mesh.edge_vertex.size(), 0);
  for (std::size_t c = 0; c < mesh.corner_edge.size(); ++c) {
    if (mesh.face_alive(static_cast<std::uint32_t>(c / 3)) && count[mesh.corner_edge[c]] < 3)
      ++count[mesh.corner_edge[c]];
  }
  return count;
}

FaceComponents find_components(const CollapseMesh& mesh) {
  std::vector<std::uint32_t> parent(mesh.vertex_corner.size());
  std::iota(parent.begin(), parent.end(), 0u);
  const auto root = [&](std::uint32_t v) {
    while (parent[v] != v) v = parent[v] = parent[parent[v]];
    return v;
  };
  for (const auto& f : mesh.face_vertex) {
    for (const auto& [a, b] : {std::pair{f[0], f[1]}, std::pair{f[1], f[2]}}) {
      const std::uint32_t ra = root(a), rb = root(b);
      parent[std::max(ra, rb)] = std::min(ra, rb);
    }
  }
  // Number components by their first face and sort faces by component.
  std::vector<std::uint32_t> number(parent.size(), kInvalid), of_face(mesh.face_vertex.size());
  FaceComponents result;
  result.first.push_back(0);
  for (std::size_t f = 0; f < of_face.size(); ++f) {
    std::uint32_t& n = number[root(mesh.face_vertex[f][0])];
    if (n == kInvalid) {
      n = static_cast<std::uint32_t>(result.first.size() - 1);
      result.first.push_back(0);
    }
    of_face[f] = n;
    ++result.first[n + 1];
  }
  std::partial_sum(result.first.begin(), result.first.end(), result.first.begin());
  result.faces.resize(of_face.size());
  std::vector<std::uint32_t> at(result.first.begin(), result.first.end() - 1);
  for (std::size_t f = 0; f < of_face.size(); ++f)
    result.faces[at[of_face[f]]++] = static_cast<std::uint32_t>(f);
  return result;
}

}  // namespace fovea
