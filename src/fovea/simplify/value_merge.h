#pragma once

#include <cstdint>
#include <vector>

#include "fovea/simplify/collapse_state.h"
#include "fovea/simplify/record.h"
#include "fovea/simplify/value_classes.h"

namespace fovea {

/// What becomes of the attribute values at a and b when their edge collapses: planned for a position
/// (so that rules can look at it), then carried out.
class ValueMerge {
 public:
  ValueMerge(CollapseState& state, Placement placement)
      : state_(state), placement_(placement), plans_(state.channels.size()) {}

  /// Works out the classes and new values of every channel for edge e, from a to b, merged at `p`.
  void plan(std::uint32_t e, std::uint32_t a, std::uint32_t b, Vec3d p);
  /// The planned numbers of a value that belongs to a or b.
  const float* planned(std::size_t channel, std::uint32_t value) const;
  /// The same for all values at a and b, or null if they become several.
  const float* planned_for_all(std::size_t channel) const {
    const Plan& plan = plans_[channel];
    return plan.classes.is_one_pair() ? plan.values.data() : nullptr;
  }

  /// Carries out the plan: joins values and their quadrics, relabels the corners at a and b, sets
  /// numbers, records it. To be called while a and b still have their triangles.
  void apply(std::uint32_t a, std::uint32_t b, std::uint32_t mesh, CollapseRecord& record);
  /// Looks up again which vertices have a single value, after b's triangles have changed.
  void update_singles(std::uint32_t b);

 private:
  struct Plan {
    ValueClasses classes;
    std::vector<float> values;  // [#classes entries × width], set at roots
  };
  void plan_class(const Channel& channel, Plan& plan, std::uint32_t root, std::uint32_t held);
  void fit(const Channel& channel, const Plan& plan, std::uint32_t root, float* out);
  void mix_skin(const Channel& channel, const float* at_a, const float* at_b, float* out) const;
  void relabel(Channel& channel, const ValueClasses& classes, std::uint32_t a, std::uint32_t b);
  void set_class(Channel& channel, const Plan& plan, std::uint32_t root, std::uint32_t mesh,
                 CollapseRecord& record) const;

  CollapseState& state_;
  const Placement placement_;
  std::vector<Plan> plans_;  // [#channels]
  std::vector<float> sum_;
  // Of the present plan:
  Vec3d position_;
  std::uint32_t slot_ = 0;
  float along_ = 0;  // 0 at a, 1 at b
};

}  // namespace fovea
