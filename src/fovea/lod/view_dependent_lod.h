#pragma once

#include "fovea/lod/contraction.h"
#include "fovea/lod/level_selection.h"

namespace fovea {

/// Levels of detail that follow the eye: for programs that draw a model frame after frame.
///
/// A selection says which steps make the level for a view, a contraction makes its triangles. The work for a
/// level can be spread over several frames; until it is done, the level before stays. Nothing is allocated
/// after construction.
class ViewDependentLod {
 public:
  /// Both must outlive this and be of the same levels; nobody else may use them. `frames` ≥ 1: updates for
  /// each level.
  ViewDependentLod(LevelSelection& selection, LevelContraction& contraction, int frames = 1);

  /// A share of the work for the level in hand; if there is none, one is begun for this view. Whether the
  /// contraction has a new level. The first level is made at once.
  bool update(const LevelCamera& camera, const LevelBudget& budget);

 private:
  LevelSelection& selection_;
  LevelContraction& contraction_;
  std::size_t frames_, selected_ = 0;
  enum class Phase { idle, selecting, contracting } phase_ = Phase::idle;
  bool is_first_ = true;
};

}  // namespace fovea
