#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "fovea/simplify/collapse_state.h"
#include "fovea/simplify/value_merge.h"
#include "fovea/simplify/vertex_notes.h"

namespace fovea {

/// What stands against a collapse in the connectivity around an edge.
enum class Block { none, topology, last };

/// The rules of the collapse engine. They look at the triangles around one edge and keep nothing but
/// what they found there.
class Legality {
 public:
  explicit Legality(const CollapseState& state) : state_(state) {}

  /// Looks at the edge a–b, which the other rules are then about: the link condition (Dey et al. 1999).
  /// The neighbours that a and b share are those across their common triangles, an inner edge does not
  /// join two boundaries, and no two triangles come to lie on each other. Returns whether it holds;
  /// `topology` says what is wrong: `last` if no triangle would be left around the edge, else `topology`.
  bool look_at(std::uint32_t a, std::uint32_t b);
  Block topology() const { return topology_; }
  /// Whether so few triangles are left around the edge that next to nothing is seen of a thin part.
  bool leaves_scrap() const { return far_count_ <= 2; }
  /// The triangles on the edge, in the order of the ring of v, one of its ends.
  std::span<const std::uint32_t> shared_faces(std::uint32_t v) const {
    return {(v == a_ ? shared_at_a_ : shared_at_b_).data(), shared_count_};
  }
  /// Whether a and b have no neighbour in common but those across their triangles, each of which is across
  /// one.
  bool is_plain() const { return is_plain_; }
  /// Whether a locked vertex beside the edge would go with its last triangle.
  bool loses_locked() const;
  /// Whether a vertex across the edge has triangles, but none that would still join it to the edge's ends: a
  /// strap between two vertices goes.
  bool cuts_strap() const;
  /// Calls f(c, d) for the corners at a and at b that are about to be the same place of two triangles back to
  /// back, one from either end.
  template <class F>
  void for_coincident(F&& f) const {
    if (!may_coincide()) return;
    for (std::size_t j = far_at_a_; j < far_count_; ++j) {
      for (std::size_t i = 0; i < far_at_a_; ++i) {
        const Far &at_a = far_[i], &at_b = far_[j];
        if (at_a.next == at_b.previous && at_a.previous == at_b.next) f(at_a.corner, at_b.corner);
      }
    }
  }
  /// Whether the edge leaves triangles on each other.
  bool may_coincide() const { return topology_ == Block::topology; }

  /// No triangle around the edge turns over, or becomes a sliver that it was not, when both ends move
  /// to p.
  bool shape(Vec3d p) const;
  /// No triangle turns over in any texture map when the values of `merge` are set.
  bool texture(const ValueMerge& merge) const;

 private:
  /// A triangle at one end of the edge only: what stays, and changes its shape.
  struct Far {
    std::uint32_t corner;          // at the end
    std::uint32_t next, previous;  // vertices
  };
  void make_room(std::size_t corners);
  bool goes(std::uint32_t face) const;
  bool keeps_shape(const Far& face, Vec3d from, Vec3d to) const;
  bool keeps_texture(const Far& face, std::size_t channel, const float* planned) const;

  const CollapseState& state_;
  VertexNotes notes_;
  Block topology_ = Block::none;
  bool is_plain_ = false;
  std::uint32_t a_ = kInvalid, b_ = kInvalid;
  // With room for more than there is now:
  std::vector<Far> far_;  // those at a, then those at b
  std::size_t far_count_ = 0, far_at_a_ = 0;
  std::vector<std::array<std::uint32_t, 2>> places_;  // in `notes_`, of `next` and `previous` of those at b
  std::vector<std::uint32_t> across_;                 // places of the vertices opposite to the edge
  std::vector<std::uint32_t> shared_at_a_, shared_at_b_;  // triangles on the edge, as the rings have them
  std::size_t shared_count_ = 0;
};

}  // namespace fovea
