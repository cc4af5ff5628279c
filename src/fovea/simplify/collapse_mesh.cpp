#include "fovea/simplify/collapse_mesh.h"

#include <algorithm>
#include <numeric>
#include <utility>

namespace fovea {

void CollapseMesh::link() {
  live_faces = faces.size();
  // Rings: each new corner goes in after the vertex's first one.
  for (std::uint32_t c = 0; c < 3 * faces.size(); ++c) {
    std::uint32_t& own = faces[c / 3].next_corner[c % 3];
    std::uint32_t& first = vertices[vertex(c)].first_corner;
    if (first == kInvalid) {
      first = own = c;
    } else {
      std::uint32_t& after = faces[first / 3].next_corner[first % 3];
      own = after;
      after = c;
    }
  }
  // Edges: each is numbered at its smaller end.
  edges.clear();
  edges.reserve(faces.size() * 3 / 2 + 3);
  for (std::uint32_t v = 0; v < vertices.size(); ++v) {
    const std::uint32_t mark = new_mark();
    const auto number = [&](std::uint32_t half_edge, std::uint32_t other) {
      if (other < v) return;
      CollapseVertex& w = vertices[other];
      if (w.mark != mark) {
        w.mark = mark;
        w.mark_count = static_cast<std::uint32_t>(edges.size());
        edges.push_back({v, other});
      }
      edge(half_edge) = w.mark_count;
    };
    for_ring(v, [&](std::uint32_t c) {
      number(c, vertex(next(c)));
      number(previous(c), vertex(previous(c)));
    });
  }
}

std::uint32_t CollapseMesh::new_mark() {
  if (last_mark_ > kInvalid - 8) {
    for (CollapseVertex& v : vertices) v.mark = 0;
    last_mark_ = 0;
  }
  return last_mark_ += 4;
}

void CollapseMesh::unlink_corner(std::uint32_t c) {
  const auto next_of = [&](std::uint32_t k) -> std::uint32_t& { return faces[k / 3].next_corner[k % 3]; };
  std::uint32_t& first = vertices[vertex(c)].first_corner;
  if (next_of(c) == c) {
    first = kInvalid;
    return;
  }
  std::uint32_t before = c;
  while (next_of(before) != c) before = next_of(before);
  next_of(before) = next_of(c);
  if (first == c) first = before;
}

std::vector<std::uint8_t> count_edge_faces(const CollapseMesh& mesh) {
  std::vector<std::uint8_t> count(mesh.edges.size(), 0);
  for (std::uint32_t f = 0; f < mesh.faces.size(); ++f) {
    if (!mesh.face_alive(f)) continue;
    for (const std::uint32_t e : mesh.faces[f].edge)
      count[e] = static_cast<std::uint8_t>(std::min(count[e] + 1, 3));
  }
  return count;
}

FaceComponents find_components(const CollapseMesh& mesh) {
  std::vector<std::uint32_t> parent(mesh.vertices.size());
  std::iota(parent.begin(), parent.end(), 0u);
  const auto root = [&](std::uint32_t v) {
    while (parent[v] != v) v = parent[v] = parent[parent[v]];
    return v;
  };
  for (const CollapseFace& face : mesh.faces) {
    const auto& f = face.vertex;
    for (const auto& [a, b] : {std::pair{f[0], f[1]}, std::pair{f[1], f[2]}}) {
      const std::uint32_t ra = root(a), rb = root(b);
      parent[std::max(ra, rb)] = std::min(ra, rb);
    }
  }
  // Number components by their first face and sort faces by component.
  std::vector<std::uint32_t> number(parent.size(), kInvalid), of_face(mesh.faces.size());
  FaceComponents result;
  result.first.push_back(0);
  for (std::size_t f = 0; f < of_face.size(); ++f) {
    std::uint32_t& n = number[root(mesh.faces[f].vertex[0])];
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
