#pragma once

#include "fovea/base/context.h"
#include "fovea/base/math.h"
#include "fovea/model/field.h"
#include "fovea/surface/surface.h"

namespace fovea {

// Predictions from where a vertex lies and nothing else: a saliency that is worth its cost agrees with people
// better than these. [#V], from 0 at the least vertex that has area, in units of length; 0 where there is no
// area. Centres and axes are those of the surface's area, a third of each triangle's at each of its vertices.
// O(#F), parallel.

/// Nearer to the centre is more ...
VertexField near_center(const Surface& surface, const Context& context);
/// ... or farther from it.
VertexField far_from_center(const Surface& surface, const Context& context);

/// The place along the axis of largest spread; the end with the longer tail is more, as heads and limbs are
/// thinner than what they grow from.
VertexField along_main_axis(const Surface& surface, const Context& context);

/// The place along a direction of any length.
VertexField along(const Surface& surface, Vec3d direction, const Context& context);

}  // namespace fovea
