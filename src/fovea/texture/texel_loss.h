#pragma once

#include <span>

#include "fovea/base/context.h"
#include "fovea/model/image.h"
#include "fovea/texture/resize.h"
#include "fovea/texture/texel_origin.h"

// Shared inside Fovea, not installed.

namespace fovea {

/// How much of a squared difference pictures tell: colours 1, normals 1/2, data 1/4.
float loss_weight(const TexelMeaning& meaning);

/// What a new image loses of an old one, place by place: the squared difference of stored values, 0 … 1 a
/// channel, summed over the channels that are looked at (alpha if it shows) and weighted by `loss_weight`.
/// Both are looked up between texels.
///
/// `places` is drawn in the space of the old image and says where each place is in the new one. [height ×
/// width of `places`], 0 where nothing is drawn. O(#texels), parallel.
ImageF texel_losses(const Image8& before, const Image8& after, const TexelMeaning& meaning,
                    const TexelOrigins& places, const Context& context);

}  // namespace fovea
