#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "fovea/base/context.h"
#include "fovea/base/options.h"
#include "fovea/model/model.h"
#include "fovea/surface/pose.h"

namespace fovea {

struct KeyPoseOptions {
  std::int64_t count = 8;  ///< At most so many, 1 to 64.
};
OptionList describe(KeyPoseOptions& options);

/// A pose that stands for others near it.
struct KeyPose {
  Pose pose;
  std::string name;         ///< "rest", "animation 0 at 0.42 s", "target 3 of mesh 0".
  double distance_rel = 0;  ///< To the nearest key pose before it, of the scene's diagonal; 0 for the first.
};

/// A few poses that together show how a model's animations and morph targets deform what is seen, the most
/// typical first, then whatever differs most from those before.
///
/// They are chosen among at most 64 candidates: times of the animations that move anything shown, an
/// animation's share by its duration; the rest pose if there is no such animation; and every morph target
/// alone at weight 1 where no animation drives the weights of its mesh. Times are the keys and, since much
/// can happen between two of them, some between; or, if there are too many keys, spread evenly from the first
/// to the last. Poses are compared by `rigid_distance` of a sample of 4096 vertices, spread evenly over all
/// instances: saliency does not see what moves a shape as a whole. The first is the candidate with the least
/// mean square distance to all, so that a single key pose is the one that stands for them best. Each further
/// one is the farthest from all chosen (farthest-point sampling, Gonzalez 1985), until none is farther than
/// 1e-3 of the diagonal; so a model that only moves rigidly has one key pose. Never empty.
///
/// Throws Error(usage) for a count out of range. Parallel; the same for any number of threads. O(#V + #F)
/// and, for each candidate, O(#nodes + #keys).
std::vector<KeyPose> key_poses(const Model& model, const KeyPoseOptions& options, const Context& context);

/// A pose that is made when it is needed: those of a model with many nodes are large.
struct PoseSource {
  std::string name;  ///< As KeyPose's.
  std::function<Pose()> pose;
};

/// All that animations and morph targets do to what is seen, besides the rest pose: every animation that
/// moves anything shown at its keys and between them, at most `step_s` apart (keys nearer than half of that
/// count once), and every morph target alone at weight 1 where no animation drives the weights of its mesh.
/// At most `most` of them, evenly chosen; so of more than that steps are longer. Refers to the model.
std::vector<PoseSource> motion_poses(const Model& model, double step_s, std::size_t most);

}  // namespace fovea
