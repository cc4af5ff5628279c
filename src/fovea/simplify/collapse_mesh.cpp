#include "fovea/simplify/collapse_mesh.h"

#include <algorithm>
#include <bit>
#include <numeric>
#include <utility>

#include "fovea/surface/disjoint_sets.h"

namespace fovea {

void CollapseMesh::link() {
  live_faces = faces.size();
  link_rings();
  link_edges();
}

/// Each edge is numbered at its smaller end.
void CollapseMesh::link_edges() {
  struct Last {
    std::uint32_t from = kInvalid, edge = kInvalid;
  };
  std::vector<Last> last_edge(vertices.size());  // that came to a vertex
  edges.clear();
  edges.reserve(vertices.size() + faces.size() + 64);  // by Euler's formula there are hardly more
  for (std::uint32_t v = 0; v < vertices.size(); ++v) {
    const auto number = [&](std::uint32_t half_edge, std::uint32_t other) {
      if (other < v) return;
      Last& last = last_edge[other];
      if (last.from != v) {
        last = {v, static_cast<std::uint32_t>(edges.size())};
        edges.push_back({{v, other}});
      }
      edge(half_edge) = last.edge;
      edges[last.edge].add(half_edge);
    };
    for_ring(v, [&](std::uint32_t c) {
      number(c, vertex(next(c)));
      number(previous(c), vertex(previous(c)));
    });
  }
}

void CollapseMesh::link_rings() {
  for (const CollapseFace& face : faces) {
    for (const std::uint32_t v : face.vertex) ++vertices[v].ring_size;
  }
  std::uint32_t end = 0;
  for (CollapseVertex& v : vertices) {
    v.ring_begin = end;
    end += std::bit_ceil(std::uint32_t{v.ring_size});
    v.ring_size = 0;
  }
  corners.reserve(end + end / 8);  // rings that grow move to the end
  corners.assign(end, kInvalid);
  for (std::uint32_t c = 0; c < 3 * faces.size(); ++c) {
    CollapseVertex& v = vertices[vertex(c)];
    corners[v.ring_begin + v.ring_size++] = c;
  }
  free_room_.assign(32, kInvalid);
}

EdgeCorners CollapseMesh::edge_corners(std::uint32_t e, std::uint32_t a) const {
  EdgeCorners found;
  const auto add = [&](std::uint32_t half_edge) {
    auto& pair = found.pairs[found.count++];
    pair = {half_edge, next(half_edge)};
    if (vertex(half_edge) != a) std::swap(pair[0], pair[1]);
  };
  const CollapseEdge& edge = edges[e];
  if (edge.is_listed()) {
    for (const std::uint32_t half_edge : edge.half_edges) {
      if (half_edge != kInvalid) add(half_edge);
    }
    return found;
  }
  for (const std::uint32_t c : ring(a)) {
    if (found.count == EdgeCorners::kMost) break;
    const CornerView at_c = view(c);
    if (at_c.to_next == e) add(c);
    if (at_c.to_previous == e) add(previous(c));
  }
  return found;
}

void CollapseMesh::unlink_corner(std::uint32_t c) {
  CollapseVertex& v = vertices[vertex(c)];
  std::uint32_t* const begin = corners.data() + v.ring_begin;
  std::uint32_t* const last = begin + v.ring_size - 1;
  *std::find(begin, last, c) = *last;
  const std::uint32_t room = v.room();
  --v.ring_size;
  if (v.room() < room && v.spare < 3) ++v.spare;
}

void CollapseMesh::join_rings(std::uint32_t a, std::uint32_t b) {
  CollapseVertex &from = vertices[a], &to = vertices[b];
  const std::uint32_t size = from.ring_size + to.ring_size;
  const bool stays = size <= to.room(), moves = !stays && size <= from.room();
  const std::uint32_t room = stays ? to.room() : moves ? from.room() : std::bit_ceil(size);
  const std::uint32_t begin = stays ? to.ring_begin : moves ? from.ring_begin : take_room(room);
  for (const std::uint32_t c : ring(a)) faces[c / 3].vertex[c % 3] = b;
  // Those of b come first.
  const auto at = [&](std::uint32_t place) { return corners.begin() + place; };
  std::copy_backward(at(from.ring_begin), at(from.ring_begin + from.ring_size), at(begin + size));
  if (begin != to.ring_begin) {
    std::copy_n(at(to.ring_begin), to.ring_size, at(begin));
    give_room(to.ring_begin, to.room());
  }
  if (begin != from.ring_begin) give_room(from.ring_begin, from.room());
  to.ring_begin = begin;
  to.ring_size = size & 0xFFFFFFFu;
  to.spare = static_cast<std::uint32_t>(std::countr_zero(room / std::bit_ceil(size))) & 3;
  from.ring_size = 0;
}

std::uint32_t CollapseMesh::take_room(std::uint32_t room) {
  std::uint32_t& free = free_room_[static_cast<std::size_t>(std::countr_zero(room))];
  if (free != kInvalid) return std::exchange(free, corners[free]);
  const auto begin = static_cast<std::uint32_t>(corners.size());
  corners.resize(begin + room);
  return begin;
}

void CollapseMesh::give_room(std::uint32_t begin, std::uint32_t room) {
  std::uint32_t& free = free_room_[static_cast<std::size_t>(std::countr_zero(room))];
  corners[begin] = free;
  free = begin;
}

FaceComponents find_components(const CollapseMesh& mesh) {
  DisjointSets sets(mesh.vertices.size());
  for (const CollapseFace& face : mesh.faces) {
    sets.unite(face.vertex[0], face.vertex[1]);
    sets.unite(face.vertex[1], face.vertex[2]);
  }
  // Number components by their first face and sort faces by component.
  std::vector<std::uint32_t> number(mesh.vertices.size(), kInvalid), of_face(mesh.faces.size());
  FaceComponents result;
  result.first.push_back(0);
  for (std::size_t f = 0; f < of_face.size(); ++f) {
    std::uint32_t& n = number[sets.find(mesh.faces[f].vertex[0])];
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
