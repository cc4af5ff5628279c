#include "fovea/lod/view_dependent_lod.h"

#include <algorithm>

#include "fovea/base/error.h"

namespace fovea {

ViewDependentLod::ViewDependentLod(LevelSelection& selection, LevelContraction& contraction, int frames)
    : selection_(selection), contraction_(contraction), frames_(static_cast<std::size_t>(frames)) {
  if (frames < 1) throw Error(ErrorKind::usage, "a level takes one frame at least", "frames");
}

bool ViewDependentLod::update(const LevelCamera& camera, const LevelBudget& budget) {
  const std::size_t select = selection_.total_work(), contract = contraction_.total_work();
  std::size_t left = is_first_ ? select + contract : (select + contract) / frames_ + 1;
  if (phase_ == Phase::idle) {
    selection_.begin(camera, budget);
    phase_ = Phase::selecting;
    selected_ = 0;
  }
  if (phase_ == Phase::selecting) {
    const std::size_t share = std::min(left, select - selected_);
    const bool done = selection_.advance(share);
    selected_ += share;
    left -= share;
    if (!done) return false;
    contraction_.begin(selection_.taken());
    phase_ = Phase::contracting;
  }
  if (!contraction_.advance(left)) return false;
  phase_ = Phase::idle;
  is_first_ = false;
  return true;
}

}  // namespace fovea
