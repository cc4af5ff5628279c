#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "fovea/lod/level_selection.h"
#include "fovea/lod/multi_tessellation.h"
#include "fovea/model/model.h"
#include "fovea/simplify/simplify.h"

namespace fovea {

struct ErrorSelectionOptions {
  /// What errors out of sight count for, beyond the picture's edges and on the far side: 0 … 1. Not 0, as
  /// shadows and mirrors show them and the eye turns.
  double unseen = 0.1;
};

/// Selects by what errors look like: takes the steps whose error is smallest on the screen.
///
/// A step's error (multi_tessellation.h), times the root of the importance of what it stands for, is seen
/// from the nearest point of the sphere around the triangles that it makes, at rest, where the scene shows
/// the mesh largest. No step counts less than one that it needs; so those below any bound can be taken
/// together, and the bound for a number of triangles is found exactly, by counting. What cannot be seen only
/// waits for the steps that made its two vertices, so that what is seen does not hold it back: there
/// triangles may fold over, without cracks (vertex_hierarchy.h). One thread, some 20 ns for each step of the
/// record.
class ErrorSelection : public LevelSelection {
 public:
  /// `importance` as for `simplify`: [#meshes][#V], or empty for 1 everywhere; what is locked (infinity)
  /// stays in every level. `levels` must outlive this. Throws Error(usage) if they or the importance are of
  /// another model, or for options out of range. O(#F); 50 bytes for each step.
  ErrorSelection(const Model& original, const MultiTessellation& levels, const Importance& importance = {},
                 const ErrorSelectionOptions& options = {});
  ~ErrorSelection() override;

  void begin(const LevelCamera& camera, const LevelBudget& budget) override;
  bool advance(std::size_t work) override;
  std::size_t total_work() const override { return 3 * levels_.step_count(); }
  const StepBits& taken() const override { return taken_; }
  /// Up to what error on the screen, times importance, steps are taken, in pixels.
  double bound_px() const { return bound_; }

 private:
  void find_makers();
  void look(std::size_t begin, std::size_t end);
  void look_closer(std::size_t begin, std::size_t end);
  void take(std::size_t begin, std::size_t end);
  std::uint32_t find_bound(std::uint32_t count);

  const MultiTessellation& levels_;
  struct Scene;
  std::unique_ptr<Scene> scene_;
  float unseen_;
  /// [#steps], the last steps before that made the two vertices it merges; kInvalid where none did.
  std::vector<std::array<std::uint32_t, 2>> makers_;
  StepBits taken_;

  // Of the view in hand:
  float error_px_ = 0;
  std::vector<float> on_screen_;       // [#steps], pixels, none less than what it waits for
  std::vector<float> with_all_;        // [#steps], the same if nothing were out of sight
  std::vector<std::uint64_t> counts_;  // [2¹⁶], triangles removed by steps, by one half of the bits of that
  std::uint64_t to_remove_ = 0;        // triangles, not counted yet
  std::uint32_t upper_ = 0;            // half of the bits of the bound
  float bound_ = 0;
  std::size_t done_ = 0;
};

}  // namespace fovea
