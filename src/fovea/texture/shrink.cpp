#include "fovea/texture/shrink.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

#include "fovea/base/error.h"
#include "fovea/io/image_codec.h"
#include "fovea/texture/image_use.h"

namespace fovea {

namespace {

/// As near as no encoder is asked to be: without loss.
constexpr double kMostPsnr = 99;

ImageChange::State state_of(const EncodedImage& image) {
  const ImageInfo info = image_info(image.bytes);
  return {info.mime_type.empty() ? image.mime_type : info.mime_type, info.width, info.height,
          image.bytes.size()};
}

/// Width and height that an image should have.
std::array<int, 2> wanted_size(const ImageChange::State& image, const ShrinkOptions& options) {
  double scale = options.scale;
  if (options.max_side > 0)
    scale = std::min(scale, static_cast<double>(options.max_side) / std::max(image.width, image.height));
  const auto side = [&](int n) { return std::max(1, static_cast<int>(std::lround(n * scale))); };
  return {side(image.width), side(image.height)};
}

bool has_alpha(const Image8& image) { return image.channels == 2 || image.channels == 4; }

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

struct Encoded {
  EncodedTexture texture;
  TextureFormat format;
};

/// As asked for, except that WebP, which halves the resolution of colours, gives way to JPEG, which need not,
/// where it could be near enough only without loss.
Encoded encode(const Image8& image, TextureFormat format, double psnr_db, Content content) {
  Encoded result{encode_to_psnr(image, format, psnr_db, content), format};
  if (format != TextureFormat::webp || result.texture.quality > 0 || has_alpha(image) ||
      !std::isfinite(psnr_db))
    return result;
  EncodedTexture jpeg = encode_to_psnr(image, TextureFormat::jpeg, psnr_db, content);
  if (jpeg.psnr_db >= psnr_db && jpeg.bytes.size() < result.texture.bytes.size())
    result = {std::move(jpeg), TextureFormat::jpeg};
  return result;
}

/// The nearest encoding that is smaller than `bytes`; none if the format has no quality to lower.
std::optional<Encoded> encode_below(const Image8& image, TextureFormat format, double psnr_db,
                                    Content content, std::size_t bytes) {
  constexpr double kStep = 3, kLeast = 20;  // dB; below, an image is no longer that image
  for (; psnr_db >= kLeast; psnr_db -= kStep) {
    Encoded result = encode(image, format, psnr_db, content);
    if (result.texture.bytes.size() < bytes) return result;
    if (format == TextureFormat::png) return std::nullopt;
  }
  return std::nullopt;
}

/// What becomes of one image.
struct Outcome {
  std::optional<std::vector<std::uint8_t>> bytes;
  ImageChange change;
};

Outcome kept(const EncodedImage& image, std::string why) {
  Outcome outcome;
  outcome.change.before = outcome.change.after = state_of(image);
  outcome.change.kept_because = std::move(why);
  return outcome;
}

Outcome shrunk(const EncodedImage& image, const ImageUse& use, const ShrinkOptions& options,
               const Context& context) {
  if (!use.is_used) return kept(image, "no material uses it");
  if (use.is_ambiguous) return kept(image, "materials read it in different ways");
  Outcome outcome = kept(image, "");
  const ImageChange::State& before = outcome.change.before;
  if (before.width < 1) return kept(image, "it cannot be decoded");
  const auto [width, height] = wanted_size(before, options);
  const bool same_size = width == before.width && height == before.height;
  const bool same_format = options.format == TextureOutput::keep ||
                           mime_type(format_of(before.mime_type, options.format, false)) == before.mime_type;
  if (same_size && same_format) return outcome;
  try {
    Image8 picture = decode_image(image.bytes);
    if (has_alpha(picture) && (!use.alpha_counts || is_opaque(picture))) picture = without_alpha(picture);
    picture = resized(picture, width, height, use.meaning, use.wrap_u, use.wrap_v, context);
    const TextureFormat format = format_of(before.mime_type, options.format, has_alpha(picture));
    const double psnr =
        options.psnr_db >= kMostPsnr ? std::numeric_limits<double>::infinity() : options.psnr_db;
    const Content content = use.meaning.kind == TexelMeaning::Kind::color ? Content::colors : Content::data;
    std::optional<Encoded> encoded = encode(picture, format, psnr, content);
    if (encoded->texture.bytes.size() >= before.bytes)
      encoded = encode_below(picture, format, std::min(psnr, kMostPsnr), content, before.bytes);
    if (!encoded) return kept(image, fmt::format("as {} it would be larger", mime_type(format).substr(6)));
    outcome.change.after = {mime_type(encoded->format), width, height, encoded->texture.bytes.size()};
    outcome.change.psnr_db = encoded->texture.psnr_db;
    outcome.bytes = std::move(encoded->texture.bytes);
    return outcome;
  } catch (const Error& error) {
    if (error.kind() == ErrorKind::cancelled) throw;
    return kept(image, error.message());
  }
}

}  // namespace

OptionList describe(ShrinkOptions& o) {
  return {
      {"texture-scale", "Scale the sides of all textures by this.", &o.scale, "", 1e-4, 1},
      {"max-texture", "Texels along the longer side of a texture, at most; 0 sets no limit.", &o.max_side,
       "texels", 0, 1 << 16},
      {"texture-format", "File format of textures that change; JPEG where alpha does not count.",
       choice(o.format, {"keep", "png", "jpeg", "webp"}), ""},
      {"texture-psnr",
       "How near a texture that is encoded anew has to be to what was encoded; from 99 on without loss.",
       &o.psnr_db, "dB", 20, 100},
  };
}

Shrunk shrink_textures(const Model& model, const ShrinkOptions& options, Context& context) {
  ShrinkOptions checked = options;
  check(describe(checked));
  const std::vector<ImageUse> uses = image_uses(model);
  Shrunk result{model, std::vector<ImageChange>(model.images.size())};
  for (std::size_t i = 0; i < model.images.size(); ++i) {
    context.advance_or_throw("textures", static_cast<double>(i) / static_cast<double>(model.images.size()));
    Outcome outcome = shrunk(model.images[i], uses[i], options, context);
    if (outcome.bytes) {
      result.model.images[i].bytes = std::move(*outcome.bytes);
      result.model.images[i].mime_type = outcome.change.after.mime_type;
    } else if (!outcome.change.kept_because.empty()) {
      context.report("image-kept", fmt::format("stays as it is: {}", outcome.change.kept_because),
                     fmt::format("image {}", i));
    }
    result.images[i] = std::move(outcome.change);
  }
  return result;
}

}  // namespace fovea
