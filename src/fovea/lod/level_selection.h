#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>

#include "fovea/lod/step_bits.h"
#include "fovea/render/view.h"

namespace fovea {

/// Who looks, and on a picture of what size.
struct LevelCamera {
  View view;
  int width = 1920, height = 1080;  ///< In pixels.
};

/// What a level may cost and what it may leave out.
struct LevelBudget {
  /// No more triangles than that, if the levels go down so far ...
  std::uint64_t triangles = std::numeric_limits<std::uint64_t>::max();
  /// ... and none that is only there for errors of no more than so many pixels. The rule of clusters does not
  /// look at it.
  double error_px = 0;
};

/// Says which steps of a simplification make the level for a view: a little at a time, if that is wanted.
class LevelSelection {
 public:
  virtual ~LevelSelection() = default;
  virtual void begin(const LevelCamera& camera, const LevelBudget& budget) = 0;
  /// Does so much of the work that there is; whether all is done. Allocates nothing.
  virtual bool advance(std::size_t work) = 0;
  virtual std::size_t total_work() const = 0;
  /// A cut (cut.h), once that is done, until the next is begun.
  virtual const StepBits& taken() const = 0;
};

}  // namespace fovea
