#include "fovea/io/webp_codec.h"

#include <fmt/format.h>
#include <webp/decode.h>
#include <webp/encode.h>

#include <memory>

#include "fovea/base/error.h"

namespace fovea {

namespace {

/// WebP knows colours only: grey becomes RGB.
std::vector<std::uint8_t> with_colors(const Image8& image) {
  const std::size_t channels = static_cast<std::size_t>(image.channels);
  std::vector<std::uint8_t> out;
  out.reserve(image.pixels.size() / channels * (channels + 2));
  for (std::size_t i = 0; i < image.pixels.size(); i += channels) {
    out.insert(out.end(), 3, image.pixels[i]);
    if (channels == 2) out.push_back(image.pixels[i + 1]);
  }
  return out;
}

struct FreePicture {
  void operator()(WebPPicture* picture) const { WebPPictureFree(picture); }
};
struct ClearWriter {
  void operator()(WebPMemoryWriter* writer) const { WebPMemoryWriterClear(writer); }
};

WebPConfig make_config(int quality) {
  WebPConfig config;
  const bool lossless = quality > 100;
  if (!WebPConfigInit(&config))
    throw Error(ErrorKind::internal, "libwebp has another version than its header");
  config.quality = lossless ? 75.0f : static_cast<float>(quality);
  config.lossless = lossless ? 1 : 0;
  config.exact = lossless ? 1 : 0;  // colours under alpha 0 are data, too
  return config;
}

void import_pixels(WebPPicture& picture, const Image8& image) {
  const bool has_alpha = image.has_alpha();
  const std::vector<std::uint8_t> colors =
      image.channels < 3 ? with_colors(image) : std::vector<std::uint8_t>{};
  const std::uint8_t* pixels = image.channels < 3 ? colors.data() : image.pixels.data();
  const int stride = image.width * (has_alpha ? 4 : 3);
  const int done = has_alpha ? WebPPictureImportRGBA(&picture, pixels, stride)
                             : WebPPictureImportRGB(&picture, pixels, stride);
  if (!done) throw Error(ErrorKind::limit, "not enough memory to encode an image as WebP");
}

}  // namespace

ImageInfo webp_info(std::span<const std::uint8_t> encoded) {
  WebPBitstreamFeatures features;
  if (WebPGetFeatures(encoded.data(), encoded.size(), &features) != VP8_STATUS_OK) return {};
  if (features.width <= 0 || features.height <= 0) return {};
  return {"image/webp", features.width, features.height, features.has_alpha ? 4 : 3};
}

Image8 decode_webp(std::span<const std::uint8_t> encoded) {
  WebPBitstreamFeatures features;
  if (WebPGetFeatures(encoded.data(), encoded.size(), &features) != VP8_STATUS_OK) {
    throw Error(ErrorKind::format, "the WebP image is damaged");
  }
  if (features.has_animation) throw Error(ErrorKind::unsupported, "animated WebP images cannot be decoded");
  Image8 image(features.width, features.height, features.has_alpha ? 4 : 3, ColorEncoding::srgb);
  const auto decode = features.has_alpha ? WebPDecodeRGBAInto : WebPDecodeRGBInto;
  if (!decode(encoded.data(), encoded.size(), image.pixels.data(), image.pixels.size(),
              image.width * image.channels)) {
    throw Error(ErrorKind::format, "the WebP image is damaged or incomplete");
  }
  return image;
}

std::vector<std::uint8_t> compress_webp(const Image8& image, int quality) {
  if (image.width > WEBP_MAX_DIMENSION || image.height > WEBP_MAX_DIMENSION) {
    throw Error(ErrorKind::unsupported,
                fmt::format("WebP images end at {} pixels a side", WEBP_MAX_DIMENSION));
  }
  const WebPConfig config = make_config(quality);
  WebPPicture picture;
  if (!WebPPictureInit(&picture))
    throw Error(ErrorKind::internal, "libwebp has another version than its header");
  const std::unique_ptr<WebPPicture, FreePicture> free_picture(&picture);
  WebPMemoryWriter memory;
  WebPMemoryWriterInit(&memory);
  const std::unique_ptr<WebPMemoryWriter, ClearWriter> clear_writer(&memory);
  picture.use_argb = config.lossless;
  picture.width = image.width;
  picture.height = image.height;
  picture.writer = WebPMemoryWrite;
  picture.custom_ptr = &memory;
  import_pixels(picture, image);
  if (!WebPEncode(&config, &picture)) {
    throw Error(ErrorKind::internal,
                fmt::format("libwebp failed with code {}", static_cast<int>(picture.error_code)));
  }
  return {memory.mem, memory.mem + memory.size};
}

}  // namespace fovea
