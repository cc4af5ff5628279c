#pragma once

#include <cstdint>
#include <limits>
#include <vector>

#include "fovea/simplify/collapse_state.h"

namespace fovea {

/// A place for the merged vertex of an edge, and what it costs.
struct Candidate {
  double cost = std::numeric_limits<double>::infinity();
  Vec3d position;
};

/// What it costs to collapse an edge, and where its vertex goes.
///
/// The error of the merged vertex as a function of its position is the sum of the quadrics of both
/// ends, less what the values of attributes can make up for (quadric.h): values that join are fitted
/// together, the others by themselves. At seams most values do not join, so the sum over all values of
/// a vertex by themselves is kept per vertex, and an edge corrects it for those that join.
class EdgeCost {
 public:
  /// Looks at all vertices of `state`, which must outlive this. O(#V + #F).
  EdgeCost(const CollapseState& state, Placement placement);

  /// To be called when the values or triangles at v have changed.
  void refresh(std::uint32_t v);
  /// To be called when v has no triangles any more.
  void forget(std::uint32_t v);
  /// Whether v has several values of some fitted attribute, or had when it was last looked at.
  bool has_many(std::uint32_t v) const { return slot_[v] != kInvalid; }
  /// What a value of v makes up for by itself: texture coordinates at a seam stay as they are, everything
  /// else becomes the best for the position.
  Quadric separate(const Channel& channel, std::uint32_t v, std::uint32_t value) const;

  /// The error over the position of the vertex that edge e collapses to. O(1), or O(valence) where more
  /// than two triangles meet at a seam.
  Quadric quadric(std::uint32_t e) const;
  /// The least of `q`, or the best of `fallbacks` where it has none near the edge.
  Candidate best_place(std::uint32_t e, const Quadric& q) const;
  /// The ends of the edge, as far as they may move, and its middle: cheapest first. At most three.
  std::size_t fallbacks(std::uint32_t e, const Quadric& q, Candidate* out) const;

  /// Starts to load what `quadric(e)` will read, in steps that each need what the one before fetched: the
  /// ends, their values and what lies at a seam, the values that join there.
  void fetch_ends(std::uint32_t e) const;
  void fetch_values(std::uint32_t e) const;
  void fetch_joined(std::uint32_t e) const;

 private:
  template <int Width>
  void settle(Quadric& q, const Channel& channel, std::uint32_t a, std::uint32_t b,
              const EdgeCorners& corners) const;
  template <int Width>
  void settle_joined(Quadric& q, const Channel& channel, std::uint32_t a, std::uint32_t b,
                     const EdgeCorners& corners) const;

  void fetch_value(const Channel& channel, std::uint32_t value) const;

  const CollapseState& state_;
  const CollapseMesh& mesh_;
  const Placement placement_;
  std::vector<std::uint32_t> slot_;  // [#V] into `separate_`, kInvalid without a channel of many values
  std::vector<Quadric> separate_;    // what such a vertex's values make up for by themselves
  std::vector<std::uint32_t> free_slots_;
  std::vector<std::uint32_t> values_;  // scratch of refresh()
};

}  // namespace fovea
