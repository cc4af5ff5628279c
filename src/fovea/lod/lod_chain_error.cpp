#include "fovea/lod/lod_chain_error.h"

#include <algorithm>

#include "fovea/judge/surface_distance.h"
#include "fovea/surface/key_poses.h"

namespace fovea {

namespace {

/// Of the diagonal: below it distances are what rounding positions to floats leaves.
constexpr double kRounding = 2e-7;

Surface posed(const Model& model, const Pose& pose) {
  Surface surface;
  for (const Instance& instance : instances(model, pose)) {
    const PosedSurface shown = posed_surface(model, pose, instance);
    append(surface, model.meshes[instance.mesh].surface, shown.positions, shown.mirrored);
  }
  return surface;
}

}  // namespace

LodReference::LodReference(const Model& model, std::int64_t key_pose_count, std::int64_t samples,
                           const Context& context)
    : poses_{rest_pose(model)}, samples_(samples) {
  if (key_pose_count > 0) {
    KeyPoseOptions options;
    options.count = key_pose_count;
    for (KeyPose& key : key_poses(model, options, context)) {
      if (!(key.pose == poses_.front())) poses_.push_back(std::move(key.pose));
    }
  }
  for (const Pose& pose : poses_) surfaces_.push_back(posed(model, pose));
}

LodError LodReference::error(const Model& level, const Context& context) const {
  LodError error;
  for (std::size_t p = 0; p < poses_.size(); ++p) {
    const SurfaceDistance distance =
        surface_distance(surfaces_[p], posed(level, poses_[p]), samples_, context);
    if (distance.hausdorff() < kRounding * diagonal(surfaces_[p])) continue;
    error.max = std::max(error.max, distance.hausdorff());
    error.mean = std::max(error.mean, distance.mean());
  }
  return error;
}

}  // namespace fovea
