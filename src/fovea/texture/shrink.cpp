#include "fovea/texture/shrink.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <utility>

#include "fovea/base/error.h"
#include "fovea/io/image_codec.h"
#include "fovea/model/check_fields.h"
#include "fovea/model/texture_use.h"
#include "fovea/texture/bake.h"
#include "fovea/texture/image_use.h"
#include "fovea/texture/image_ways.h"
#include "fovea/texture/normal_bake.h"
#include "fovea/texture/rebake.h"
#include "fovea/texture/seen_points.h"
#include "fovea/texture/texture_budget.h"

namespace fovea {

namespace {

/// Most texels of an atlas's images together whose texels move: all are in memory at once.
constexpr std::int64_t kMostTexels = std::int64_t{1} << 28;

/// Texels along a line that have to become one for texels to move: of less, pictures show little but the
/// smaller copies of a texture, which a warp only mixes.
constexpr int kLeastReduction = 4;

/// What loses up to so many times as much as the best may be the best with finer qualities.
constexpr double kNearLoss = 1.2;
/// How many times more or less what is lost of colours is tried to count.
constexpr double kColorWeight = 4;
constexpr double kInfinity = std::numeric_limits<double>::infinity();

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

WarpAim aim_of(TexelMoves moves) {
  if (moves == TexelMoves::saliency) return WarpAim::saliency;
  return moves == TexelMoves::frequency ? WarpAim::frequency : WarpAim::balanced;
}

/// A model before its images change.
struct Prepared {
  Model model;
  std::vector<ImageChange::State> files;  // [#images] that nothing may take more than
  std::vector<Atlas> atlases;
  std::vector<Atlas> originals;  // of the model that it was simplified from, if images are baked anew
  std::set<int> new_maps;        // images that are to hold normals which no image held
};

Prepared prepare(const Model& model, const RebakeOptions& options) {
  Prepared result{model, {}, {}, {}, {}};
  if (options.original != nullptr) {
    result.originals = find_atlases(*options.original);
    for (const Atlas& atlas : result.originals)
      if (atlas.fixed_because.empty()) bring_inside(result.model, atlas);
    if (options.normals) result.new_maps = add_normal_maps(result.model, find_atlases(result.model));
  }
  result.atlases = find_atlases(result.model);
  for (const EncodedImage& image : result.model.images) result.files.push_back(state_of(image));
  for (const int image : result.new_maps)
    result.files[static_cast<std::size_t>(image)].bytes = std::numeric_limits<std::uint64_t>::max();
  return result;
}

std::vector<WantedImage> limits_of(const Prepared& prepared, const ShrinkOptions& options) {
  std::vector<WantedImage> limits;
  for (std::size_t i = 0; i < prepared.files.size(); ++i)
    limits.push_back(
        limit_of(prepared.files[i], i < options.scales.size() ? options.scales[i] : 1.0, options));
  return limits;
}

/// Makes images smaller, one atlas after the other; the model changes as it goes.
class Shrinker {
 public:
  /// `wanted` [#images] of the prepared model.
  Shrinker(const Prepared& prepared, std::span<const WantedImage> wanted, const ShrinkOptions& options,
           std::span<const VertexField> field, Context& context)
      : prepared_(prepared),
        wanted_(wanted),
        options_(options),
        field_(field),
        context_(context),
        uses_(image_uses(prepared.model)) {
    result_.model = prepared.model;
    for (const ImageChange::State& file : prepared.files) {
      ImageChange& change = result_.images.emplace_back();
      change.before = change.after = file;
    }
  }

  /// All images of an atlas, or each for itself where they cannot be handled together.
  void shrink(const Atlas& atlas) {
    AtlasChange change;
    change.images = atlas.images;
    start_rebake(atlas, change);
    std::vector<int> changing;
    for (const int image : atlas.images) {
      if (is_to_change(image)) changing.push_back(image);
    }
    if (!changing.empty() || !change.not_rebaked_because.empty()) {
      change_images(atlas, changing, change);
      if (rebake_ != nullptr) change.rebaked_texels = rebake_->moved_texels();
      result_.atlases.push_back(std::move(change));
    }
    rebake_.reset();
  }

  void keep(int image, const std::string& why) { result_.images[index(image)].kept_because = why; }

  Shrunk take() {
    for (const EncodedImage& image : result_.model.images) result_.bytes += image.bytes.size();
    for (const int image : prepared_.new_maps) result_.images[index(image)].before = {};
    return std::move(result_);
  }

 private:
  void change_images(const Atlas& atlas, std::vector<int> changing, AtlasChange& change) {
    change.fixed_because = atlas.fixed_because;
    if (change.fixed_because.empty() && texels(atlas) > kMostTexels)
      change.fixed_because = "its images are too large to be in memory together";
    if (change.fixed_because.empty() && options_.moves == TexelMoves::none)
      change.fixed_because = "not asked for";
    if (change.fixed_because.empty() && options_.max_bytes)
      change.fixed_because = "bytes are scarce, and moved texels take more of them";
    if (change.fixed_because.empty()) change.fixed_because = move(atlas, changing, change);
    if (change.fixed_because.empty()) return;
    const bool fill = atlas.fixed_because.empty();
    const std::vector<AtlasFace> faces = fill ? atlas_faces(result_.model, atlas) : std::vector<AtlasFace>{};
    for (const int image : changing) resize(image, faces);
  }

  /// Sets `rebake_` if the atlas's images are to be baked anew and can be.
  void start_rebake(const Atlas& atlas, AtlasChange& change) {
    if (options_.rebake.original == nullptr) return;
    const auto same = std::ranges::find(prepared_.originals, atlas.images.front(),
                                        [](const Atlas& other) { return other.images.front(); });
    if (same == prepared_.originals.end()) {
      change.not_rebaked_because = "the original does not have it";
    } else if (!same->fixed_because.empty()) {
      change.not_rebaked_because = same->fixed_because;
    } else if (!atlas.fixed_because.empty()) {
      change.not_rebaked_because = "once simplified, " + atlas.fixed_because;
    } else if (texels(atlas) > kMostTexels) {
      change.not_rebaked_because = "its images are too large to be in memory together";
    } else {
      rebake_ = std::make_unique<AtlasRebake>(*options_.rebake.original, *same, result_.model, atlas);
    }
  }

  /// The scale of the materials that have the image as their normal map; none if no core role does, or if
  /// they disagree.
  std::optional<double> normal_scale(int image) const {
    std::optional<double> scale;
    for (const Material& material : result_.model.materials) {
      if (image_of(result_.model, material.normal) != image) continue;
      if (scale && *scale != material.normal_scale) return std::nullopt;
      scale = material.normal_scale;
    }
    return scale;
  }

  bool bakes_normals(int image) const { return options_.rebake.normals && normal_scale(image).has_value(); }

  /// An image for the simpler surface.
  Image8 rebaked(int image, const Image8& picture) {
    if (!bakes_normals(image) || picture.channels != 3)
      return rebake_->baked(picture, uses_[index(image)].meaning, context_);
    return rebake_->baked_normals(prepared_.new_maps.contains(image) ? nullptr : &picture,
                                  *normal_scale(image), picture.width, picture.height, context_);
  }

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
    if (rebake_ == nullptr && wanted(image).stays) return false;
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

  /// As near as asked where triangles show it; `faces` are all of them, or none if they are not all known.
  std::optional<ImageOutput> encoded(int image, const Image8& picture,
                                     std::span<const AtlasFace> faces) const {
    const ImageUse& use = uses_[index(image)];
    const std::vector<std::uint8_t> counted = read_texels(faces, picture.width, picture.height, context_);
    const std::uint64_t most = before(image).bytes;
    if (const std::optional<FileChoice>& file = wanted(image).file) {
      EncodedTexture texture = encode_at(picture, file->format, file->quality, content_of(use), counted);
      if (texture.bytes.size() < most) return ImageOutput{std::move(texture), file->format};
    }
    ImageOutputOptions output = options_.output;
    output.psnr_db = wanted(image).psnr_db;
    return encode_output(picture, use, before(image).mime_type, most, output, counted);
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

  /// Why it did not, or nothing. Takes the images from `changing` that are done all the same.
  std::string move(const Atlas& atlas, std::vector<int>& changing, AtlasChange& change) {
    if (std::ranges::none_of(atlas.images, [&](int image) { return is_smaller(image); }))
      return "no image gets fewer texels";
    if (options_.moves == TexelMoves::balanced && std::ranges::none_of(atlas.images, [&](int image) {
          return wanted(image).width * kLeastReduction <= before(image).width;
        }))
      return "its images keep more than a quarter of their sides";
    try {
      const std::vector<AtlasFace> faces = atlas_faces(result_.model, atlas);
      std::vector<Image8> originals, pictures;
      for (const int image : atlas.images) {
        pictures.push_back(decoded(image));
        if (rebake_ == nullptr) {
          fill_between(pictures.back(), faces, context_);
        } else {
          originals.push_back(pictures.back());
          pictures.back() = rebaked(image, originals.back());
          fill_between(originals.back(), rebake_->origin().original_faces(), context_);
        }
      }
      std::vector<WarpedImage> wanted;
      for (std::size_t i = 0; i < pictures.size(); ++i) {
        const WantedImage& size = this->wanted(atlas.images[i]);
        const ImageUse& use = uses_[index(atlas.images[i])];
        WarpedImage& image = wanted.emplace_back(
            WarpedImage{&pictures[i], use.meaning, size.width, size.height, use.wrap_u, use.wrap_v});
        if (rebake_ != nullptr && !bakes_normals(atlas.images[i])) image.original = &originals[i];
      }
      AtlasWarp warp = warp_atlas(result_.model, atlas, wanted, field_, aim_of(options_.moves), options_.warp,
                                  options_.moves == TexelMoves::balanced, context_, rebake_.get());
      change.rounds = warp.warp.rounds;
      change.last_move = warp.warp.last_move;
      change.settled = warp.warp.settled;
      change.floor = warp.floor;
      change.loss = warp.loss;
      change.plain_loss = warp.plain_loss;
      change.maps = std::move(warp.maps);
      change.importance = std::move(warp.importance);
      if (!warp.is_moved) {
        for (std::size_t i = 0; i < pictures.size(); ++i) {
          if (is_smaller(atlas.images[i]) && std::erase(changing, atlas.images[i]) > 0)
            finish(atlas.images[i], warp.images[i], faces);
        }
        return "it would gain nothing";
      }
      std::vector<ImageOutput> outputs;
      for (std::size_t i = 0; i < pictures.size(); ++i) {
        std::optional<ImageOutput> output = encoded(atlas.images[i], warp.images[i], warp.to);
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
      const WantedImage& size = wanted(image);
      Image8 picture = decoded(image);
      const Image8 old = rebake_ != nullptr && !is_smaller(image) ? picture : Image8();
      if (rebake_ != nullptr) {
        picture = rebaked(image, picture);
      } else if (is_smaller(image) && (!size.file || size.file->fill)) {
        fill_between(picture, faces, context_);
      }
      if (is_smaller(image))
        picture = size.file ? resized_for_way(picture, size.width, size.height, use, context_)
                            : resized(picture, size.width, size.height, use.meaning, use.wrap_u, use.wrap_v,
                                      context_);
      finish(image, picture, faces, old);
    } catch (const Error& error) {
      if (error.kind() == ErrorKind::cancelled) throw;
      keep(image, error.message());
    }
  }

  /// Encodes the picture; `old` is what it was baked anew from, at the same size, or empty.
  void finish(int image, const Image8& picture, std::span<const AtlasFace> faces, const Image8& old = {}) {
    std::optional<ImageOutput> output = encoded(image, picture, faces);
    if (!output) return keep(image, "in the wanted format it would be larger");
    if (old.width > 0 && !prepared_.new_maps.contains(image) && !is_better(image, old, picture, *output))
      return keep(image, "baked anew it would show no more");
    set(image, std::move(*output));
  }

  /// Whether the new file is nearer than the old image to what was baked.
  bool is_better(int image, const Image8& old, const Image8& picture, const ImageOutput& output) {
    const ImageUse& use = uses_[index(image)];
    const auto likeness = [&](const Image8& other) {
      return rebake_->likeness(other, picture, use.meaning, context_);
    };
    if (!keeps_format(before(image).mime_type, options_.output)) return true;
    return likeness(without_idle_alpha(decode_image(output.texture.bytes), use)) > likeness(old);
  }

  const Prepared& prepared_;
  std::span<const WantedImage> wanted_;
  const ShrinkOptions& options_;
  std::span<const VertexField> field_;
  Context& context_;
  std::unique_ptr<AtlasRebake> rebake_;  // of the atlas at hand, if it is baked anew
  std::vector<ImageUse> uses_;
  Shrunk result_;
};

/// With images of these sizes.
Shrunk shrunk(const Prepared& prepared, std::span<const WantedImage> wanted, const ShrinkOptions& options,
              std::span<const VertexField> field, Context& context) {
  const std::vector<Atlas>& atlases = prepared.atlases;
  Shrinker shrinker(prepared, wanted, options, field, context);
  std::set<int> known;
  for (std::size_t a = 0; a < atlases.size(); ++a) {
    context.advance_or_throw("textures", static_cast<double>(a) / static_cast<double>(atlases.size()));
    shrinker.shrink(atlases[a]);
    known.insert(atlases[a].images.begin(), atlases[a].images.end());
  }
  for (int image = 0; image < static_cast<int>(prepared.model.images.size()); ++image) {
    if (!known.contains(image)) shrinker.keep(image, "no material uses it");
  }
  return shrinker.take();
}

TextureBudget texture_budget(const Prepared& prepared, std::span<const WantedImage> limits,
                             const ShrinkOptions& options, std::span<const VertexField> field,
                             Context& context) {
  std::vector<double> pixels(kPictureSizes.begin(), kPictureSizes.end());
  if (options.shown_pixels > 0) pixels = sights_of(options.shown_pixels);
  return {prepared.model, prepared.files, prepared.atlases, limits,
          options.output, field,          pixels,           static_cast<double>(*options.max_bytes),
          context};
}

/// The best by pictures of what is tried.
class PictureChoice {
 public:
  using Make = std::function<Shrunk(std::span<const WantedImage>)>;
  PictureChoice(Make make, const ShrinkOptions& options)
      : make_(std::move(make)), lost_(options.lost), most_(static_cast<std::uint64_t>(*options.max_bytes)) {}

  struct Tried {
    double loss = kInfinity;
    std::uint64_t bytes = std::numeric_limits<std::uint64_t>::max();
  };
  /// Nothing is tried of no images, and what takes too many bytes is not taken but for want of anything else.
  Tried consider(std::span<const WantedImage> wanted) {
    if (wanted.empty()) return {};
    Shrunk made = make_(wanted);
    const bool is_first = least_ == kInfinity;
    if (!lost_ || made.bytes > most_) {
      if (is_first) best_ = std::move(made);
      return {};
    }
    const Tried tried{lost_(made.model), made.bytes};
    if (is_first || tried.loss < least_) best_ = std::move(made);
    least_ = std::min(least_, tried.loss);
    return tried;
  }

  double least() const { return least_; }
  Shrunk take() { return std::move(best_); }

 private:
  Make make_;
  const std::function<double(const Model&)>& lost_;
  std::uint64_t most_;
  Shrunk best_;
  double least_ = kInfinity;
};

/// With images as small as it takes for all files together, from the images as they are. Estimates can be
/// wrong about which image wants large sides rather than high quality, and about what lit pictures make of
/// colours and of the rest. So pictures look at sides that are halved alike, as somebody would do who
/// measures nothing, and at more and less for colours.
Shrunk within_bytes(const Prepared& prepared, std::span<const WantedImage> limits,
                    const ShrinkOptions& options, std::span<const VertexField> field, Context& context) {
  const auto most = static_cast<double>(*options.max_bytes);
  TextureBudget budget = texture_budget(prepared, limits, options, field, context);
  PictureChoice choice(
      [&](std::span<const WantedImage> wanted) { return shrunk(prepared, wanted, options, field, context); },
      options);
  const PictureChoice::Tried first = choice.consider(budget.choose(most, true));
  if (first.loss == kInfinity || first.loss == 0) return choice.take();
  // Whether sides are halved, and how often; and what colours count.
  std::optional<int> halvings, nearest;
  double weight = 1, least_halved = kInfinity;
  for (int times = 0; times <= kMostHalvings; ++times) {
    const PictureChoice::Tried tried = choice.consider(budget.choose_halved(most, times, false));
    if (tried.loss < least_halved) nearest = times;
    least_halved = std::min(tried.loss, least_halved);
    if (static_cast<double>(tried.bytes) < most / 2) break;  // fewer texels only lose more
  }
  if (least_halved < kNearLoss * choice.least()) halvings = nearest;
  const auto chosen = [&](bool refine) {
    return halvings ? budget.choose_halved(most, *halvings, refine) : budget.choose(most, refine);
  };
  for (const double tried : {kColorWeight, 1 / kColorWeight}) {
    const double before = choice.least();
    if (!budget.set_color_weight(tried)) break;
    choice.consider(chosen(false));
    if (choice.least() == before) continue;
    weight = tried;
    break;  // there is nothing on the other side then
  }
  budget.set_color_weight(weight);
  if (halvings || weight != 1) choice.consider(chosen(true));
  return choice.take();
}

/// The same for images that are baked anew: first that, at their own sizes and without loss.
Shrunk rebaked_within_bytes(Prepared prepared, std::vector<WantedImage> limits, ShrinkOptions options,
                            std::span<const VertexField> field, Context& context) {
  std::vector<WantedImage> whole;
  for (const ImageChange::State& file : prepared.files)
    whole.push_back({file.width, file.height, 0, true, SizeReason::none, FileChoice{}});
  Prepared grown = prepared;
  for (ImageChange::State& file : grown.files) file.bytes = std::numeric_limits<std::uint64_t>::max();
  Shrunk baked = shrunk(grown, whole, options, field, context);
  for (std::size_t i = 0; i < limits.size(); ++i) {
    if (baked.model.images[i] != prepared.model.images[i]) limits[i].stays = false;
  }
  const std::vector<EncodedImage> files = std::move(prepared.model.images);
  prepared.model = std::move(baked.model);
  options.rebake = {};
  Shrunk result = within_bytes(prepared, limits, options, field, context);
  result.atlases = std::move(baked.atlases);
  // Where nothing is smaller than the file was, that stays.
  for (std::size_t i = 0; i < files.size(); ++i) {
    std::vector<std::uint8_t>& bytes = result.model.images[i].bytes;
    if (bytes.size() <= prepared.files[i].bytes) continue;
    result.bytes -= bytes.size() - files[i].bytes.size();
    result.model.images[i] = files[i];
  }
  return result;
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
  return {{"bake-normals",
           "Bake the original's shading into normal maps, new ones where a material has none; costs bytes.",
           &o.normals, ""}};
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
  const Prepared prepared = prepare(model, options.rebake);
  const std::vector<WantedImage> limits = limits_of(prepared, options);
  Shrunk result;
  if (!options.max_bytes) {
    result = shrunk(prepared, limits, options, field, context);
  } else if (options.rebake.original == nullptr) {
    result = within_bytes(prepared, limits, options, field, context);
  } else {
    result = rebaked_within_bytes(prepared, limits, options, field, context);
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
