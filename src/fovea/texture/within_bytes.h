#pragma once

#include <span>

#include "fovea/texture/shrinker.h"

// Private to texture/.

namespace fovea {

/// With images so small that all files together take `options.max_bytes`, which is given, at most; none is
/// larger than `limits` [#images] says. Estimates can be wrong about which image wants large sides rather
/// than high quality, and about what lit pictures make of colours and of the rest. So pictures
/// (`options.lost`, if there is one) look at sides that are halved alike, also with all files as near as each
/// other, as somebody would do who measures nothing, and at more and less for colours.
Shrunk within_bytes(const PreparedModel& prepared, std::span<const WantedImage> limits,
                    const ShrinkOptions& options, std::span<const VertexField> field, Context& context);

}  // namespace fovea
