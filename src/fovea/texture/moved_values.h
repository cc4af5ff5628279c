#pragma once

#include <optional>
#include <span>
#include <vector>

#include "fovea/base/math.h"
#include "fovea/texture/atlas.h"
#include "fovea/texture/warp.h"

// Shared inside Fovea, not installed.

namespace fovea {

/// [#values of the atlas] Where a warp takes the coordinates of triangles; none if some would turn over.
///
/// Between their corners triangles stay straight, so thin ones can turn over though the warp does not fold:
/// their corners are moved apart until they are a little high again, in their proportion. Triangles that are
/// lines stay lines, if along an axis, or with two corners at one place: viewers find no tangents for them,
/// and would find any once they had an area. O(#F) a pass, at most a hundred passes.
std::optional<std::vector<Vec2d>> moved_values(std::span<const AtlasFace> faces, const InverseWarp& warp);

}  // namespace fovea
