#include "fovea/io/image_codec.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <string_view>

#include "fovea/base/error.h"
#include "fovea/io/jpeg_codec.h"
#include "fovea/io/png_codec.h"
#include "fovea/io/webp_codec.h"

namespace fovea {

namespace {

using Encoded = std::span<const std::uint8_t>;

constexpr std::string_view kPngMagic("\x89PNG\r\n\x1a\n", 8);
constexpr std::string_view kJpegMagic("\xFF\xD8\xFF", 3);
constexpr std::string_view kKtx2Magic("\xABKTX 20\xBB\r\n\x1A\n", 12);

bool has_at(Encoded bytes, std::size_t at, std::string_view text) {
  return bytes.size() >= at + text.size() && std::memcmp(bytes.data() + at, text.data(), text.size()) == 0;
}

std::uint32_t big_endian(Encoded bytes, std::size_t at, std::size_t count) {
  std::uint32_t value = 0;
  for (std::size_t i = 0; i < count; ++i) value = value << 8 | bytes[at + i];
  return value;
}

std::uint32_t little_endian32(Encoded bytes, std::size_t at) {
  std::uint32_t value = 0;
  for (std::size_t i = 4; i-- > 0;) value = value << 8 | bytes[at + i];
  return value;
}

/// Info of an image of that size, or of none if the size is impossible.
ImageInfo sized(const char* mime_type, std::uint32_t width, std::uint32_t height, int channels) {
  constexpr std::uint32_t kMost = 0x7FFFFFFF;
  if (width == 0 || height == 0 || width > kMost || height > kMost) return {};
  return {mime_type, static_cast<int>(width), static_cast<int>(height), channels};
}

bool has_png_transparency(Encoded bytes) {
  for (std::size_t at = kPngMagic.size(); at + 8 <= bytes.size();) {
    if (has_at(bytes, at + 4, "tRNS")) return true;
    if (has_at(bytes, at + 4, "IDAT")) return false;
    at += std::size_t{12} + big_endian(bytes, at, 4);
  }
  return false;
}

ImageInfo png_info(Encoded bytes) {
  if (bytes.size() < 33 || !has_at(bytes, 12, "IHDR")) return {};
  const int extra = has_png_transparency(bytes) ? 1 : 0;
  const auto make = [&](int channels) {
    return sized("image/png", big_endian(bytes, 16, 4), big_endian(bytes, 20, 4), channels);
  };
  switch (bytes[25]) {
    case 0: return make(1 + extra);
    case 2:
    case 3: return make(3 + extra);
    case 4: return make(2);
    case 6: return make(4);
    default: return {};
  }
}

bool is_frame_marker(std::uint8_t marker) {
  return marker >= 0xC0 && marker <= 0xCF && marker != 0xC4 && marker != 0xC8 && marker != 0xCC;
}

ImageInfo jpeg_info(Encoded bytes) {
  std::size_t at = 2;
  while (at + 4 <= bytes.size() && bytes[at] == 0xFF) {
    const std::uint8_t marker = bytes[at + 1];
    if (marker == 0xFF) {
      ++at;  // fill byte
      continue;
    }
    if (marker == 0x01 || (marker >= 0xD0 && marker <= 0xD7)) {
      at += 2;  // these stand alone
      continue;
    }
    if (is_frame_marker(marker)) {
      if (at + 10 > bytes.size()) return {};
      const int components = bytes[at + 9];
      return sized("image/jpeg", big_endian(bytes, at + 7, 2), big_endian(bytes, at + 5, 2),
                   components == 4 ? 3 : components);
    }
    at += 2 + big_endian(bytes, at + 2, 2);
  }
  return {};
}

ImageInfo ktx2_info(Encoded bytes) {
  if (bytes.size() < 28) return {};
  // Height 0 means one dimension.
  return sized("image/ktx2", little_endian32(bytes, 20), std::max(little_endian32(bytes, 24), 1u), 0);
}

void check_size(const ImageInfo& info, std::int64_t max_pixels) {
  const std::int64_t pixels = std::int64_t{info.width} * info.height;
  if (pixels <= max_pixels) return;
  throw Error(ErrorKind::limit, fmt::format("an image of {} x {} pixels exceeds the limit of {}", info.width,
                                            info.height, max_pixels));
}

void check_image(const Image8& image, int max_channels) {
  const bool is_sized =
      image.width > 0 && image.height > 0 && image.channels >= 1 && image.channels <= max_channels;
  if (is_sized && image.pixels.size() == static_cast<std::size_t>(image.width) *
                                             static_cast<std::size_t>(image.height) *
                                             static_cast<std::size_t>(image.channels)) {
    return;
  }
  throw Error(ErrorKind::usage,
              fmt::format("an image of {} x {} pixels with {} channels and {} values cannot be encoded",
                          image.width, image.height, image.channels, image.pixels.size()));
}

void check_quality(int quality, int high) {
  if (quality >= 1 && quality <= high) return;
  throw Error(ErrorKind::usage, fmt::format("{} is not an image quality", quality), {},
              fmt::format("allowed: 1..{}", high));
}

}  // namespace

ImageInfo image_info(Encoded encoded) {
  if (has_at(encoded, 0, kPngMagic)) return png_info(encoded);
  if (has_at(encoded, 0, kJpegMagic)) return jpeg_info(encoded);
  if (has_at(encoded, 0, kKtx2Magic)) return ktx2_info(encoded);
  if (has_at(encoded, 0, "RIFF") && has_at(encoded, 8, "WEBP")) return webp_info(encoded);
  return {};
}

Image8 decode_image(Encoded encoded, std::int64_t max_pixels) {
  const ImageInfo info = image_info(encoded);
  check_size(info, max_pixels);
  if (info.mime_type == "image/png") return decode_png(encoded);
  if (info.mime_type == "image/jpeg") return decode_jpeg(encoded, info);
  if (info.mime_type == "image/webp") return decode_webp(encoded);
  if (info.mime_type == "image/ktx2") throw Error(ErrorKind::unsupported, "KTX2 images cannot be decoded");
  const bool looks_known = has_at(encoded, 0, kPngMagic) || has_at(encoded, 0, kJpegMagic) ||
                           has_at(encoded, 0, kKtx2Magic) ||
                           (has_at(encoded, 0, "RIFF") && has_at(encoded, 8, "WEBP"));
  if (looks_known) throw Error(ErrorKind::format, "the header of the image is damaged");
  throw Error(ErrorKind::unsupported, "the image is not of a known format", {}, "known: PNG, JPEG, WebP");
}

ImageF decode_deep_image(Encoded encoded, std::int64_t max_pixels) {
  const ImageInfo info = image_info(encoded);
  if (info.mime_type == "image/png") {
    check_size(info, max_pixels);
    return decode_deep_png(encoded);
  }
  const Image8 image = decode_image(encoded, max_pixels);
  ImageF deep(image.width, image.height, image.channels, image.encoding);
  std::ranges::transform(image.pixels, deep.pixels.begin(),
                         [](std::uint8_t v) { return static_cast<float>(v) / 255; });
  return deep;
}

std::vector<std::uint8_t> encode_png(const Image8& image) {
  check_image(image, 4);
  return compress_png(image);
}

std::vector<std::uint8_t> encode_jpeg(const Image8& image, int quality) {
  check_image(image, 4);
  check_quality(quality, 100);
  if (image.has_alpha()) {
    throw Error(ErrorKind::usage, "JPEG has no alpha", {}, "encode as PNG or WebP");
  }
  return compress_jpeg(image, quality);
}

std::vector<std::uint8_t> encode_webp(const Image8& image, int quality) {
  check_image(image, 4);
  check_quality(quality, 101);
  return compress_webp(image, quality);
}

}  // namespace fovea
