#pragma once

#include <span>

#include "fovea/base/math.h"

namespace fovea {

/// How much a shape changed between two moments, however it was moved and turned as a whole: the
/// root-mean-square distance between corresponding points, at its least over all rigid motions of one of the
/// two (Horn 1987). Mirroring is no rigid motion. `a` and `b` are as long as each other; 0 without points.
/// Exact to about 1e-8 of the points' extent. O(#points).
double rigid_distance(std::span<const Vec3d> a, std::span<const Vec3d> b);

}  // namespace fovea
