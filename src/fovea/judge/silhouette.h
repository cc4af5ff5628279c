#pragma once

#include "fovea/judge/plane.h"

namespace fovea {

/// Area that both silhouettes cover of the area that either covers, pixels counted by coverage 0 … 255; 1 if
/// neither covers anything.
double silhouette_iou(const Image8& coverage_a, const Image8& coverage_b);

/// 1 where either coverage is above 0.
Plane foreground(const Image8& coverage_a, const Image8& coverage_b);

}  // namespace fovea
