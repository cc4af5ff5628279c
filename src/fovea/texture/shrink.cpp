#include "fovea/texture/shrink.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <set>
#include <utility>

#include "fovea/base/error.h"
#include "fovea/io/image_codec.h"
#include "fovea/model/check_fields.h"
#include "fovea/texture/bake.h"
#include "fovea/texture/byte_budget.h"
#include "fovea/texture/image_use.h"

namespace fovea {

namespace {

/// Most texels of an atlas's images together whose texels move: all are in memory at once.
constexpr std::int64_t kMostTexels = std::int64_t{1} << 28;

/// How often texels are moved in search of images that take no more than they may, and by how much more
/// than they are over they get less.
constexpr int kMovingRounds = 3;
constexpr double kHaste = 0.99;

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

std::vector<WantedImage> limits_of(const Model& model, const ShrinkOptions& options) {
  std::vector<WantedImage> limits;
  for (std::size_t i = 0; i < model.images.size(); ++i)
    limits.push_back(
        limit_of(state_of(model.images[i]), options.scales.empty() ? 1.0 : options.scales[i], options));
  return limits;
}

WarpAim aim_of(TexelMoves moves) {
  if (moves == TexelMoves::saliency) return WarpAim::saliency;
  return moves == TexelMoves::frequency ? WarpAim::frequency : WarpAim::balanced;
}

/// Makes images smaller, one atlas after the other; the model changes as it goes.
class Shrinker {
 public:
  Shrinker(const Model& model, std::span<const WantedImage> wanted, const ShrinkOptions& options,
           std::span<const VertexField> field, Context& context)
      : wanted_(wanted),
        options_(options),
        field_(field),
        context_(context),
        uses_(image_uses(model)),
        result_{model, {}, {}} {
    for (const EncodedImage& image : model.images) {
      ImageChange& change = result_.images.emplace_back();
      change.before = change.after = state_of(image);
    }
  }

  /// All images of an atlas, or each for itself where they cannot be handled together.
  void shrink(const Atlas& atlas) {
    std::vector<int> changing;
    for (const int image : atlas.images) {
      if (is_to_change(image)) changing.push_back(image);
    }
    if (changing.empty()) return;
    AtlasChange& change = result_.atlases.emplace_back();
    change.images = atlas.images;
    change.fixed_because = atlas.fixed_because;
    if (change.fixed_because.empty() && texels(atlas) > kMostTexels)
      change.fixed_because = "its images are too large to be in memory together";
    if (change.fixed_because.empty() && options_.moves == TexelMoves::none)
      change.fixed_because = "not asked for";
    if (change.fixed_because.empty()) change.fixed_because = move(atlas, change);
    if (change.fixed_because.empty()) return;
    const bool fill = atlas.fixed_because.empty();
    const std::vector<AtlasFace> faces = fill ? atlas_faces(result_.model, atlas) : std::vector<AtlasFace>{};
    for (const int image : changing) resize(image, faces);
  }

  void keep(int image, const std::string& why) { result_.images[index(image)].kept_because = why; }

  Shrunk take() {
    for (const EncodedImage& image : result_.model.images) result_.bytes += image.bytes.size();
    return std::move(result_);
  }

 private:
  static std::size_t index(int image) { return static_cast<std::size_t>(image); }
  const ImageChange::State& before(int image) const { return result_.images[index(image)].before; }

  const WantedImage& wanted(int image) const { return wanted_[index(image)]; }

  bool is_smaller(int image) const {
    return wanted(image).width != before(image).width || wanted(image).height != before(image).height;
  }

  /// Says why if it should but cannot.
  bool is_to_change(int image) {
    if (before(image).width < 1) {
      keep(image, "it cannot be decoded");
      return false;
    }
    if (wanted(image).stays) return false;
    if (uses_[index(image)].is_ambiguous) {
      keep(image, "materials read it in different ways");
      return false;
    }
    return true;
  }

  std::int64_t texels(const Atlas& atlas) const {
    std::int64_t sum = 0;
    for (const int image : atlas.images) sum += std::int64_t{before(image).width} * before(image).height;
    return sum;
  }

  Image8 decoded(int image) const {
    return without_idle_alpha(decode_image(result_.model.images[index(image)].bytes), uses_[index(image)]);
  }

  std::optional<ImageOutput> encoded(int image, const Image8& picture) const {
    ImageOutputOptions output = options_.output;
    output.psnr_db = wanted(image).psnr_db;
    return encode_output(picture, uses_[index(image)], before(image).mime_type, before(image).bytes, output);
  }

  void set(int image, ImageOutput output) {
    ImageChange& change = result_.images[index(image)];
    change.after = {mime_type(output.format), wanted(image).width, wanted(image).height,
                    output.texture.bytes.size()};
    change.reason = wanted(image).reason;
    change.psnr_db = output.texture.psnr_db;
    EncodedImage& file = result_.model.images[index(image)];
    file.mime_type = change.after.mime_type;
    file.bytes = std::move(output.texture.bytes);
  }

  /// Why it did not, or nothing.
  std::string move(const Atlas& atlas, AtlasChange& change) {
    if (std::ranges::none_of(atlas.images, [&](int image) { return is_smaller(image); }))
      return "no image gets fewer texels";
    try {
      const std::vector<AtlasFace> faces = atlas_faces(result_.model, atlas);
      std::vector<Image8> pictures;
      for (const int image : atlas.images) {
        pictures.push_back(decoded(image));
        fill_between(pictures.back(), faces, context_);
      }
      std::vector<WarpedImage> wanted;
      for (std::size_t i = 0; i < pictures.size(); ++i) {
        const WantedImage& size = this->wanted(atlas.images[i]);
        wanted.push_back({&pictures[i], uses_[index(atlas.images[i])].meaning, size.width, size.height});
      }
      AtlasWarp warp = warp_atlas(result_.model, atlas, wanted, field_, aim_of(options_.moves), options_.warp,
                                  options_.moves == TexelMoves::balanced, context_);
      change.rounds = warp.warp.rounds;
      change.last_move = warp.warp.last_move;
      change.settled = warp.warp.settled;
      change.floor = warp.floor;
      change.loss = warp.loss;
      change.plain_loss = warp.plain_loss;
      change.maps = std::move(warp.maps);
      change.importance = std::move(warp.importance);
      if (!warp.is_moved) return "it would gain nothing";
      std::vector<ImageOutput> outputs;
      for (std::size_t i = 0; i < pictures.size(); ++i) {
        std::optional<ImageOutput> output = encoded(atlas.images[i], warp.images[i]);
        if (!output) return fmt::format("image {} would become larger", atlas.images[i]);
        outputs.push_back(std::move(*output));
      }
      result_.model = std::move(warp.model);
      for (std::size_t i = 0; i < outputs.size(); ++i) set(atlas.images[i], std::move(outputs[i]));
      return "";
    } catch (const Error& error) {
      if (error.kind() == ErrorKind::cancelled) throw;
      return error.message();
    }
  }

  void resize(int image, std::span<const AtlasFace> faces) {
    try {
      const ImageUse& use = uses_[index(image)];
      const auto& [width, height, psnr_db, stays, reason] = wanted(image);
      Image8 picture = decoded(image);
      if (!faces.empty() && is_smaller(image)) fill_between(picture, faces, context_);
      picture = resized(picture, width, height, use.meaning, use.wrap_u, use.wrap_v, context_);
      std::optional<ImageOutput> output = encoded(image, picture);
      if (!output) return keep(image, "in the wanted format it would be larger");
      set(image, std::move(*output));
    } catch (const Error& error) {
      if (error.kind() == ErrorKind::cancelled) throw;
      keep(image, error.message());
    }
  }

  std::span<const WantedImage> wanted_;
  const ShrinkOptions& options_;
  std::span<const VertexField> field_;
  Context& context_;
  std::vector<ImageUse> uses_;
  Shrunk result_;
};

/// With images of these sizes.
Shrunk shrunk(const Model& model, std::span<const Atlas> atlases, std::span<const WantedImage> wanted,
              const ShrinkOptions& options, std::span<const VertexField> field, Context& context) {
  Shrinker shrinker(model, wanted, options, field, context);
  std::set<int> known;
  for (std::size_t a = 0; a < atlases.size(); ++a) {
    context.advance_or_throw("textures", static_cast<double>(a) / static_cast<double>(atlases.size()));
    shrinker.shrink(atlases[a]);
    known.insert(atlases[a].images.begin(), atlases[a].images.end());
  }
  for (int image = 0; image < static_cast<int>(model.images.size()); ++image) {
    if (!known.contains(image)) shrinker.keep(image, "no material uses it");
  }
  return shrinker.take();
}

/// With images as small as it takes for all files together.
Shrunk within_bytes(const Model& model, std::span<const Atlas> atlases, std::vector<WantedImage> limits,
                    ShrinkOptions options, std::span<const VertexField> field, Context& context) {
  const std::vector<ImageUse> uses = image_uses(model);
  std::vector<WantedImage> known = limits;
  for (std::size_t i = 0; i < known.size(); ++i) {
    if (uses[i].is_ambiguous) known[i] = {};
  }
  ByteBudget budget(model, atlases, known, options.output, field, context);
  const auto most = static_cast<double>(*options.max_bytes);
  double goal = most;
  for (int round = 0;; ++round) {
    // What moves is encoded at other sizes than was tried: a few times with less, then not at all.
    if (round == kMovingRounds) {
      options.moves = TexelMoves::none;
      goal = most;
    }
    std::vector<WantedImage> wanted = budget.choose(goal);
    for (std::size_t i = 0; i < wanted.size(); ++i) {
      if (wanted[i].width < 1) wanted[i] = limits[i];
    }
    Shrunk result = shrunk(model, atlases, wanted, options, field, context);
    const auto bytes = static_cast<double>(result.bytes);
    if (bytes <= most) return result;
    if (options.moves == TexelMoves::none) {
      context.report("bytes-missed",
                     fmt::format("image files take {} bytes, {} more than asked for: nothing can be smaller",
                                 result.bytes, result.bytes - static_cast<std::uint64_t>(*options.max_bytes)),
                     "");
      return result;
    }
    goal *= kHaste * most / bytes;
  }
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
}

}  // namespace

OptionList describe(ShrinkOptions& o) {
  OptionList options{
      {"texture-scale", "Scale the sides of all textures by this.", &o.scale, "", 1e-4, 1},
      {"max-texture", "Texels along the longer side of a texture, at most; 0 sets no limit.", &o.max_side,
       "texels", 0, 1 << 16},
      {"texture-bytes",
       "Bytes of all image files together, at most: sizes and qualities are chosen so that least is lost of "
       "what is seen.",
       &o.max_bytes, "bytes", 1},
      {"warp",
       "Move texels within textures that become smaller to where they matter: balanced by what would be "
       "lost, where it shows "
       "and who looks, if that gains; or as published, by saliency (Yang et al. 2016) or frequency (Balmelli "
       "et "
       "al. 2002).",
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
  const std::vector<Atlas> atlases = find_atlases(model);
  const std::vector<WantedImage> limits = limits_of(model, options);
  Shrunk result = !options.max_bytes ? shrunk(model, atlases, limits, options, field, context)
                                     : within_bytes(model, atlases, limits, options, field, context);
  for (std::size_t i = 0; i < result.images.size(); ++i) {
    const std::string& why = result.images[i].kept_because;
    if (!why.empty())
      context.report("image-kept", fmt::format("stays as it is: {}", why), fmt::format("image {}", i));
  }
  return result;
}

}  // namespace fovea
