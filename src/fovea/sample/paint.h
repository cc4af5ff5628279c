#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "fovea/base/context.h"
#include "fovea/base/math.h"
#include "fovea/model/image.h"

namespace fovea::sample {

/// Red, green, blue as they are stored, 0 … 1 (sRGB curve).
using Color = Vec3d;

/// 0xRRGGBB.
constexpr Color rgb(std::uint32_t hex) {
  return {((hex >> 16) & 255) / 255.0, ((hex >> 8) & 255) / 255.0, (hex & 255) / 255.0};
}
constexpr double mix(double a, double b, double t) { return a + (b - a) * t; }
constexpr Color mix(Color a, Color b, double t) { return a + (b - a) * t; }
constexpr double clamp01(double x) { return x < 0 ? 0 : (x > 1 ? 1 : x); }
/// 0 up to `low`, 1 from `high` on, smooth between; falls if `high` < `low`.
constexpr double smooth_step(double low, double high, double x) {
  const double t = clamp01((x - low) / (high - low));
  return t * t * (3 - 2 * t);
}
/// How much of a pixel of size `pixel` lies inside of a shape at signed distance `distance`.
constexpr double coverage(double distance, double pixel) { return clamp01(0.5 - distance / pixel); }
/// Distance of `x` to the nearest whole number.
inline double to_whole(double x) { return std::abs(x - std::round(x)); }

/// A rectangle of a texture, in texels, with the coordinates of what is painted there: s from left to
/// right and t from bottom to top, both 0 … 1.
struct Chart {
  double x = 0, y = 0, width = 1, height = 1;

  /// Texture coordinates in an image of `image_width` × `image_height` texels.
  Vec2d uv(double s, double t, int image_width, int image_height) const {
    return {(x + s * width) / image_width, (y + (1 - t) * height) / image_height};
  }
};

/// Sets each pixel of `chart` and of `gutter` texels around it to `color(s, t)` at its centre. The
/// gutter keeps filters from bleeding the neighbours in; s and t go beyond [0, 1] there.
void paint(Image8& image, const Chart& chart, double gutter, const Context& context,
           const std::function<Color(double s, double t)>& color);

/// A round stroke that tapers from radius `from_radius` to `to_radius`.
struct Taper {
  Vec2d from;
  double from_radius;
  Vec2d to;
  double to_radius;
};

/// A figure drawn as the smooth union of tapered strokes.
struct Figure {
  std::vector<Taper> strokes;
  double softness = 0;  ///< How far strokes flow into each other.

  /// Signed distance to the outline, negative inside. O(#strokes).
  double distance(Vec2d p) const;
};

/// Strokes through the points of a line, tapering from one radius to the next.
struct Knot {
  Vec2d point;
  double radius;
};
void add_line(Figure& figure, const std::vector<Knot>& knots);

}  // namespace fovea::sample
