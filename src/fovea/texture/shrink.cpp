#include "fovea/texture/shrink.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "fovea/base/error.h"
#include "fovea/model/check_fields.h"
#include "fovea/texture/rebake.h"
#include "fovea/texture/shrinker.h"
#include "fovea/texture/within_bytes.h"

namespace fovea {

namespace {

/// How an image should be but for what all may take together.
WantedImage limit_of(const ImageChange::State& image, double seen_scale, const ShrinkOptions& options) {
  double scale = options.scale;
  if (options.max_side > 0)
    scale = std::min(scale, static_cast<double>(options.max_side) / std::max(image.width, image.height));
  const bool is_seen = seen_scale < std::min(scale, 1.0);
  if (is_seen) scale = seen_scale;
  const auto side = [&](int n) {
    return std::max(1, static_cast<int>(std::lround(n * std::min(scale, 1.0))));
  };
  WantedImage wanted{side(image.width), side(image.height), options.output.psnr_db};
  const bool is_same = wanted.width == image.width && wanted.height == image.height;
  wanted.stays = is_same && keeps_format(image.mime_type, options.output);
  if (!is_same) wanted.reason = is_seen ? SizeReason::seen : SizeReason::asked;
  return wanted;
}

std::vector<WantedImage> limits_of(const PreparedModel& prepared, const ShrinkOptions& options) {
  std::vector<WantedImage> limits;
  for (std::size_t i = 0; i < prepared.files.size(); ++i)
    limits.push_back(
        limit_of(prepared.files[i], i < options.scales.size() ? options.scales[i] : 1.0, options));
  return limits;
}

void check_options(const Model& model, const ShrinkOptions& options) {
  ShrinkOptions checked = options;
  check(describe(checked));
  check(describe(checked.warp));
  if (!options.scales.empty() && options.scales.size() != model.images.size())
    throw Error(ErrorKind::usage,
                fmt::format("{} scales for {} images", options.scales.size(), model.images.size()));
  for (const double scale : options.scales) {
    if (!(scale > 0 && scale <= 1))
      throw Error(ErrorKind::usage, fmt::format("a scale of {}, not above 0 up to 1", scale));
  }
  if (!(options.shown_pixels >= 0 && std::isfinite(options.shown_pixels)))
    throw Error(ErrorKind::usage, fmt::format("pictures of {} pixels", options.shown_pixels));
  if (options.max_bytes && (options.moves == TexelMoves::saliency || options.moves == TexelMoves::frequency))
    throw Error(ErrorKind::usage, "--texture-bytes leaves texels where they are: moved ones take more bytes",
                {}, "leave out --warp, or ask for sizes instead of bytes");
}

}  // namespace

OptionList describe(RebakeOptions& o) {
  return {
      {"new-normal-maps",
       "Give materials without a normal map one for the original's shading, which is baked into those that "
       "there are anyhow; costs bytes.",
       &o.new_normal_maps, ""}};
}

OptionList describe(ShrinkOptions& o) {
  OptionList options{
      {"texture-scale", "Scale the sides of all textures by this.", &o.scale, "", 1e-4, 1},
      {"max-texture", "Texels along the longer side of a texture, at most; 0 sets no limit.", &o.max_side,
       "texels", 0, 1 << 16},
      {"texture-bytes",
       "Bytes of all image files together, at most: sizes and qualities are chosen so that pictures lose "
       "least; texels do not move.",
       &o.max_bytes, "bytes", 1},
      {"warp",
       "Move texels within textures to where they matter: balanced by what would be lost, where it shows and "
       "who looks, if a side becomes a quarter or less and it gains; or as published, by saliency (Yang et "
       "al. 2016) or frequency (Balmelli et al. 2002).",
       choice(o.moves, {"none", "balanced", "saliency", "frequency"}), ""},
  };
  const OptionList output = describe(o.output);
  options.insert(options.end(), output.begin(), output.end());
  return options;
}

Shrunk shrink_textures(const Model& model, const ShrinkOptions& options, std::span<const VertexField> field,
                       Context& context) {
  check_options(model, options);
  if (!field.empty()) check_fields(model, field);
  if (options.rebake.original != nullptr) check_simplified(*options.rebake.original, model);
  const PreparedModel prepared = prepare_images(model, options.rebake);
  const std::vector<WantedImage> limits = limits_of(prepared, options);
  Shrunk result;
  if (!options.max_bytes) {
    result = with_images(prepared, limits, options, field, context);
  } else {
    result = within_bytes(prepared, limits, options, field, context);
  }
  if (options.max_bytes && result.bytes > static_cast<std::uint64_t>(*options.max_bytes))
    context.report(
        "bytes-missed",
        fmt::format("image files take {} bytes, {} more than asked for: no smaller ones were found",
                    result.bytes, result.bytes - static_cast<std::uint64_t>(*options.max_bytes)),
        "");
  for (std::size_t i = 0; i < result.images.size(); ++i) {
    const std::string& why = result.images[i].kept_because;
    if (!why.empty())
      context.report("image-kept", fmt::format("stays as it is: {}", why), fmt::format("image {}", i));
  }
  return result;
}

Shrunk shrink_textures_within(const Model& model, std::uint64_t file_bytes, const FileForm& form,
                              ShrinkOptions options, std::span<const VertexField> field, Context& context) {
  Context quiet;
  quiet.threads = context.threads;
  const WrittenBytes before = written_bytes(model, form, quiet);
  std::uint64_t most = file_bytes - std::min(file_bytes, before.rest);
  constexpr int kTries = 4;
  for (int i = 1;; ++i) {
    options.max_bytes = static_cast<std::int64_t>(std::max<std::uint64_t>(most, 1));
    Shrunk result = shrink_textures(model, options, field, context);
    const std::uint64_t taken = written_bytes(result.model, form, quiet).total();
    // Other sizes and formats are other words in the file, too.
    if (taken <= file_bytes || i == kTries || most <= taken - file_bytes) return result;
    most -= taken - file_bytes;
  }
}

}  // namespace fovea
