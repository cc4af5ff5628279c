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
  a_ = a;
  b_ = b;
  // A neighbour of a is marked `at_a`; one of b `at_b`; one of both, `at_both`; `counted` once it has
  // been seen across the edge. `mark_count` counts the triangles on its edge to a, then to b. Those of one
  // triangle are open: there is a boundary.
  const std::uint32_t at_a = mesh.new_mark(), at_b = at_a + 1, at_both = at_a + 2, counted = at_a + 3;
  std::size_t open_a = 0, open_b = 0, common = 0;
  far_.clear();
  across_.clear();
  for (const std::uint32_t c : mesh.ring(a)) {
    const CornerView at_c = mesh.view(c);
    for (const std::uint32_t w : {at_c.next, at_c.previous}) {
      CollapseVertex& vertex = mesh.vertices[w];
      if (vertex.mark != at_a) {
        vertex.mark = at_a;
        vertex.mark_count = 1;
        ++open_a;
      } else if (vertex.mark_count++ == 1) {
        --open_a;
      }
    }
    if (at_c.next != b && at_c.previous != b) far_.push_back({c, at_c.next, at_c.previous});
  }
  far_at_a_ = far_.size();
  for (const std::uint32_t c : mesh.ring(b)) {
    const CornerView at_c = mesh.view(c);
    for (const std::uint32_t w : {at_c.next, at_c.previous}) {
      CollapseVertex& vertex = mesh.vertices[w];
      if (vertex.mark != at_b && vertex.mark != at_both) {
        const bool shared = vertex.mark == at_a;
        common += shared;
        vertex.mark = shared ? at_both : at_b;
        vertex.mark_count = 1;
        ++open_b;
      } else if (vertex.mark_count++ == 1) {
        --open_b;
      }
    }
    if (at_c.next == a || at_c.previous == a) {
      across_.push_back(at_c.next == a ? at_c.previous : at_c.next);
    } else {
      far_.push_back({c, at_c.next, at_c.previous});
    }
  }
  std::size_t common_across = 0;
  for (const std::uint32_t w : across_) {
    common_across += mesh.vertices[w].mark == at_both;
    mesh.vertices[w].mark = counted;
  }
  std::size_t coincident = 0;
  for (std::size_t i = far_at_a_; i < far_.size() && common >= 2; ++i) {
    const auto [c, n, p] = far_[i];
    if (mesh.vertices[n].mark < at_both || mesh.vertices[p].mark < at_both) continue;
    for (std::size_t j = 0; j < far_at_a_; ++j) {
      const auto [d, x, y] = far_[j];
      coincident += (x == n && y == p) || (x == p && y == n);
    }
  }
  if (far_.size() <= 2 * coincident) {
    topology_ = Block::last;
  } else if (common != common_across || coincident > 0 || (across_.size() >= 2 && open_a > 0 && open_b > 0)) {
    topology_ = Block::topology;
  } else {
    topology_ = Block::none;
  }
  return topology_ == Block::none;
}

bool Legality::keeps_shape(const Far& face, Vec3d from, Vec3d to) const {
  const Vec3d p1 = state_.mesh.position(face.next), p2 = state_.mesh.position(face.previous);
  const Vec3d before = cross(p1 - from, p2 - from), after = cross(p1 - to, p2 - to);
  const double before2 = length_squared(before), after2 = length_squared(after);
  // Height / longest edge = double area / longest edge².
  const auto is_sliver = [&](Vec3d apex, double double_area2) {
    const double longest2 = longest_squared(apex, p1, p2);
    return double_area2 < kSliver * kSliver * longest2 * longest2;
  };
  const double cosine = dot(before, after);
  const bool keeps_side = cosine > 0 && cosine * cosine > kMaxTurnCosine * kMaxTurnCosine * before2 * after2;
  return (keeps_side && !is_sliver(to, after2)) || is_sliver(from, before2);
}

bool Legality::shape(Vec3d p) const {
  const Vec3d a = state_.mesh.position(a_), b = state_.mesh.position(b_);
  for (std::size_t i = 0; i < far_.size(); ++i) {
    if (!keeps_shape(far_[i], i < far_at_a_ ? a : b, p)) return false;
  }
  return true;
}

bool Legality::keeps_texture(const Far& face, std::size_t channel_index, const ValueMerge& merge) const {
  const Channel& channel = state_.channels[channel_index];
  const std::uint32_t own = channel.corner_value[face.corner];
  if (own == kInvalid) return true;
  const auto uv = [](const float* x) { return Vec2d{x[0], x[1]}; };
  const Vec2d q1 = uv(channel.value(channel.corner_value[CollapseMesh::next(face.corner)])),
              q2 = uv(channel.value(channel.corner_value[CollapseMesh::previous(face.corner)]));
  const Vec2d q0 = uv(channel.value(own)), q = uv(merge.planned(channel_index, own));
  const double before = cross(q1 - q0, q2 - q0), after = cross(q1 - q, q2 - q);
  return before == 0 || (before > 0) == (after > 0);
}

bool Legality::texture(const ValueMerge& merge) const {
  for (std::size_t i = 0; i < state_.channels.size(); ++i) {
    if (!state_.channels[i].is_uv()) continue;
    for (const Far& face : far_) {
      if (!keeps_texture(face, i, merge)) return false;
    }
  }
  return true;
}

}  // namespace fovea
