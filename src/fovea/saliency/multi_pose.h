#pragma once

#include <span>

#include "fovea/model/field.h"

namespace fovea {

/// The base saliency S_b of a surface in several poses: at each vertex the least over all poses (Munaretti
/// 2007, section 4). [#V]. O(#poses · #V).
///
/// Throws Error(usage) without poses or if they differ in size.
VertexField multi_pose_base(std::span<const VertexField> poses);

/// The saliency of a surface over all its poses (Munaretti 2007, equation 4.1):
///   S_o = S_b + Σ_j (S_j − S_b)
/// High where the surface is salient in some poses and not in others; where all poses agree it is what they
/// say. With one pose it is that pose's. It grows with the number of poses. [#V]. O(#poses · #V).
///
/// Throws as `multi_pose_base`.
VertexField multi_pose_saliency(std::span<const VertexField> poses);

}  // namespace fovea
