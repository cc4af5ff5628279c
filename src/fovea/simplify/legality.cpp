#include "fovea/simplify/legality.h"

#include <algorithm>

namespace fovea {

namespace {

/// Cosine of the largest turn of a triangle in one collapse.
constexpr double kMaxTurnCosine = 0.25;
/// A triangle whose height is below this fraction of its longest edge is a sliver.
constexpr double kSliver = 1e-3;

double longest_squared(Vec3d a, Vec3d b, Vec3d c) {
  return std::max({length_squared(b - a), length_squared(c - b), length_squared(a - c)});
}

}  // namespace

bool Legality::look_at(std::uint32_t a, std::uint32_t b) {
  CollapseMesh& mesh = state_.mesh;
  // A neighbour of a is marked `at_a`; one of b `at_b`; one of both, `at_both`; `counted` once it has
  // been seen across the edge. `mark_count` counts the triangles on its edge to a, then to b.
  const std::uint32_t at_a = mesh.new_mark(), at_b = at_a + 1, at_both = at_a + 2, counted = at_a + 3;
  topology_ = Block::none;
  far_edges_.clear();
  std::size_t surviving = 0, common = 0, across = 0, coincident = 0;
  bool boundary_a = false, boundary_b = false;

  mesh.for_ring(a, [&](std::uint32_t c) {
    for (const std::uint32_t w :
         {mesh.vertex(CollapseMesh::next(c)), mesh.vertex(CollapseMesh::previous(c))}) {
      CollapseVertex& vertex = mesh.vertices[w];
      vertex.mark_count = vertex.mark == at_a ? vertex.mark_count + 1 : 1;
      vertex.mark = at_a;
    }
  });
  const std::uint32_t faces_on_edge = mesh.vertices[b].mark_count;
  mesh.for_ring(a, [&](std::uint32_t c) {
    const std::uint32_t n = mesh.vertex(CollapseMesh::next(c)), p = mesh.vertex(CollapseMesh::previous(c));
    boundary_a = boundary_a || mesh.vertices[n].mark_count == 1 || mesh.vertices[p].mark_count == 1;
    if (n == b || p == b) return;
    ++surviving;
    far_edges_.emplace_back(n, p);
  });
  mesh.for_ring(b, [&](std::uint32_t c) {
    for (const std::uint32_t w :
         {mesh.vertex(CollapseMesh::next(c)), mesh.vertex(CollapseMesh::previous(c))}) {
      CollapseVertex& vertex = mesh.vertices[w];
      if (vertex.mark == at_b || vertex.mark == at_both) {
        ++vertex.mark_count;
        continue;
      }
      const bool shared = vertex.mark == at_a;
      common += shared;
      vertex.mark = shared ? at_both : at_b;
      vertex.mark_count = 1;
    }
  });
  mesh.for_ring(b, [&](std::uint32_t c) {
    const std::uint32_t n = mesh.vertex(CollapseMesh::next(c)), p = mesh.vertex(CollapseMesh::previous(c));
    boundary_b = boundary_b || mesh.vertices[n].mark_count == 1 || mesh.vertices[p].mark_count == 1;
    if (n == a || p == a) {
      CollapseVertex& opposite = mesh.vertices[n == a ? p : n];
      across += opposite.mark == at_both;
      opposite.mark = counted;
      return;
    }
    ++surviving;
    if (common < 2) return;
    for (const auto& [x, y] : far_edges_) coincident += (x == n && y == p) || (x == p && y == n);
  });
  if (surviving <= 2 * coincident) {
    topology_ = Block::last;
  } else if (common != across || coincident > 0 || (faces_on_edge >= 2 && boundary_a && boundary_b)) {
    topology_ = Block::topology;
  }
  return topology_ == Block::none;
}

bool Legality::keeps_shape(std::uint32_t c, std::uint32_t other, Vec3d p) const {
  const CollapseMesh& mesh = state_.mesh;
  const std::uint32_t v1 = mesh.vertex(CollapseMesh::next(c)), v2 = mesh.vertex(CollapseMesh::previous(c));
  if (v1 == other || v2 == other) return true;
  const Vec3d p0 = state_.mesh.vertices[mesh.vertex(c)].position;
  const Vec3d p1 = state_.mesh.vertices[v1].position, p2 = state_.mesh.vertices[v2].position;
  const Vec3d before = cross(p1 - p0, p2 - p0), after = cross(p1 - p, p2 - p);
  const double before2 = length_squared(before), after2 = length_squared(after);
  // Height / longest edge = double area / longest edge².
  const auto is_sliver = [&](Vec3d apex, double double_area2) {
    const double longest2 = longest_squared(apex, p1, p2);
    return double_area2 < kSliver * kSliver * longest2 * longest2;
  };
  const double cosine = dot(before, after);
  const bool keeps_side = cosine > 0 && cosine * cosine > kMaxTurnCosine * kMaxTurnCosine * before2 * after2;
  return (keeps_side && !is_sliver(p, after2)) || is_sliver(p0, before2);
}

bool Legality::shape(std::uint32_t a, std::uint32_t b, Vec3d p) const {
  bool ok = true;
  state_.mesh.for_ring(a, [&](std::uint32_t c) { ok = ok && keeps_shape(c, b, p); });
  state_.mesh.for_ring(b, [&](std::uint32_t c) { ok = ok && keeps_shape(c, a, p); });
  return ok;
}

bool Legality::keeps_texture(std::uint32_t c, std::uint32_t other, std::size_t channel_index,
                             const ValueMerge& merge) const {
  const CollapseMesh& mesh = state_.mesh;
  const std::uint32_t n = CollapseMesh::next(c), p = CollapseMesh::previous(c);
  if (mesh.vertex(n) == other || mesh.vertex(p) == other) return true;
  const Channel& channel = state_.channels[channel_index];
  const std::uint32_t own = channel.corner_value[c];
  if (own == kInvalid) return true;
  const auto uv = [](const float* x) { return Vec2d{x[0], x[1]}; };
  const Vec2d q1 = uv(channel.value(channel.corner_value[n])),
              q2 = uv(channel.value(channel.corner_value[p]));
  const Vec2d q0 = uv(channel.value(own)), q = uv(merge.planned(channel_index, own));
  const double before = cross(q1 - q0, q2 - q0), after = cross(q1 - q, q2 - q);
  return before == 0 || (before > 0) == (after > 0);
}

bool Legality::texture(std::uint32_t a, std::uint32_t b, const ValueMerge& merge) const {
  bool ok = true;
  for (std::size_t i = 0; i < state_.channels.size(); ++i) {
    if (!state_.channels[i].is_uv()) continue;
    state_.mesh.for_ring(a, [&](std::uint32_t c) { ok = ok && keeps_texture(c, b, i, merge); });
    state_.mesh.for_ring(b, [&](std::uint32_t c) { ok = ok && keeps_texture(c, a, i, merge); });
  }
  return ok;
}

}  // namespace fovea
