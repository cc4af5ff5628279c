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
  const CollapseMesh& mesh = state_.mesh;
  a_ = a;
  b_ = b;
  // Of each neighbour is noted whether it has one triangle on its edge to a, or more; the same of b; and
  // whether it has been counted as a vertex across the edge. Edges of one triangle are open: there is a
  // boundary. No branches here: nothing foretells them.
  constexpr std::uint32_t kOneAtA = 1, kMoreAtA = 2, kOneAtB = 4, kMoreAtB = 8, kCounted = 16;
  constexpr std::uint32_t kBoth = kOneAtA | kOneAtB;
  std::size_t open_a = 0, open_b = 0, common = 0;
  const auto ring_a = mesh.ring(a), ring_b = mesh.ring(b);
  make_room(ring_a.size() + ring_b.size());
  std::size_t far = 0, shared_at_a = 0, shared_at_b = 0;
  for (const std::uint32_t c : ring_a) {
    const CornerView at_c = mesh.view(c);
    for (const std::uint32_t w : {at_c.next, at_c.previous}) {
      std::uint32_t& note = notes_[notes_.place(w)];
      const std::uint32_t known = note & kOneAtA;
      open_a += std::size_t{known == 0} - std::size_t{(note & (kOneAtA | kMoreAtA)) == kOneAtA};
      note |= kOneAtA << known;
    }
    const bool is_shared = (at_c.next == b) | (at_c.previous == b);
    far_[far] = {c, at_c.next, at_c.previous};
    far += !is_shared;
    shared_at_a_[shared_at_a] = c / 3;
    shared_at_a += is_shared;
  }
  far_at_a_ = far;
  for (const std::uint32_t c : ring_b) {
    const CornerView at_c = mesh.view(c);
    for (std::size_t k = 0; k < 2; ++k) {
      const std::uint32_t at = notes_.place(k == 0 ? at_c.next : at_c.previous);
      places_[far][k] = at;
      std::uint32_t& note = notes_[at];
      const std::uint32_t known = (note & kOneAtB) / kOneAtB;
      common += (note & kBoth) == kOneAtA;
      open_b += std::size_t{known == 0} - std::size_t{(note & (kOneAtB | kMoreAtB)) == kOneAtB};
      note |= kOneAtB << known;
    }
    const bool is_shared = (at_c.next == a) | (at_c.previous == a);
    far_[far] = {c, at_c.next, at_c.previous};
    across_[shared_at_b] = places_[far][at_c.next == a];
    far += !is_shared;
    shared_at_b_[shared_at_b] = c / 3;
    shared_at_b += is_shared;
  }
  far_count_ = far;
  shared_count_ = shared_at_b;
  std::size_t common_across = 0;
  for (std::size_t i = 0; i < shared_at_b; ++i) {
    std::uint32_t& note = notes_[across_[i]];
    common_across += (note & (kBoth | kCounted)) == kBoth;
    note |= kCounted;
  }
  is_plain_ = common == shared_at_b && common_across == shared_at_b;
  std::size_t coincident = 0;
  for (std::size_t i = far_at_a_; i < far && common >= 2; ++i) {
    const auto [c, n, p] = far_[i];
    if ((notes_[places_[i][0]] & notes_[places_[i][1]] & kBoth) != kBoth) continue;
    for (std::size_t j = 0; j < far_at_a_; ++j) {
      const auto [d, x, y] = far_[j];
      coincident += (x == n && y == p) || (x == p && y == n);
    }
  }
  if (far <= 2 * coincident) {
    topology_ = Block::last;
  } else if (common != common_across || coincident > 0 || (shared_at_b >= 2 && open_a > 0 && open_b > 0)) {
    topology_ = Block::topology;
  } else {
    topology_ = Block::none;
  }
  return topology_ == Block::none;
}

/// Room for `corners` corners at both ends, without notes. What else is there stays: it will be written over.
void Legality::make_room(std::size_t corners) {
  notes_.clear(2 * corners);
  if (far_.size() >= corners) return;
  far_.resize(corners);
  places_.resize(corners);
  across_.resize(corners);
  shared_at_a_.resize(corners);
  shared_at_b_.resize(corners);
}

/// Whether a triangle at either end goes: it is on the edge, or another comes to lie back to back with it.
bool Legality::goes(std::uint32_t face) const {
  const auto shared = shared_faces(b_);
  bool goes = std::find(shared.begin(), shared.end(), face) != shared.end();
  for_coincident([&](std::uint32_t c, std::uint32_t d) { goes |= c / 3 == face || d / 3 == face; });
  return goes;
}

bool Legality::loses_locked() const {
  const CollapseMesh& mesh = state_.mesh;
  const auto is_lost = [&](std::uint32_t v) {
    if (!mesh.vertices[v].locked || v == a_ || v == b_) return false;
    const auto ring = mesh.ring(v);
    return std::all_of(ring.begin(), ring.end(), [&](std::uint32_t c) { return goes(c / 3); });
  };
  const auto loses = [&](std::uint32_t face) {
    const auto& corners = mesh.faces[face].vertex;
    return std::any_of(corners.begin(), corners.end(), is_lost);
  };
  const auto shared = shared_faces(b_);
  bool lost = std::any_of(shared.begin(), shared.end(), loses);
  for_coincident([&](std::uint32_t c, std::uint32_t) { lost |= loses(c / 3); });
  return lost;
}

bool Legality::cuts_strap() const {
  const CollapseMesh& mesh = state_.mesh;
  const auto is_cut = [&](std::uint32_t w) {
    if (w == a_ || w == b_) return false;
    const auto shared = shared_faces(b_);
    bool has_others = false;
    for (const std::uint32_t c : mesh.ring(w)) {
      if (std::find(shared.begin(), shared.end(), c / 3) != shared.end()) continue;
      has_others = true;
      for (const std::uint32_t v : mesh.faces[c / 3].vertex) {
        if (v == a_ || v == b_) return false;
      }
    }
    return has_others;
  };
  for (const std::uint32_t f : shared_faces(b_)) {
    const auto& corners = mesh.faces[f].vertex;
    if (std::any_of(corners.begin(), corners.end(), is_cut)) return true;
  }
  return false;
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
  if (keeps_side && !is_sliver(to, after2)) return true;
  // A sliver may stay one, but not with two corners at one place: whoever reads that drops it.
  const Vec3f place(to);
  return is_sliver(from, before2) && place != Vec3f(p1) && place != Vec3f(p2);
}

bool Legality::shape(Vec3d p) const {
  const Vec3d a = state_.mesh.position(a_), b = state_.mesh.position(b_);
  for (std::size_t i = 0; i < far_count_; ++i) {
    if (!keeps_shape(far_[i], i < far_at_a_ ? a : b, p)) return false;
  }
  return true;
}

/// `planned` is what the corner's texture coordinates become.
bool Legality::keeps_texture(const Far& face, std::size_t channel_index, const float* planned) const {
  const Channel& channel = state_.channels[channel_index];
  const std::uint32_t own = channel.corner_value[face.corner];
  const auto uv = [](const float* x) { return Vec2d{x[0], x[1]}; };
  const Vec2d q1 = uv(channel.value(channel.corner_value[CollapseMesh::next(face.corner)])),
              q2 = uv(channel.value(channel.corner_value[CollapseMesh::previous(face.corner)]));
  const Vec2d q0 = uv(channel.value(own)), q = uv(planned);
  const double before = cross(q1 - q0, q2 - q0), after = cross(q1 - q, q2 - q);
  return before == 0 || (before > 0) == (after > 0);
}

bool Legality::texture(const ValueMerge& merge) const {
  for (std::size_t i = 0; i < state_.channels.size(); ++i) {
    if (!state_.channels[i].is_uv()) continue;
    const float* const for_all = merge.planned_for_all(i);
    for (std::size_t k = 0; k < far_count_; ++k) {
      const std::uint32_t own = state_.channels[i].corner_value[far_[k].corner];
      if (own == kInvalid) continue;
      if (!keeps_texture(far_[k], i, for_all != nullptr ? for_all : merge.planned(i, own))) return false;
    }
  }
  return true;
}

}  // namespace fovea
