#pragma once

#include <span>

#include "fovea/model/image.h"

namespace fovea {

/// Throws Error(usage) unless both have the same width, height and channels.
void check_same_shape(const Image8& a, const Image8& b);

/// Mean squared difference of stored values, 0 … 255², over all channels; over the pixels where `mask`
/// [height × width] is above 0 if there is one (0 without any). Throws Error(usage) for images of different
/// size or channels.
double mean_squared_error(const Image8& a, const Image8& b, std::span<const float> mask = {});

/// 10 log₁₀(255² / mse) in dB; infinite for 0.
double psnr(double mse);

}  // namespace fovea
