#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "fovea/simplify/collapse_state.h"
#include "fovea/simplify/value_merge.h"

namespace fovea {

/// What stands against a collapse in the connectivity around an edge.
enum class Block { none, topology, last };

/// The rules of the collapse engine. They look at the triangles around one edge and keep nothing but
/// what they found there.
class Legality {
 public:
  explicit Legality(CollapseState& state) : state_(state) {}

  /// The link condition (Dey et al. 1999): the neighbours that a and b share are those across their
  /// common triangles, an inner edge does not join two boundaries, and no two triangles come to lie
  /// on each other. Returns whether it holds; `topology` says what is wrong: `last` if no triangle
  /// would be left around the edge, else `topology`.
  bool look_at(std::uint32_t a, std::uint32_t b);
  Block topology() const { return topology_; }
  /// Whether the edge last looked at leaves triangles on each other.
  bool may_coincide() const { return topology_ == Block::topology; }

  /// No triangle around a or b turns over, or becomes a sliver that it was not, when both move to p.
  bool shape(std::uint32_t a, std::uint32_t b, Vec3d p) const;
  /// No triangle turns over in any texture map when the values of `merge` are set.
  bool texture(std::uint32_t a, std::uint32_t b, const ValueMerge& merge) const;

 private:
  bool keeps_shape(std::uint32_t c, std::uint32_t other, Vec3d p) const;
  bool keeps_texture(std::uint32_t c, std::uint32_t other, std::size_t channel,
                     const ValueMerge& merge) const;

  CollapseState& state_;  // for the vertices' marks; nothing else changes
  Block topology_ = Block::none;
  std::vector<std::pair<std::uint32_t, std::uint32_t>> far_edges_;
};

}  // namespace fovea
