#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "fovea/io/image_codec.h"

// Private to io: see image_codec.h, which has checked header, sizes and options before it calls these.

namespace fovea {

/// Throws Error(format) for another size than `info`, whose limits were checked.
Image8 decode_jpeg(std::span<const std::uint8_t> encoded, const ImageInfo& info);
std::vector<std::uint8_t> compress_jpeg(const Image8& image, int quality);

}  // namespace fovea
