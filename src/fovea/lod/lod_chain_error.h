#pragma once

#include <cstdint>
#include <vector>

#include "fovea/base/context.h"
#include "fovea/lod/lod_chain.h"
#include "fovea/surface/pose.h"
#include "fovea/surface/surface.h"

// Private to lod.

namespace fovea {

/// A model as levels are measured against it.
class LodReference {
 public:
  /// Refers to the model. `key_poses` as in LodChainOptions.
  LodReference(const Model& model, std::int64_t key_poses, std::int64_t samples, const Context& context);

  /// Of a model with the same nodes and animations; 0 for what is no more than rounding. Throws
  /// Error(cancelled).
  LodError error(const Model& level, const Context& context) const;

 private:
  std::vector<Pose> poses_;
  std::vector<Surface> surfaces_;  // [#poses]
  std::int64_t samples_;
};

}  // namespace fovea
