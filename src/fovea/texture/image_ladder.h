#pragma once

#include <vector>

#include "fovea/base/context.h"
#include "fovea/model/image.h"
#include "fovea/texture/encode.h"
#include "fovea/texture/image_use.h"
#include "fovea/texture/size_ladder.h"

// Shared inside Fovea, not installed.

namespace fovea {

/// No quality below is tried, in dB.
inline constexpr double kLeastLadderPsnr = 28;

/// Ways to store an image, most texels first: its size and `half_octaves` smaller ones, each 1/√2 of the one
/// before, at `psnr_db` and at lower qualities by 1 dB down to kLeastLadderPsnr. Bytes are estimated from
/// tiles (`encoding_samples`); losses are those of fewer texels (texel_loss.h), measured at the texels of
/// `weights` and averaged by them, and those of the encoding. Steps are numbered from 0 on.
///
/// About as long as to encode 1.5 million texels ten times, however large the image is. Throws
/// Error(cancelled).
std::vector<LadderStep> image_steps(const Image8& image, const ImageUse& use, TextureFormat format,
                                    double psnr_db, int half_octaves, const ImageF& weights,
                                    const Context& context);

}  // namespace fovea
