#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "fovea/base/math.h"
#include "fovea/model/field.h"
#include "fovea/model/model.h"
#include "fovea/texture/atlas.h"
#include "fovea/texture/mip_map.h"
#include "fovea/texture/resize.h"

// Shared inside Fovea, not installed: what pictures of a textured surface show, told from points on it.

namespace fovea {

/// How long a model is in pictures that nobody has said more of, in pixels.
inline constexpr std::array<double, 3> kPictureSizes{512, 1024, 2048};

/// A place on the surface.
struct SurfacePoint {
  std::uint32_t face = 0;
  std::array<double, 3> weights{};  ///< Of its corners.
  double counts = 1;                ///< How much is looked at there.
};

/// [#faces] Areas on the surface, as the scene shows it largest. O(#F).
std::vector<double> surface_areas(const Model& model, std::span<const AtlasFace> faces);

/// Points that have about the same part of the surface each, as the scene shows it largest; none if it has no
/// area. The field as for `texture_importance`. O(#F + count).
std::vector<SurfacePoint> spread_points(const Model& model, std::span<const AtlasFace> faces,
                                        std::span<const VertexField> field, std::size_t count);

/// [#faces] How coordinates change along two directions on the surface, square to each other, by a pixel of a
/// picture in which the whole model is one pixel long and its surface is seen as that of a sphere is, in the
/// mean; 0 where a triangle has no area. O(#F).
std::vector<UvSlopes> picture_slopes(const Model& model, std::span<const AtlasFace> faces);

inline UvSlopes scaled(const UvSlopes& slopes, double factor) {
  const auto f = static_cast<float>(factor);
  return {slopes.dx * f, slopes.dy * f};
}

inline Vec2f single(Vec2d a) { return {static_cast<float>(a.x), static_cast<float>(a.y)}; }

/// How much of a squared difference pictures tell: colours 1, normals 1/2, data 1/4.
double loss_weight(const TexelMeaning& meaning);

/// What is shown for a value, 0 … 1 a channel: colours as a display has them, in whole steps of a byte; alpha
/// 1 unless it shows.
Rgba shown(Rgba value, const TexelMeaning& meaning);
/// Of two `shown` values, summed over the channels.
inline double squared_difference(const Rgba& a, const Rgba& b) {
  const float red = a.r - b.r, green = a.g - b.g, blue = a.b - b.b, alpha = a.a - b.a;
  return static_cast<double>(red * red + green * green + blue * blue + alpha * alpha);
}

}  // namespace fovea
