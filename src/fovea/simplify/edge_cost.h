#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "fovea/base/prefetch.h"
#include "fovea/simplify/collapse_state.h"

namespace fovea {

class JoinedValues;

/// A place for the merged vertex of an edge, and what it costs.
struct Candidate {
  double cost = std::numeric_limits<double>::infinity();
  Vec3d position;
};

/// What it costs to collapse an edge, and where its vertex goes.
///
/// The error of the merged vertex as a function of its position is the sum of the quadrics of both
/// ends, less what the values of attributes can make up for (quadric.h): values that join are fitted
/// together, the others by themselves. So the values of a vertex on a seam are listed. Where they are many,
/// what they make up for by themselves is summed once, and an edge corrects that for those that join.
class EdgeCost {
 public:
  /// Looks at all vertices of `state`, which must outlive this. O(#V + #F).
  EdgeCost(const CollapseState& state, Placement placement);

  /// To be called when the values or triangles at v have changed.
  void refresh(std::uint32_t v);
  /// To be called when v has no triangles any more.
  void forget(std::uint32_t v);
  /// Whether v has several values of some fitted attribute, or had when it was last looked at.
  bool has_many(std::uint32_t v) const { return !slot_.empty() && slot_[v] != kInvalid; }
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
  /// ends, their values and what lies at a seam, the values that are listed there.
  void fetch_ends(std::uint32_t e) const;
  void fetch_values(std::uint32_t e) const;
  void fetch_seams(std::uint32_t e) const;
  /// What `has_many(v)` will read.
  void fetch_slot(std::uint32_t v) const {
    if (!slot_.empty()) prefetch(&slot_[v]);
  }

 private:
  /// The values of one channel at a vertex that has several.
  struct alignas(16) SeamValues {
    static constexpr std::uint32_t kMost = 3;
    std::uint32_t count = 0;  ///< kMost + 1 if they are too many to be listed; 0 if not several.
    std::array<std::uint32_t, kMost> value;  ///< Or, first, the index of their sum.

    bool is_listed() const { return count <= kMost; }
    std::span<const std::uint32_t> list() const { return {value.data(), count}; }
  };

  template <int Width>
  void settle(Quadric& q, std::size_t channel, std::uint32_t a, std::uint32_t b,
              const EdgeCorners& corners) const;
  template <int Width>
  void settle_joined(Quadric& q, std::size_t channel, std::uint32_t a, std::uint32_t b,
                     const EdgeCorners& corners) const;
  template <int Width>
  void settle_rest(Quadric& q, std::size_t channel, std::uint32_t v, const JoinedValues& joined,
                   bool is_b) const;
  SeamValues& seam_values(std::uint32_t v, std::size_t channel) {
    return seam_[slot_[v] * state_.channels.size() + channel];
  }
  const SeamValues& seam_values(std::uint32_t v, std::size_t channel) const {
    return seam_[slot_[v] * state_.channels.size() + channel];
  }
  void take_slot(std::uint32_t v);
  SeamValues look_at_values(const Channel& channel, std::uint32_t v);
  std::uint32_t sum_values(const Channel& channel, std::uint32_t v);

  void fetch_value(const Channel& channel, std::uint32_t value) const;

  const CollapseState& state_;
  const CollapseMesh& mesh_;
  const Placement placement_;
  // [#V] in `seam_`, kInvalid without a channel of several values; empty if no vertex ever had one:
  std::vector<std::uint32_t> slot_;
  std::vector<std::uint32_t> free_slots_;
  std::vector<SeamValues> seam_;  // [#slots × #channels]
  std::vector<Quadric> sums_;     // what values that are not listed make up for by themselves
  std::vector<std::uint32_t> free_sums_;
  std::vector<std::uint32_t> values_;  // scratch of sum_values()
};

}  // namespace fovea
