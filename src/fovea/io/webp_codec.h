#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "fovea/io/image_codec.h"

// Private to io: see image_codec.h, which has checked header, sizes and options before it calls these.

namespace fovea {

ImageInfo webp_info(std::span<const std::uint8_t> encoded);
Image8 decode_webp(std::span<const std::uint8_t> encoded);
std::vector<std::uint8_t> compress_webp(const Image8& image, int quality);

}  // namespace fovea
