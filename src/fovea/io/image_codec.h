#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "fovea/model/image.h"

namespace fovea {

/// What can be told from an encoded image's header without decoding it.
struct ImageInfo {
  std::string mime_type;  ///< By content: image/png, image/jpeg, image/webp, image/ktx2; else empty.
  int width = 0;
  int height = 0;
  int channels = 0;  ///< 0 if the header does not tell.
};

/// Never throws: unknown or damaged headers give an empty mime_type.
ImageInfo image_info(std::span<const std::uint8_t> encoded);

/// Decodes PNG (16 bits reduced to 8, palettes expanded), JPEG and WebP.
/// Throws Error(format) for damaged data, Error(unsupported) for other formats, Error(limit) beyond
/// `max_pixels`.
Image8 decode_image(std::span<const std::uint8_t> encoded, std::int64_t max_pixels = std::int64_t{1} << 28);
/// The same as 0 … 1, with all bits of PNG images of 16: for heights, of which 256 are steps.
ImageF decode_deep_image(std::span<const std::uint8_t> encoded,
                         std::int64_t max_pixels = std::int64_t{1} << 28);

std::vector<std::uint8_t> encode_png(const Image8& image);
/// quality 1..100; 1 or 3 channels (alpha is not JPEG's: Error(usage)). No chroma subsampling from
/// quality 90 on.
std::vector<std::uint8_t> encode_jpeg(const Image8& image, int quality);
/// quality 1..100, or 101 for lossless.
std::vector<std::uint8_t> encode_webp(const Image8& image, int quality);

}  // namespace fovea
