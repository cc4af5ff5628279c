#pragma once

#include <map>
#include <span>
#include <utility>

#include "fovea/base/context.h"
#include "fovea/model/image.h"
#include "fovea/model/model.h"
#include "fovea/texture/atlas.h"
#include "fovea/texture/resize.h"
#include "fovea/texture/surface_origin.h"

// Shared inside Fovea, not installed.

namespace fovea {

/// Throws Error(usage) unless one model may have been simplified to the other: the same meshes with the same
/// parts, and the same images.
void check_simplified(const Model& original, const Model& simplified);

/// The images of one atlas for the simpler surface. Both models must outlive this.
class AtlasRebake {
 public:
  /// `atlas` of the simplified model, whose texels may move (`Atlas::fixed_because`).
  AtlasRebake(const Model& original, const Atlas& original_atlas, const Model& simplified,
              const Atlas& atlas);

  /// An image of the original as the simpler surface needs it, of the same size. O(#texels log #F) for the
  /// first of a size. Throws Error(cancelled).
  Image8 baked(const Image8& image, const TexelMeaning& meaning, const Context& context);
  /// The normal map that lets the simpler surface be lit as the original is (normal_bake.h). `map` is that of
  /// the original, null if it has none; `scale` is that of the material.
  Image8 baked_normals(const Image8* map, double scale, int width, int height, const Context& context);

  /// How near the old image is to the new one where triangles lie: `encoding_psnr`; infinite if nothing
  /// changed.
  double likeness(const Image8& before, const Image8& after, const TexelMeaning& meaning,
                  const Context& context);
  /// Part of the texels under triangles that come from elsewhere, at this size; 0 before something was baked.
  double moved_texels() const { return moved_; }

 private:
  const TexelOrigins& origins(int width, int height, const Context& context);
  /// What no triangle covers, here or there, stays as it was: it goes on beyond charts as it was made to.
  void keep_beyond(TexelOrigins& origins, const Context& context) const;

  const Model& simplified_;
  SurfaceOrigin origin_;
  std::map<std::pair<int, int>, TexelOrigins> origins_;  // by size
  double moved_ = 0;
};

}  // namespace fovea
