#include "fovea/texture/encode.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "fovea/base/error.h"
#include "fovea/io/image_codec.h"
#include "fovea/model/image_error.h"

namespace fovea {

namespace {

constexpr int kTile = 64, kTilesAcross = 8;
constexpr double kNoLoss = std::numeric_limits<double>::infinity();

std::vector<std::uint8_t> encoded(const Image8& image, TextureFormat format, int quality) {
  switch (format) {
    case TextureFormat::png: return encode_png(image);
    case TextureFormat::jpeg: return encode_jpeg(image, quality);
    case TextureFormat::webp: return encode_webp(image, quality == 0 ? 101 : quality);
  }
  throw Error(ErrorKind::internal, "an unknown format of textures");
}

/// Decoders may turn grey into colours, or leave out alpha that is opaque.
Image8 with_channels(const Image8& image, int channels) {
  if (image.channels == channels) return image;
  Image8 result(image.width, image.height, channels, image.encoding);
  const bool alpha = channels == 2 || channels == 4, had_alpha = image.channels == 2 || image.channels == 4;
  const int colors = alpha ? channels - 1 : channels, had = had_alpha ? image.channels - 1 : image.channels;
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      const std::uint8_t* from = image.at(x, y);
      std::uint8_t* to = result.at(x, y);
      for (int k = 0; k < colors; ++k) to[k] = from[std::min(k, had - 1)];
      if (alpha) to[colors] = had_alpha ? from[had] : 255;
    }
  }
  return result;
}

EncodedTexture measured(const Image8& image, TextureFormat format, int quality, Content content) {
  EncodedTexture result{encoded(image, format, quality), quality, 0};
  const Image8 decoded = with_channels(decode_image(result.bytes), image.channels);
  result.psnr_db = encoding_psnr(image, decoded, content);
  return result;
}

/// Tiles from all over the image side by side, or all of it if it is not larger.
Image8 excerpt(const Image8& image) {
  constexpr int kSide = kTile * kTilesAcross;
  if (image.width <= kSide && image.height <= kSide) return image;
  const int across = std::min(kTilesAcross, std::max(image.width / kTile, 1));
  const int down = std::min(kTilesAcross, std::max(image.height / kTile, 1));
  const int width = std::min(kTile, image.width), height = std::min(kTile, image.height);
  Image8 result(across * width, down * height, image.channels, image.encoding);
  const auto start = [](int tile, int tiles, int size, int side) {
    return tiles > 1 ? static_cast<int>(std::int64_t{side - size} * tile / (tiles - 1)) : (side - size) / 2;
  };
  for (int y = 0; y < result.height; ++y) {
    for (int tile = 0; tile < across; ++tile) {
      const int from_x = start(tile, across, width, image.width);
      const int from_y = start(y / height, down, height, image.height) + y % height;
      std::copy_n(image.at(from_x, from_y), width * image.channels, result.at(tile * width, y));
    }
  }
  return result;
}

/// The lowest quality of 1 … 100 at which an image is near enough, or 100.
int lowest_quality(const Image8& image, TextureFormat format, double least_psnr_db, Content content) {
  int low = 1, high = 100;
  while (low < high) {
    const int middle = (low + high) / 2;
    if (measured(image, format, middle, content).psnr_db >= least_psnr_db) {
      high = middle;
    } else {
      low = middle + 1;
    }
  }
  return low;
}

}  // namespace

std::string mime_type(TextureFormat format) {
  switch (format) {
    case TextureFormat::png: return "image/png";
    case TextureFormat::jpeg: return "image/jpeg";
    case TextureFormat::webp: return "image/webp";
  }
  throw Error(ErrorKind::internal, "an unknown format of textures");
}

double encoding_psnr(const Image8& a, const Image8& b, Content content) {
  if (content == Content::data || a.channels < 3) return psnr(mean_squared_error(a, b));
  check_same_shape(a, b);
  double colors = 0, alpha = 0;
  const auto step = static_cast<std::size_t>(a.channels);
  for (std::size_t i = 0; i < a.pixels.size(); i += step) {
    const auto off = [&](std::size_t k) { return static_cast<double>(a.pixels[i + k]) - b.pixels[i + k]; };
    const double y = 0.299 * off(0) + 0.587 * off(1) + 0.114 * off(2);
    const double cb = 0.564 * (off(2) - y), cr = 0.713 * (off(0) - y);
    colors += (6 * y * y + cb * cb + cr * cr) / 8;
    if (step == 4) alpha += off(3) * off(3);
  }
  const double texels = static_cast<double>(a.pixels.size() / step);
  return psnr((step == 4 ? (3 * colors + alpha) / 4 : colors) / texels);
}

EncodedTexture encode_to_psnr(const Image8& image, TextureFormat format, double least_psnr_db,
                              Content content) {
  const auto without_loss = [&] { return EncodedTexture{encoded(image, format, 0), 0, kNoLoss}; };
  if (format == TextureFormat::png) return without_loss();
  if (!std::isfinite(least_psnr_db))
    return format == TextureFormat::webp ? without_loss() : measured(image, format, 100, content);
  const Image8 part = excerpt(image);
  int quality = lowest_quality(part, format, least_psnr_db, content);
  EncodedTexture result = measured(image, format, quality, content);
  // The excerpt is not the whole: some steps more may be needed.
  while (result.psnr_db < least_psnr_db && quality < 100) {
    quality = std::min(quality + 2, 100);
    result = measured(image, format, quality, content);
  }
  if (format == TextureFormat::jpeg) return result;
  if (result.psnr_db < least_psnr_db) return without_loss();
  // Drawings and even colours are often smaller without loss.
  if (encoded(part, format, 0).size() >= encoded(part, format, quality).size()) return result;
  EncodedTexture exact = without_loss();
  return exact.bytes.size() < result.bytes.size() ? exact : result;
}

}  // namespace fovea
