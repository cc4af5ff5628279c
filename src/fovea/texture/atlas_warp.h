#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "fovea/base/context.h"
#include "fovea/model/field.h"
#include "fovea/model/image.h"
#include "fovea/model/model.h"
#include "fovea/texture/atlas.h"
#include "fovea/texture/importance.h"
#include "fovea/texture/resize.h"
#include "fovea/texture/warp.h"

namespace fovea {

/// What a warp gives texels to.
enum class WarpAim {
  balanced,   ///< What the wanted size would lose, times how large it shows and how much it is looked at.
  saliency,   ///< IM of Yang et al. 2016: saliency and distortion.
  frequency,  ///< Detail alone, relaxed without keeping cells rigid: Balmelli et al. 2002.
};

/// An image of an atlas as it is and as it is wanted.
struct WarpedImage {
  const Image8* image = nullptr;  ///< What no triangle covers filled (`fill_between`).
  TexelMeaning meaning;
  int width = 0, height = 0;  ///< Wanted.
  Wrap wrap_u = Wrap::clamp, wrap_v = Wrap::clamp;
};

/// A way to move the texels of an atlas.
struct AtlasWarp {
  Model model;                 ///< With moved coordinates.
  std::vector<AtlasFace> to;   ///< Where triangles are now, in the order of those before.
  std::vector<Image8> images;  ///< Of the wanted sizes.
  TextureImportance maps;      ///< What the warp goes by,
  ImageF importance;           ///< and what came of them.
  Warp warp;
  bool is_moved = false;  ///< Else all is where it was.
  double floor = 0;       ///< WarpOptions::floor that it came to; 0 if nothing moved.
  /// What pictures lose with it, and by plain resizing: seen_loss.h.
  double loss = 0, plain_loss = 0;
};

/// Moves the texels of an atlas that may move (`Atlas::fixed_because`) and bakes its images anew through the
/// triangles (bake.h), at the wanted sizes. A warp that brings texels of two triangles to one place or turns
/// one over is not taken; then one with twice the floor is tried, four times at most. If `measured`, nor is
/// one by which a picture is worse (seen_loss.h), and so it goes until a tenth is gained over not moving;
/// what loses least is taken. Warps are tried at half the resolution of the bake. If none is taken, images
/// are `resized` from the filled ones. Either way, if `measured`, seams are fitted (seam_fit.h) where
/// pictures lose less by it.
///
/// `field` as for `texture_importance`. Cost: that of one bake, or as many as are tried. Throws what `warp`
/// throws.
AtlasWarp warp_atlas(const Model& model, const Atlas& atlas, std::span<const WarpedImage> images,
                     std::span<const VertexField> field, WarpAim aim, const WarpOptions& options,
                     bool measured, Context& context);

/// Ways to try and to bake one warp.
struct WarpTrial {
  std::function<std::optional<AtlasWarp>(double floor)> moved;  ///< None if it cannot be taken.
  std::function<bool(AtlasWarp&)> bake;                         ///< At its best; false if it is refused then.
};

/// How `warp_atlas` looks for one: from `floor` on, twice as much each time up to 1, five times at most,
/// until one loses less than nine tenths of `plain_loss`; else the one that loses least of those that lose
/// less than it. What is good in a trial may not be when it is baked at its best: then on from there. Without
/// `plain_loss` the first that can be taken.
std::optional<AtlasWarp> find_warp(const WarpTrial& trial, double floor, std::optional<double> plain_loss);

}  // namespace fovea
