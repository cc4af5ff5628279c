#pragma once

#include <cstdint>

#include "fovea/lod/level_selection.h"
#include "fovea/lod/multi_tessellation.h"

namespace fovea {

/// Takes the first steps, wherever the eye is: what the other selections have to be better than.
class UniformSelection : public LevelSelection {
 public:
  /// `levels` must outlive this.
  explicit UniformSelection(const MultiTessellation& levels) : levels_(levels), taken_(levels.step_count()) {}

  void begin(const LevelCamera&, const LevelBudget& budget) override {
    count_ = levels_.record.steps_to(budget.triangles);
    done_ = 0;
  }
  bool advance(std::size_t work) override {
    const std::size_t end = work < total_work() - done_ ? done_ + work : total_work();
    for (; done_ < end; ++done_) taken_.set(done_, done_ < count_);
    return done_ == total_work();
  }
  std::size_t total_work() const override { return levels_.step_count(); }
  const StepBits& taken() const override { return taken_; }

 private:
  const MultiTessellation& levels_;
  StepBits taken_;
  std::size_t count_ = 0, done_ = 0;
};

}  // namespace fovea
