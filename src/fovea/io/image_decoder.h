#pragma once

#include <cstddef>
#include <mutex>
#include <optional>
#include <vector>

#include "fovea/base/context.h"
#include "fovea/model/image.h"
#include "fovea/model/model.h"

namespace fovea {

/// Decodes the images of a model and says once of each that it cannot ("image-not-shown"). Keeps no pixels.
/// May be asked from any thread. Refers to the model, which must outlive it.
class ImageDecoder {
 public:
  explicit ImageDecoder(const Model& model) : model_(model), is_reported_(model.images.size(), false) {}
  /// None for images that cannot be decoded: KTX2, damaged ones.
  std::optional<Image8> decode(std::size_t image, Context& context);

 private:
  const Model& model_;
  std::mutex mutex_;
  std::vector<bool> is_reported_;
};

}  // namespace fovea
