#pragma once

#include <cstddef>
#include <functional>
#include <vector>

#include "fovea/model/image.h"
#include "fovea/texture/atlas.h"
#include "fovea/texture/image_loss.h"

// Shared inside Fovea, not installed.

namespace fovea {

/// Who looks at a model's images, where that is not from all around. Both are called by several threads.
struct ImageViewers {
  /// Where their pictures look at the images of an atlas, with slopes as they are there; none if they do not.
  std::function<std::vector<ImageSights::Sight>(const Atlas&)> sights;
  /// An image of this number without what none of their pictures can show, in the same size.
  std::function<Image8(std::size_t image, const Image8& picture)> shown;
};

}  // namespace fovea
