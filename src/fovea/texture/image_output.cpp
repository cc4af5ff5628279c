#include "fovea/texture/image_output.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "fovea/io/image_codec.h"

namespace fovea {

namespace {

/// As near as no encoder is asked to be: without loss.
constexpr double kMostPsnr = 99;

bool is_opaque(const Image8& image) {
  const auto step = static_cast<std::size_t>(image.channels);
  for (std::size_t i = step - 1; i < image.pixels.size(); i += step) {
    if (image.pixels[i] != 255) return false;
  }
  return true;
}

Image8 without_alpha(const Image8& image) {
  Image8 result(image.width, image.height, image.channels - 1, image.encoding);
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) std::copy_n(image.at(x, y), result.channels, result.at(x, y));
  return result;
}

TextureFormat format_of(const std::string& type, TextureOutput wanted, bool alpha) {
  switch (wanted) {
    case TextureOutput::webp: return TextureFormat::webp;
    case TextureOutput::png: return TextureFormat::png;
    case TextureOutput::jpeg: return alpha ? TextureFormat::png : TextureFormat::jpeg;
    case TextureOutput::keep: break;
  }
  if (type == "image/webp") return TextureFormat::webp;
  return type == "image/jpeg" && !alpha ? TextureFormat::jpeg : TextureFormat::png;
}

/// As asked for, or JPEG instead of WebP.
ImageOutput encode(const Image8& image, TextureFormat format, double psnr_db, Content content,
                   std::span<const std::uint8_t> counted) {
  ImageOutput result{encode_to_psnr(image, format, psnr_db, content, counted), format};
  if (format != TextureFormat::webp || result.texture.quality > 0 || image.has_alpha() ||
      !std::isfinite(psnr_db))
    return result;
  EncodedTexture jpeg = encode_to_psnr(image, TextureFormat::jpeg, psnr_db, content, counted);
  if (jpeg.psnr_db >= psnr_db && jpeg.bytes.size() < result.texture.bytes.size())
    result = {std::move(jpeg), TextureFormat::jpeg};
  return result;
}

/// The nearest encoding that is smaller than `bytes`; none if the format has no quality to lower.
std::optional<ImageOutput> encode_below(const Image8& image, TextureFormat format, double psnr_db,
                                        Content content, std::span<const std::uint8_t> counted,
                                        std::size_t bytes) {
  constexpr double kStep = 3, kLeast = 20;  // dB; below, an image is no longer that image
  for (; psnr_db >= kLeast; psnr_db -= kStep) {
    ImageOutput result = encode(image, format, psnr_db, content, counted);
    if (result.texture.bytes.size() < bytes) return result;
    if (format == TextureFormat::png) return std::nullopt;
  }
  return std::nullopt;
}

}  // namespace

OptionList describe(ImageOutputOptions& o) {
  return {
      {"texture-format", "File format of textures that change; JPEG where alpha does not count.",
       choice(o.format, {"keep", "png", "jpeg", "webp"}), ""},
      {"texture-psnr",
       "How near a texture that is encoded anew has to be to what was encoded, where --texture-bytes does "
       "not "
       "choose; from 99 on without loss.",
       &o.psnr_db, "dB", 20, 100},
  };
}

ImageChange::State state_of(const EncodedImage& image) {
  const ImageInfo info = image_info(image.bytes);
  return {info.mime_type.empty() ? image.mime_type : info.mime_type, info.width, info.height,
          image.bytes.size()};
}

TextureFormat output_format(const Image8& image, const std::string& mime_type,
                            const ImageOutputOptions& options) {
  return format_of(mime_type, options.format, image.has_alpha());
}

Content content_of(const ImageUse& use) {
  return use.meaning.kind == TexelMeaning::Kind::color ? Content::colors : Content::data;
}

bool keeps_format(const std::string& type, const ImageOutputOptions& options) {
  return options.format == TextureOutput::keep || mime_type(format_of(type, options.format, false)) == type;
}

Image8 without_idle_alpha(Image8 image, const ImageUse& use) {
  return image.has_alpha() && (!use.alpha_counts || is_opaque(image)) ? without_alpha(image)
                                                                      : std::move(image);
}

std::optional<ImageOutput> encode_output(const Image8& image, const ImageUse& use,
                                         const std::string& mime_type, std::uint64_t most_bytes,
                                         const ImageOutputOptions& options,
                                         std::span<const std::uint8_t> counted) {
  const TextureFormat format = output_format(image, mime_type, options);
  const double psnr =
      options.psnr_db >= kMostPsnr ? std::numeric_limits<double>::infinity() : options.psnr_db;
  const Content content = content_of(use);
  ImageOutput output = encode(image, format, psnr, content, counted);
  if (output.texture.bytes.size() < most_bytes) return output;
  return encode_below(image, format, std::min(psnr, kMostPsnr), content, counted, most_bytes);
}

}  // namespace fovea
