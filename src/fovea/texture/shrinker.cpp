#include "fovea/texture/shrinker.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <exception>
#include <limits>
#include <memory>
#include <optional>
#include <utility>

#include "fovea/base/error.h"
#include "fovea/base/parallel.h"
#include "fovea/io/image_codec.h"
#include "fovea/model/texture_use.h"
#include "fovea/texture/bake.h"
#include "fovea/texture/image_loss.h"
#include "fovea/texture/image_use.h"
#include "fovea/texture/image_ways.h"
#include "fovea/texture/normal_bake.h"
#include "fovea/texture/rebake.h"
#include "fovea/texture/seen_points.h"

namespace fovea {

namespace {

/// Most texels of an atlas's images together whose texels move: all are in memory at once.
constexpr std::int64_t kMostTexels = std::int64_t{1} << 28;

/// Texels along a line that have to become one for texels to move: of less, pictures show little but the
/// smaller copies of a texture, which a warp only mixes.
constexpr int kLeastReduction = 4;

WarpAim aim_of(TexelMoves moves) {
  if (moves == TexelMoves::saliency) return WarpAim::saliency;
  return moves == TexelMoves::frequency ? WarpAim::frequency : WarpAim::balanced;
}

/// Makes images smaller, one atlas after the other; the model changes as it goes.
class Shrinker {
 public:
  /// `wanted` [#images] of the prepared model.
  Shrinker(const PreparedModel& prepared, std::span<const WantedImage> wanted, const ShrinkOptions& options,
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
    const ImageSights sights = this->sights(faces);
    for (const int image : changing) resize(image, faces, sights);
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
      rebakes_normals_ = has_normals(*options_.rebake.original, *same) && has_normals(result_.model, atlas);
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

  bool bakes_normals(int image) const { return rebakes_normals_ && normal_scale(image).has_value(); }

  /// An image for the simpler surface.
  Image8 rebaked(int image, const Image8& picture) {
    if (!bakes_normals(image) || picture.channels != 3)
      return rebake_->baked(picture, uses_[index(image)].meaning, context_);
    return rebake_->baked_normals(prepared_.new_maps.contains(image) ? nullptr : &picture,
                                  *normal_scale(image), picture.width, picture.height, context_);
  }

  /// Calls f(i) for each, in parallel; if some throw, what the first did.
  template <class F>
  void for_each_of(std::size_t count, const F& f) const {
    std::vector<std::exception_ptr> thrown(count);
    parallel_for_or_throw(context_, count, 1, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        try {
          f(i);
        } catch (...) {
          thrown[i] = std::current_exception();
        }
      }
    });
    for (const std::exception_ptr& error : thrown)
      if (error) std::rethrow_exception(error);
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
      std::vector<Image8> unfilled(atlas.images.size());
      for_each_of(unfilled.size(), [&](std::size_t i) { unfilled[i] = decoded(atlas.images[i]); });
      if (rebake_ != nullptr) {
        for (std::size_t i = 0; i < unfilled.size(); ++i) unfilled[i] = rebaked(atlas.images[i], unfilled[i]);
      }
      std::vector<Image8> pictures = unfilled;
      fill_between(pictures, faces, context_);
      std::vector<WarpedImage> wanted;
      for (std::size_t i = 0; i < pictures.size(); ++i) {
        const WantedImage& size = this->wanted(atlas.images[i]);
        const ImageUse& use = uses_[index(atlas.images[i])];
        wanted.push_back({&pictures[i], use.meaning, size.width, size.height, use.wrap_u, use.wrap_v});
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
      std::vector<std::optional<ImageOutput>> outputs(pictures.size());
      if (!warp.is_moved) {
        std::vector<std::size_t> smaller;
        for (std::size_t i = 0; i < pictures.size(); ++i) {
          const int image = atlas.images[i];
          if (is_smaller(image) && std::ranges::find(changing, image) != changing.end()) smaller.push_back(i);
        }
        const ImageSights sights = this->sights(faces);
        for_each_of(smaller.size(), [&](std::size_t k) {
          const std::size_t i = smaller[k];
          const int image = atlas.images[i];
          outputs[i] =
              encoded(image, nearer_of(image, std::move(warp.images[i]), unfilled[i], sights), faces);
        });
        for (const std::size_t i : smaller) {
          set_or_keep(atlas.images[i], std::move(outputs[i]));
          std::erase(changing, atlas.images[i]);
        }
        return "it would gain nothing";
      }
      for_each_of(outputs.size(),
                  [&](std::size_t i) { outputs[i] = encoded(atlas.images[i], warp.images[i], warp.to); });
      for (std::size_t i = 0; i < outputs.size(); ++i)
        if (!outputs[i]) return fmt::format("image {} would become larger", atlas.images[i]);
      result_.model = std::move(warp.model);
      for (std::size_t i = 0; i < outputs.size(); ++i) set(atlas.images[i], std::move(*outputs[i]));
      return "";
    } catch (const Error& error) {
      if (error.kind() == ErrorKind::cancelled) throw;
      return error.message();
    }
  }

  Image8 sized(const Image8& picture, const WantedImage& size, const ImageUse& use) const {
    return size.file
               ? resized_for_way(picture, size.width, size.height, use, context_)
               : resized(picture, size.width, size.height, use.meaning, use.wrap_u, use.wrap_v, context_);
  }

  /// A smaller image: what was filled between charts unless pictures show more of what lay there: large
  /// halves keep that.
  Image8 nearer_of(int image, Image8 filled, const Image8& picture, const ImageSights& sights) const {
    const ImageUse& use = uses_[index(image)];
    Image8 unfilled = sized(picture, wanted(image), use);
    return is_nearer(unfilled, filled, picture, use, sights) ? unfilled : filled;
  }

  ImageSights sights(std::span<const AtlasFace> faces) const {
    return {result_.model, faces, field_, {kPictureSizes.begin(), kPictureSizes.end()}};
  }

  /// Whether pictures of all sizes together tell one of two smaller images less from the whole than the
  /// other.
  bool is_nearer(const Image8& one, const Image8& other, const Image8& whole, const ImageUse& use,
                 const ImageSights& sights) const {
    const ImageLoss loss(sights, whole, use, context_);
    const auto together = [&](const Image8& image) {
      double sum = 0;
      for (const double lost : loss.of(image, context_)) sum += std::log(lost + kLeastImageLoss);
      return sum;
    };
    return together(one) < together(other);
  }

  void resize(int image, std::span<const AtlasFace> faces, const ImageSights& sights) {
    try {
      const ImageUse& use = uses_[index(image)];
      const WantedImage& size = wanted(image);
      Image8 picture = decoded(image);
      const Image8 old = rebake_ != nullptr && !is_smaller(image) ? picture : Image8();
      if (rebake_ != nullptr) picture = rebaked(image, picture);
      if (is_smaller(image)) {
        Image8 filled = picture;
        if (!size.file || size.file->fill) fill_between(filled, faces, context_);
        const bool is_same = filled.pixels == picture.pixels;
        filled = sized(filled, size, use);
        picture =
            size.file || is_same ? std::move(filled) : nearer_of(image, std::move(filled), picture, sights);
      }
      finish(image, picture, faces, old);
    } catch (const Error& error) {
      if (error.kind() == ErrorKind::cancelled) throw;
      keep(image, error.message());
    }
  }

  /// Encodes the picture; `old` is what it was baked anew from, at the same size, or empty.
  void finish(int image, const Image8& picture, std::span<const AtlasFace> faces, const Image8& old = {}) {
    std::optional<ImageOutput> output = encoded(image, picture, faces);
    if (output && old.width > 0 && !prepared_.new_maps.contains(image) &&
        !is_better(image, old, picture, *output))
      return keep(image, "baked anew it would show no more");
    set_or_keep(image, std::move(output));
  }

  void set_or_keep(int image, std::optional<ImageOutput> output) {
    if (!output) return keep(image, "in the wanted format it would be larger");
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

  const PreparedModel& prepared_;
  std::span<const WantedImage> wanted_;
  const ShrinkOptions& options_;
  std::span<const VertexField> field_;
  Context& context_;
  std::unique_ptr<AtlasRebake> rebake_;  // of the atlas at hand, if it is baked anew
  bool rebakes_normals_ = false;         // in that atlas, from the original's surface
  std::vector<ImageUse> uses_;
  Shrunk result_;
};

}  // namespace

PreparedModel prepare_images(const Model& model, const RebakeOptions& options) {
  PreparedModel result{model, {}, {}, {}, {}};
  if (options.original != nullptr) {
    result.originals = find_atlases(*options.original);
    for (const Atlas& atlas : result.originals)
      if (atlas.fixed_because.empty()) bring_inside(result.model, atlas);
    if (options.new_normal_maps) result.new_maps = add_normal_maps(result.model, find_atlases(result.model));
  }
  result.atlases = find_atlases(result.model);
  for (const EncodedImage& image : result.model.images) result.files.push_back(state_of(image));
  for (const int image : result.new_maps)
    result.files[static_cast<std::size_t>(image)].bytes = std::numeric_limits<std::uint64_t>::max();
  return result;
}

Shrunk with_images(const PreparedModel& prepared, std::span<const WantedImage> wanted,
                   const ShrinkOptions& options, std::span<const VertexField> field, Context& context) {
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

}  // namespace fovea
