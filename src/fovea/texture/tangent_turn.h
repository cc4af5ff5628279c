#pragma once

#include <array>
#include <span>
#include <vector>

#include "fovea/model/model.h"
#include "fovea/texture/atlas.h"

// Shared inside Fovea, not installed.

namespace fovea {

/// By how much tangent frames turn when the coordinates of triangles change from `from[i]` to `to[i]`: the
/// angle at each corner, from the old tangent towards the old bitangent, in radians. Viewers make the frames
/// of meshes without tangents from their coordinates, so normal maps have to turn against them; where a mesh
/// has tangents of its own these stay, and the angle is 0. Averaged by area over the triangles that share a
/// value, as tangents are. O(#F).
std::vector<std::array<float, 3>> tangent_turns(const Model& model, std::span<const AtlasFace> from,
                                                std::span<const AtlasFace> to);

}  // namespace fovea
