#include "fovea/io/image_decoder.h"

#include <string>

#include "fovea/base/error.h"
#include "fovea/io/image_codec.h"

namespace fovea {

std::optional<Image8> ImageDecoder::decode(std::size_t image, Context& context) {
  try {
    return decode_image(model_.images[image].bytes);
  } catch (const Error& error) {
    const std::lock_guard lock(mutex_);
    if (!is_reported_[image])
      context.report("image-not-shown", error.message(), "/images/" + std::to_string(image));
    is_reported_[image] = true;
    return {};
  }
}

}  // namespace fovea
