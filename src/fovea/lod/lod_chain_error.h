#pragma once

#include <cstdint>
#include <memory>

#include "fovea/base/context.h"
#include "fovea/lod/lod_chain.h"

// Private to lod.

namespace fovea {

/// A model as levels are measured against it.
///
/// Distances of the surfaces are those of points of both, spread by area at rest, and of all vertices, each
/// to the nearest point of the other surface: at rest, in key poses (key_poses.h), and in all poses of
/// animations and morph targets (`motion_poses`), 30 a second, of some of the points. In most of these poses
/// nobody has to look for the nearest point: what was nearest in another pose moves along, and is near enough
/// if it is not farther than what was measured already.
class LodReference {
 public:
  /// Refers to the model. `key_poses` and `samples` as in LodChainOptions.
  LodReference(const Model& model, std::int64_t key_poses, std::int64_t samples, const Context& context);
  ~LodReference();

  /// Of a model with the same nodes and animations; 0 for what is no more than rounding. The pose in which it
  /// is largest becomes a key pose. Throws Error(cancelled).
  LodError error(const Model& level, const Context& context);
  /// No more than that, and sooner: in key poses alone, of which there may be more from level to level.
  LodError error_in_key_poses(const Model& level, const Context& context) const;
  std::size_t key_pose_count() const;

 private:
  struct Original;
  class Level;
  std::unique_ptr<Original> original_;
};

}  // namespace fovea
