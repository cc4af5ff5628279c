#include "fovea/texture/shrink.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
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
#include "fovea/texture/normal_bake.h"
#include "fovea/texture/rebake.h"

namespace fovea {

namespace {

/// Most texels of an atlas's images together whose texels move: all are in memory at once.
constexpr std::int64_t kMostTexels = std::int64_t{1} << 28;

/// Width and height that an image should have.
std::array<int, 2> wanted_size(const ImageChange::State& image, const ShrinkOptions& options) {
  double scale = options.scale;
  if (options.max_side > 0)
    scale = std::min(scale, static_cast<double>(options.max_side) / std::max(image.width, image.height));
  const auto side = [&](int n) { return std::max(1, static_cast<int>(std::lround(n * scale))); };
  return {side(image.width), side(image.height)};
}

WarpAim aim_of(TexelMoves moves) {
  if (moves == TexelMoves::saliency) return WarpAim::saliency;
  return moves == TexelMoves::frequency ? WarpAim::frequency : WarpAim::balanced;
}

/// Makes images smaller, one atlas after the other; the model changes as it goes.
class Shrinker {
 public:
  Shrinker(const Model& model, const ShrinkOptions& options, std::span<const VertexField> field,
           Context& context)
      : options_(options), field_(field), context_(context), result_{model, {}, {}} {
    if (options.rebake.original != nullptr) {
      originals_ = find_atlases(*options.rebake.original);
      for (const Atlas& atlas : originals_)
        if (atlas.fixed_because.empty()) bring_inside(result_.model, atlas);
      if (options.rebake.normals) new_maps_ = add_normal_maps(result_.model, find_atlases(result_.model));
    }
    uses_ = image_uses(result_.model);
    for (const EncodedImage& image : result_.model.images) {
      ImageChange& change = result_.images.emplace_back();
      change.before = change.after = state_of(image);
    }
  }

  const Model& model() const { return result_.model; }

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

  void keep(int image, const std::string& why) {
    result_.images[index(image)].kept_because = why;
    context_.report("image-kept", fmt::format("stays as it is: {}", why), fmt::format("image {}", image));
  }

  Shrunk take() { return std::move(result_); }

 private:
  void change_images(const Atlas& atlas, const std::vector<int>& changing, AtlasChange& change) {
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

  /// Sets `rebake_` if the atlas's images are to be baked anew and can be.
  void start_rebake(const Atlas& atlas, AtlasChange& change) {
    if (options_.rebake.original == nullptr) return;
    const auto same = std::ranges::find(originals_, atlas.images.front(),
                                        [](const Atlas& other) { return other.images.front(); });
    if (same == originals_.end()) {
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
    return rebake_->baked_normals(new_maps_.contains(image) ? nullptr : &picture, *normal_scale(image),
                                  picture.width, picture.height, context_);
  }

  static std::size_t index(int image) { return static_cast<std::size_t>(image); }
  const ImageChange::State& before(int image) const { return result_.images[index(image)].before; }

  bool is_smaller(int image) const {
    const auto [width, height] = wanted_size(before(image), options_);
    return width != before(image).width || height != before(image).height;
  }

  /// Says why if it should but cannot.
  bool is_to_change(int image) {
    if (before(image).width < 1) {
      keep(image, "it cannot be decoded");
      return false;
    }
    if (rebake_ == nullptr && !is_smaller(image) && keeps_format(before(image).mime_type, options_.output))
      return false;
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
    const bool is_new = new_maps_.contains(image);
    return encode_output(picture, uses_[index(image)], before(image).mime_type,
                         is_new ? std::numeric_limits<std::uint64_t>::max() : before(image).bytes,
                         options_.output);
  }

  void set(int image, ImageOutput output, int width, int height) {
    ImageChange& change = result_.images[index(image)];
    change.after = {mime_type(output.format), width, height, output.texture.bytes.size()};
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
        const auto [width, height] = wanted_size(before(atlas.images[i]), options_);
        wanted.push_back({&pictures[i], uses_[index(atlas.images[i])].meaning, width, height, nullptr});
        if (rebake_ != nullptr && !bakes_normals(atlas.images[i])) wanted.back().original = &originals[i];
      }
      AtlasWarp warp = warp_atlas(result_.model, atlas, wanted, field_, aim_of(options_.moves), options_.warp,
                                  options_.moves == TexelMoves::balanced, context_, rebake_.get());
      change.rounds = warp.warp.rounds;
      change.last_move = warp.warp.last_move;
      change.settled = warp.warp.settled;
      change.loss = warp.loss;
      change.plain_loss = warp.plain_loss;
      if (warp.strength == 0) return "it would gain nothing";
      std::vector<ImageOutput> outputs;
      for (std::size_t i = 0; i < pictures.size(); ++i) {
        std::optional<ImageOutput> output = encoded(atlas.images[i], warp.images[i]);
        if (!output) return fmt::format("image {} would become larger", atlas.images[i]);
        outputs.push_back(std::move(*output));
      }
      change.strength = warp.strength;
      result_.model = std::move(warp.model);
      for (std::size_t i = 0; i < outputs.size(); ++i)
        set(atlas.images[i], std::move(outputs[i]), wanted[i].width, wanted[i].height);
      return "";
    } catch (const Error& error) {
      if (error.kind() == ErrorKind::cancelled) throw;
      return error.message();
    }
  }

  void resize(int image, std::span<const AtlasFace> faces) {
    try {
      const ImageUse& use = uses_[index(image)];
      const auto [width, height] = wanted_size(before(image), options_);
      Image8 picture = decoded(image);
      const Image8 old = rebake_ != nullptr && !is_smaller(image) ? picture : Image8();
      if (rebake_ != nullptr) {
        picture = rebaked(image, picture);
      } else if (!faces.empty() && is_smaller(image)) {
        fill_between(picture, faces, context_);
      }
      if (is_smaller(image))
        picture = resized(picture, width, height, use.meaning, use.wrap_u, use.wrap_v, context_);
      std::optional<ImageOutput> output = encoded(image, picture);
      if (!output) return keep(image, "in the wanted format it would be larger");
      if (old.width > 0 && !new_maps_.contains(image) && !is_better(image, old, picture, *output))
        return keep(image, "baked anew it would show no more");
      set(image, std::move(*output), width, height);
    } catch (const Error& error) {
      if (error.kind() == ErrorKind::cancelled) throw;
      keep(image, error.message());
    }
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

  const ShrinkOptions& options_;
  std::span<const VertexField> field_;
  Context& context_;
  std::vector<Atlas> originals_;         // of the model that was simplified
  std::unique_ptr<AtlasRebake> rebake_;  // of the atlas at hand, if it is baked anew
  std::set<int> new_maps_;               // images
  std::vector<ImageUse> uses_;
  Shrunk result_;
};

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
  ShrinkOptions checked = options;
  check(describe(checked));
  check(describe(checked.warp));
  if (!field.empty()) check_fields(model, field);
  if (options.rebake.original != nullptr) check_simplified(*options.rebake.original, model);
  Shrinker shrinker(model, options, field, context);
  const std::vector<Atlas> atlases = find_atlases(shrinker.model());
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

}  // namespace fovea
