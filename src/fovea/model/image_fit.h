#pragma once

#include <cstdint>

#include "fovea/base/context.h"
#include "fovea/model/image.h"

namespace fovea {

/// The image reduced by the smallest whole factor that leaves `most_texels` at most: means of boxes of
/// stored values. As it is if it fits. O(#texels), parallel.
Image8 fitted(const Image8& image, std::int64_t most_texels, const Context& context);

}  // namespace fovea
