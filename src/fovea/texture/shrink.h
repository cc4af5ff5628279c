#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "fovea/base/context.h"
#include "fovea/base/options.h"
#include "fovea/io/file_form.h"
#include "fovea/model/field.h"
#include "fovea/model/model.h"
#include "fovea/texture/atlas.h"
#include "fovea/texture/atlas_warp.h"
#include "fovea/texture/image_output.h"

namespace fovea {

/// How texels may move within images that become smaller.
enum class TexelMoves {
  none,
  balanced,   ///< As WarpAim::balanced, where it gains and a side becomes a quarter or less.
  saliency,   ///< As WarpAim::saliency, wherever it folds nothing.
  frequency,  ///< As WarpAim::frequency, wherever it folds nothing.
};

/// Whether images are baked anew for a surface that was simplified.
struct RebakeOptions {
  const Model* original = nullptr;  ///< What the model was simplified from; null for no baking.
  /// Materials without a normal map get one that takes over the original's shading, as those that there are
  /// do anyhow.
  bool new_normal_maps = false;
};
OptionList describe(RebakeOptions& options);

struct ShrinkOptions {
  double scale = 1;            ///< Of each side, above 0 up to 1.
  std::int64_t max_side = 0;   ///< Texels along the longer side at most; 0 for no limit.
  std::vector<double> scales;  ///< [#images] Of the sides of each at most (texel_density.h); or empty.
  std::optional<std::int64_t> max_bytes;  ///< Of all image files together.
  double shown_pixels = 0;  ///< How long the model will be in pictures, for `max_bytes`; 0 for 512 to 2048.
  /// How much pictures of a model lose, for `max_bytes` (as PictureLoss of budget/picture_loss.h), to choose
  /// between what estimates say, all sides halved alike, and more or less for colours; none: as estimates
  /// say.
  std::function<double(const Model&)> lost;
  ImageOutputOptions output;
  TexelMoves moves = TexelMoves::balanced;
  WarpOptions warp;
  RebakeOptions rebake;
};
/// Of warp and rebake they have lists of their own.
OptionList describe(ShrinkOptions& options);

/// What became of the texels of an atlas whose images change.
struct AtlasChange {
  std::vector<int> images;
  std::string fixed_because;  ///< Why its texels did not move; empty if they did.
  double floor = 0;           ///< As AtlasWarp's.
  std::int64_t rounds = 0;    ///< Of the warp,
  double last_move = 0;       ///< and how far a node went in the last, in cells.
  bool settled = false;
  double loss = 0, plain_loss = 0;  ///< As AtlasWarp's; 0 where nothing was measured,
  TextureImportance maps;           ///< and then empty, as
  ImageF importance;                ///< this is.
  std::string not_rebaked_because;  ///< Empty if its images were baked anew, or if nobody asked for it.
  double rebaked_texels = 0;        ///< Part of the texels under triangles that then came from elsewhere.
};

struct Shrunk {
  Model model;
  std::vector<ImageChange> images;  ///< [#images]
  std::vector<AtlasChange> atlases;
  std::uint64_t bytes = 0;  ///< Of all image files together.
};

/// Makes the images of a model smaller, in texels and in bytes, atlas by atlas (atlas.h).
///
/// Where texels may move, they go where they matter (atlas_warp.h), and the coordinates of triangles with
/// them; where they gain nothing by that they stay, and images are `resized` as what they stand for
/// (`image_uses`). Of images that only triangles read, all of them known, what no triangle covers is filled
/// from what is around, so that nothing comes in from between the charts; where no warp is tried, unless
/// pictures lose more by that. Then they are encoded to an error (image_output.h).
///
/// With `RebakeOptions::original` images are baked anew for a surface that was simplified: each texel shows
/// what the original had at the place that it stands for (surface_origin.h), wherever it has moved to. An
/// image that gets no fewer texels then stays unless its new file shows the simpler surface better than the
/// old one did. With `normals` also normal maps are made (normal_bake.h).
///
/// An image's file never grows. Where it would, quality is lowered if the format has one; else texels stay
/// where they were and the image what it was. Images also stay, and are reported ("image-kept"), if no
/// material uses them, if they are read in more than one way, and if they cannot be decoded (KTX2, damaged).
/// Sides are at least 1.
///
/// With `max_bytes` sizes and qualities are chosen image by image so that pictures lose least
/// (texture_budget.h), by estimates, or with `lost` by pictures; after baking anew if both are asked for; no
/// texels move, and the other limits hold too. What cannot change takes what it takes: if all is at its least
/// and still too large, that is reported
/// ("bytes-missed").
///
/// `field` [#meshes][#V] says how much is looked at, 0 … 1; empty for alike everywhere. One atlas after the
/// other, each in parallel, all of its images in memory. Throws Error(usage) for options out of range or that
/// do not go together, and for a field or an original of another model, Error(cancelled).
Shrunk shrink_textures(const Model& model, const ShrinkOptions& options, std::span<const VertexField> field,
                       Context& context);

/// The same with `max_bytes` chosen so that the whole file takes at most so many: what it takes beside its
/// images is left as it is. If that is too much already, images take as few bytes as they can. Twice the
/// cost, at most four times.
Shrunk shrink_textures_within(const Model& model, std::uint64_t file_bytes, const FileForm& form,
                              ShrinkOptions options, std::span<const VertexField> field, Context& context);

}  // namespace fovea
