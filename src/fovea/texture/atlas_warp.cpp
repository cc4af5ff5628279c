#include "fovea/texture/atlas_warp.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <tuple>
#include <utility>

#include "fovea/base/parallel.h"
#include "fovea/texture/bake.h"
#include "fovea/texture/importance.h"
#include "fovea/texture/moved_values.h"
#include "fovea/texture/seam_fit.h"
#include "fovea/texture/seen_loss.h"
#include "fovea/texture/tangent_frame.h"

namespace fovea {

namespace {

/// Longest side of the maps that losses are measured on, and of those that steer the warp, in texels.
constexpr int kMapSide = 512, kSteeringSide = 128;
/// Warps that are tried, each less ambitious than the one before.
constexpr int kAttempts = 5;
/// Of what plain resizing loses: with so little, no other warp is looked for.
constexpr double kGoodLoss = 0.9;
/// An image is baked at so many times its new size, at least and at most, and then resized; to try a warp, at
/// a part of that.
constexpr int kLeastOversampling = 2, kMostOversampling = 8, kTrialPart = 2;
/// And of that size at most, in texels along the longer side, if it is more than the least.
constexpr int kLongestBaked = 4096;
/// Part of the texels that may show two places at once; rasterisation alone makes some.
constexpr double kMostConflicts = 5e-3;

/// So that it is baked at the size that it had, within reason, or at a `part` of that.
int oversampling(const WarpedImage& image, int part) {
  const int longest = std::max(image.width, image.height);
  const int wanted = (image.image->width + image.width - 1) / image.width;
  const int best =
      std::clamp(std::min(wanted, kLongestBaked / longest), kLeastOversampling, kMostOversampling);
  return std::max(best / part, kLeastOversampling);
}

/// Part of the drawn texels that show more than one place of the old image, a texel or more apart.
double conflicts(std::span<const AtlasFace> from, std::span<const AtlasFace> to,
                 const TexelOrigins& origins) {
  std::size_t bad = 0, drawn = 0;
  const auto size = Vec2d{static_cast<double>(origins.width), static_cast<double>(origins.height)};
  for (std::uint32_t f = 0; f < to.size(); ++f) {
    std::array<Vec2d, 3> triangle;
    for (std::size_t k = 0; k < 3; ++k) triangle[k] = {to[f].uv[k].x * size.x, to[f].uv[k].y * size.y};
    const Barycentric barycentric(triangle);
    for_texel_rows(triangle, 1, [&](std::int64_t y, std::int64_t begin, std::int64_t end) {
      if (y < 0 || y >= origins.height) return;
      for (auto x = std::max<std::int64_t>(begin, 0); x < std::min<std::int64_t>(end, origins.width); ++x) {
        const TexelOrigin& first = origins.texels[origins.index(static_cast<int>(x), static_cast<int>(y))];
        if (first.face == f) ++drawn;
        if (first.face == f) continue;
        const Vec2d center{static_cast<double>(x) + 0.5, static_cast<double>(y) + 0.5};
        const Vec2d at = uv_at(from[f], clamped(barycentric.at(center)));
        const double dx = (at.x - static_cast<double>(first.uv.x)) * size.x,
                     dy = (at.y - static_cast<double>(first.uv.y)) * size.y;
        bad += dx * dx + dy * dy > 1;
      }
    });
  }
  return drawn > 0 ? static_cast<double>(bad) / static_cast<double>(drawn) : 0;
}

/// Means over squares of drawn texels, which then go on a little beyond where something is drawn.
ImageF reduced(const ImageF& map, std::span<const std::uint8_t> drawn, int factor) {
  ImageF result((map.width + factor - 1) / factor, (map.height + factor - 1) / factor, 1, map.encoding);
  ImageF count = result;
  for (int y = 0; y < map.height; ++y) {
    for (int x = 0; x < map.width; ++x) {
      if (drawn[static_cast<std::size_t>(y) * static_cast<std::size_t>(map.width) +
                static_cast<std::size_t>(x)] == 0)
        continue;
      *result.at(x / factor, y / factor) += *map.at(x, y);
      *count.at(x / factor, y / factor) += 1;
    }
  }
  for (std::size_t i = 0; i < result.pixels.size(); ++i) {
    if (count.pixels[i] > 0) result.pixels[i] /= count.pixels[i];
  }
  return result;
}

ImageF importance_of(const TextureImportance& maps, WarpAim aim) {
  switch (aim) {
    case WarpAim::saliency: return saliency_importance(maps);
    case WarpAim::frequency: return frequency_importance(maps);
    case WarpAim::balanced: break;
  }
  return balanced_importance(maps);
}

std::vector<MipMap> mip_maps(std::span<const WarpedImage> images, const Context& context) {
  std::vector<MipMap> result(images.size());
  parallel_for_or_throw(context, images.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) result[i] = mip_map(*images[i].image, images[i].meaning);
  });
  return result;
}

std::vector<TexelMeaning> meanings(std::span<const WarpedImage> images) {
  std::vector<TexelMeaning> result;
  for (const WarpedImage& image : images) result.push_back(image.meaning);
  return result;
}

class Warper {
 public:
  Warper(const Model& model, const Atlas& atlas, std::span<const WarpedImage> images,
         std::span<const VertexField> field, Context& context)
      : model_(model),
        atlas_(atlas),
        images_(images),
        context_(context),
        from_(atlas_faces(model, atlas)),
        maps_(texture_importance(model, atlas, field, kMapSide, context)),
        seen_loss_(model, from_, mip_maps(images, context), meanings(images), field) {}

  AtlasWarp unmoved() {
    AtlasWarp result;
    result.to = from_;
    for (const WarpedImage& image : images_)
      result.images.push_back(resized(*image.image, image.width, image.height, image.meaning, image.wrap_u,
                                      image.wrap_v, context_));
    places_ = texel_origins(from_, from_, {}, maps_.coverage.width, maps_.coverage.height, context_);
    maps_.detail = seen_loss_.map(places_, result.images, context_);
    plain_loss_ = seen_loss_.of(from_, {}, result.images, context_);
    result.loss = result.plain_loss = plain_loss_.mean();
    return result;
  }

  /// After `unmoved`.
  ImageF importance(WarpAim aim) const {
    const int factor = std::max(1, std::max(maps_.coverage.width, maps_.coverage.height) / kSteeringSide);
    const auto small = [&](const ImageF& map) { return reduced(map, places_.drawn, factor); };
    const TextureImportance maps{small(maps_.saliency), small(maps_.distortion), small(maps_.coverage),
                                 small(maps_.detail)};
    return importance_of(maps, aim);
  }
  const TextureImportance& maps() const { return maps_; }
  /// Whether pictures see no difference without a warp either; after `unmoved`.
  bool loses_nothing() const { return plain_loss_.is_nothing(); }

  /// Where a warp takes the triangles; none if it folds something over.
  std::optional<AtlasWarp> moved(Warp warp) const {
    AtlasWarp result;
    result.is_moved = true;
    result.warp = std::move(warp);
    const auto at = moved_values(from_, InverseWarp(result.warp.grid));
    if (!at) return std::nullopt;
    result.to = from_;
    for (AtlasFace& face : result.to)
      for (std::size_t k = 0; k < 3; ++k) face.uv[k] = (*at)[face.value[k]];
    result.model = with_moved_coordinates(model_, atlas_, from_, result.to);
    return result;
  }

  /// After `unmoved`. Bakes the images, at a `part` of the sizes that are best, and sees what is lost. False
  /// if texels of several triangles would lie on each other, or, if `measured`, pictures of some size lose by
  /// it.
  bool bake(AtlasWarp& warp, int part, bool measured) const {
    const auto turns = this->turns(warp);
    warp.images.assign(images_.size(), {});
    std::optional<TexelOrigins> origins;
    PictureLosses loss;
    const auto bake_and_look = [&](std::span<const std::size_t> images) {
      if (images.empty()) return true;
      if (!bake(warp, part, images, turns, origins)) return false;
      loss = seen_loss_.of(warp.to, turns, warp.images, context_);
      return !measured || !loss.is_worse_somewhere(plain_loss_);
    };
    std::vector<std::size_t> colors, others;
    for (std::size_t i = 0; i < images_.size(); ++i)
      (measured && images_[i].meaning.kind == TexelMeaning::Kind::color ? colors : others).push_back(i);
    // They alone tell of most warps that they are worse.
    if (!bake_and_look(colors) || !bake_and_look(others)) return false;
    warp.loss = loss.mean();
    return true;
  }

  /// Seams of the smaller images as they were in the whole ones, if pictures lose less by it.
  void fit_seams(AtlasWarp& warp) const {
    const SeamFit fit(model_, from_, warp.to);
    if (!fit.has_seams()) return;
    std::vector<Image8> fitted = warp.images;
    parallel_for_or_throw(context_, fitted.size(), 1, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        if (SeamFit::is_for(images_[i].meaning))
          fit.fit(fitted[i], seen_loss_.image(i), images_[i].wrap_u, images_[i].wrap_v, context_);
      }
    });
    const double loss = seen_loss_.of(warp.to, turns(warp), fitted, context_).mean();
    if (loss >= warp.loss) return;
    warp.loss = loss;
    warp.images = std::move(fitted);
  }

 private:
  /// Some of the images. `origins` are kept for the next of the same size. False if texels of several
  /// triangles would lie on each other.
  bool bake(AtlasWarp& warp, int part, std::span<const std::size_t> wanted,
            std::span<const std::array<float, 3>> turns, std::optional<TexelOrigins>& origins) const {
    for (const std::size_t first : wanted) {
      if (warp.images[first].width > 0) continue;
      const WarpedImage& image = images_[first];
      const int factor = oversampling(image, part);
      const int width = factor * image.width, height = factor * image.height;
      if (!origins || origins->width != width || origins->height != height) {
        origins = texel_origins(warp.to, from_, turns, width, height, context_);
        if (conflicts(from_, warp.to, *origins) > kMostConflicts) return false;
      }
      const std::vector<std::size_t> alike = images_like(first, wanted);
      std::vector<BakeSource> sources;
      for (const std::size_t i : alike)
        sources.push_back({images_[i].image, &seen_loss_.image(i), images_[i].meaning});
      const std::vector<Image8> large =
          baked(sources, *origins, texel_slopes(warp.to, from_, width, height), context_);
      for (std::size_t k = 0; k < alike.size(); ++k)
        warp.images[alike[k]] = resized(large[k], image.width, image.height, sources[k].meaning, image.wrap_u,
                                        image.wrap_v, context_);
    }
    return true;
  }

  /// How normal maps turn at corners.
  std::vector<std::array<float, 3>> turns(const AtlasWarp& warp) const {
    if (!warp.is_moved) return {};
    return tangent_turns(model_, from_, warp.to);
  }
  /// Those that can be baked together with one of them.
  std::vector<std::size_t> images_like(std::size_t first, std::span<const std::size_t> images) const {
    const auto shape = [&](std::size_t i) {
      const WarpedImage& image = images_[i];
      return std::tuple(image.image->width, image.image->height, image.width, image.height, image.wrap_u,
                        image.wrap_v);
    };
    std::vector<std::size_t> alike;
    for (const std::size_t i : images) {
      if (shape(i) == shape(first)) alike.push_back(i);
    }
    return alike;
  }

  const Model& model_;
  const Atlas& atlas_;
  std::span<const WarpedImage> images_;
  Context& context_;
  std::vector<AtlasFace> from_;
  TextureImportance maps_;
  SeenLoss seen_loss_;
  PictureLosses plain_loss_{};
  TexelOrigins places_;
};

}  // namespace

std::optional<AtlasWarp> find_warp(const WarpTrial& trial, double floor, std::optional<double> plain_loss) {
  std::optional<AtlasWarp> found;
  for (int attempt = 0; attempt < kAttempts && floor <= 1;) {
    for (bool is_good = false; !is_good && attempt < kAttempts && floor <= 1; ++attempt, floor *= 2) {
      std::optional<AtlasWarp> next = trial.moved(floor);
      if (!next || (plain_loss && next->loss >= (found ? found->loss : *plain_loss))) continue;
      found = std::move(next);
      found->floor = floor;
      is_good = !plain_loss || found->loss < kGoodLoss * *plain_loss;
    }
    if (found && trial.bake(*found)) return found;
    found.reset();
  }
  return found;
}

AtlasWarp warp_atlas(const Model& model, const Atlas& atlas, std::span<const WarpedImage> images,
                     std::span<const VertexField> field, WarpAim aim, const WarpOptions& options,
                     bool measured, Context& context) {
  Warper warper(model, atlas, images, field, context);
  AtlasWarp best = warper.unmoved();
  best.model = model;
  const double plain_loss = best.loss;
  if (warper.loses_nothing()) return best;
  ImageF importance = warper.importance(aim);
  WarpOptions asked = options;
  if (aim == WarpAim::frequency) asked.rigidity = 0;
  for (const WarpedImage& image : images) {
    asked.joined_u = asked.joined_u || image.wrap_u == Wrap::repeat;
    asked.joined_v = asked.joined_v || image.wrap_v == Wrap::repeat;
  }
  const bool is_final = std::ranges::all_of(images, [](const WarpedImage& image) {
    return oversampling(image, kTrialPart) == oversampling(image, 1);
  });
  const auto moved = [&](double floor) {
    asked.floor = floor;
    std::optional<AtlasWarp> next = warper.moved(warp(importance, asked, context));
    if (next && !warper.bake(*next, kTrialPart, measured)) next.reset();
    return next;
  };
  const auto bake = [&](AtlasWarp& found) { return is_final || warper.bake(found, 1, measured); };
  const auto to_beat = measured ? std::optional(plain_loss) : std::nullopt;
  if (auto found = find_warp({moved, bake}, options.floor, to_beat)) best = std::move(*found);
  if (measured) warper.fit_seams(best);
  best.plain_loss = plain_loss;
  best.maps = warper.maps();
  best.importance = std::move(importance);
  return best;
}

}  // namespace fovea
