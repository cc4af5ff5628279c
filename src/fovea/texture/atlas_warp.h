#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "fovea/base/context.h"
#include "fovea/model/field.h"
#include "fovea/model/image.h"
#include "fovea/model/model.h"
#include "fovea/texture/atlas.h"
#include "fovea/texture/resize.h"
#include "fovea/texture/warp.h"

namespace fovea {

class AtlasRebake;

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
  /// What `image` was baked from for a simpler surface, to be baked from again; null if it was not.
  const Image8* original = nullptr;
};

/// A way to move the texels of an atlas.
struct AtlasWarp {
  Model model;                 ///< With moved coordinates.
  std::vector<AtlasFace> to;   ///< Where triangles are now, in the order of those before.
  std::vector<Image8> images;  ///< Of the wanted sizes.
  Warp warp;                   ///< All of the way.
  double strength =
      0;  ///< How much of the way it goes: 1, or a part that keeps triangles from folding; 0 is not at all.
  double loss = 0,
         plain_loss =
             0;  ///< What pictures lose with it and by plain resizing (texel_loss.h), mean over the surface.
};

/// Moves the texels of an atlas that may move (`Atlas::fixed_because`) and bakes its images anew through the
/// triangles (bake.h), at the wanted sizes. Of all of the way, half of it, and not moving at all it takes
/// what loses least; ways that turn a triangle over, or that bring texels of two triangles to one place, are
/// none. Without moving, images are `resized` from the filled ones.
///
/// `rebake`: where places of a simplified surface are on its original, for images that have one.
///
/// `field` as for `texture_importance`. `measured`: only if it gains; else it goes as far as it can.
/// Cost: that of the warp and of three bakes. Throws what `warp` throws.
AtlasWarp warp_atlas(const Model& model, const Atlas& atlas, std::span<const WarpedImage> images,
                     std::span<const VertexField> field, WarpAim aim, const WarpOptions& options,
                     bool measured, Context& context, const AtlasRebake* rebake = nullptr);

}  // namespace fovea
