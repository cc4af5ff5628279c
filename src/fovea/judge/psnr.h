#pragma once

#include "fovea/judge/plane.h"

namespace fovea {

/// Mean squared difference of display values, 0 … 255², over all channels; over the pixels where `mask` is
/// above 0 if there is one (0 without any). Throws Error(usage) for images of different size or channels.
double mean_squared_error(const Image8& a, const Image8& b, const Plane* mask = nullptr);

/// 10 log₁₀(255² / mse) in dB; infinite for 0.
double psnr(double mse);

/// Area that both silhouettes cover of the area that either covers, pixels counted by coverage 0 … 255; 1 if
/// neither covers anything.
double silhouette_iou(const Image8& coverage_a, const Image8& coverage_b);

/// 1 where either coverage is above 0.
Plane foreground(const Image8& coverage_a, const Image8& coverage_b);

/// Throws Error(usage) unless both have the same width, height and channels.
void check_same_shape(const Image8& a, const Image8& b);

}  // namespace fovea
