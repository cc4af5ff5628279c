#pragma once

#include <optional>

#include "fovea/base/context.h"
#include "fovea/model/image.h"
#include "fovea/model/material.h"

namespace fovea {

/// What the texels of an image stand for, which says how they may be mixed.
struct TexelMeaning {
  enum class Kind {
    color,   ///< sRGB: mixed as light.
    normal,  ///< Unit vectors in the first three channels, 0 … 255 for -1 … 1: lengths stay 1.
    data     ///< Quantities (roughness, occlusion): mixed as they are.
  };
  Kind kind = Kind::color;
  /// Alpha shows: colours count as much as they cover.
  bool transparent = false;
  /// Of alpha masks, 0 … 1: the share of texels that pass it stays as it was.
  std::optional<double> alpha_cutoff = {};
  friend bool operator==(const TexelMeaning&, const TexelMeaning&) = default;
};

/// An image of another size, each side filtered by a Lanczos window of three lobes as wide as the larger of
/// the old and the new texel; beyond its borders it goes on as it wraps. Channels as in `image`.
///
/// O(texels of both · taps), 12 taps for a half; parallel; memory of height × new width × channels floats.
/// Throws Error(usage) for a side below 1.
Image8 resized(const Image8& image, int width, int height, const TexelMeaning& meaning, Wrap wrap_u,
               Wrap wrap_v, const Context& context);

}  // namespace fovea
