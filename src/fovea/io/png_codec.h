#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "fovea/io/image_codec.h"

// Private to io: see image_codec.h, which has checked header, sizes and options before it calls these.

namespace fovea {

Image8 decode_png(std::span<const std::uint8_t> encoded);
/// With all bits of 16-bit images.
ImageF decode_deep_png(std::span<const std::uint8_t> encoded);
std::vector<std::uint8_t> compress_png(const Image8& image);

}  // namespace fovea
