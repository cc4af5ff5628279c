#pragma once

#include <cstdint>
#include <span>

#include "fovea/base/context.h"
#include "fovea/base/math.h"
#include "fovea/model/ids.h"
#include "fovea/texture/atlas_raster.h"

// Shared inside Fovea, not installed.

namespace fovea {

/// Where a texel comes from.
struct TexelOrigin {
  Vec2f uv;                       ///< In the old image: 0 … 1, v down.
  std::uint32_t face = kInvalid;  ///< Of the list that was drawn.
  float turn = 0;                 ///< By how much normal maps turn on the way (tangent_frame.h), in radians,
  bool is_mirrored = false;       ///< and whether their green turns over then.
};
using TexelOrigins = AtlasRaster<TexelOrigin>;

/// The place in `face` with these weights.
inline Vec2d uv_at(const AtlasFace& face, const std::array<double, 3>& weights) {
  return face.uv[0] * weights[0] + face.uv[1] * weights[1] + face.uv[2] * weights[2];
}

/// Each triangle shows what it showed in the old image: `from[i]` is the place there of `to[i]`, `turns[i]`
/// (or none at all) how its corners turn.
inline TexelOrigins texel_origins(std::span<const AtlasFace> to, std::span<const AtlasFace> from,
                                  std::span<const std::array<float, 3>> turns, int width, int height,
                                  const Context& context) {
  return rasterized<TexelOrigin>(
      to, width, height,
      [&](std::uint32_t face, const std::array<double, 3>& weights) {
        const Vec2d at = uv_at(from[face], weights);
        TexelOrigin origin{{static_cast<float>(at.x), static_cast<float>(at.y)}, face};
        if (!turns.empty()) {
          for (std::size_t k = 0; k < 3; ++k) origin.turn += static_cast<float>(weights[k]) * turns[face][k];
        }
        return origin;
      },
      context);
}

}  // namespace fovea
