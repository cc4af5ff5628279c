#include "fovea/sample/spheres_paint.h"

#include <array>
#include <cmath>
#include <numbers>

#include "fovea/sample/noise.h"

namespace fovea::sample {

namespace {

/// Exact at the sides' rims, where the tangent is not.
double equal_angle(double x) {
  if (x == 1 || x == -1) return x;
  return std::tan(x * std::numbers::pi / 4);
}

/// The colour of a scale of colours at x in [0, 1].
template <std::size_t N>
Color scale_color(const std::array<Color, N>& scale, double x) {
  const double at = clamp01(x) * (N - 1);
  const auto i = std::min(static_cast<std::size_t>(at), N - 2);
  return mix(scale[i], scale[i + 1], at - static_cast<double>(i));
}

Color gas_giant(Vec3d d) {
  constexpr std::array<Color, 7> kBands{rgb(0x8C5A3C), rgb(0xB9855C), rgb(0xE2C9A0), rgb(0xF3E7CF),
                                        rgb(0xD8A873), rgb(0xA5623A), rgb(0xEBD9B8)};
  const Vec3d storm = normalized(Vec3d{-0.55, -0.36, 0.76});
  const double east = dot(d, normalized(cross(Vec3d{0, 1, 0}, storm)));
  const double north = dot(d, normalized(cross(storm, cross(Vec3d{0, 1, 0}, storm))));
  const bool near = dot(d, storm) > 0;
  const double oval = near ? std::hypot(east / 0.30, north / 0.15) : 9;

  const Vec3d stretched{d.x * 2.2, d.y * 7, d.z * 2.2};
  const double swirl = fractal_noise(stretched, 5, 51);
  const double fine =
      fractal_noise(Vec3d{d.x * 6, d.y * 26, d.z * 6} + Vec3d{swirl, swirl, swirl} * 2.0, 4, 52);
  const double around_storm = smooth_step(2.2, 1.0, oval);
  const double latitude = d.y + 0.055 * swirl + 0.018 * fine + 0.06 * around_storm * (north > 0 ? 1 : -1);
  const double band = 0.5 + 0.30 * std::sin(latitude * 17) + 0.20 * std::sin(latitude * 41 + 1) + 0.12 * fine;
  Color c = scale_color(kBands, band);
  c = mix(c, rgb(0x9C7A62), 0.6 * smooth_step(0.72, 0.98, std::abs(d.y)));

  if (around_storm == 0) return c;
  const double eye = fractal_noise(Vec3d{oval * 7 + swirl, east * 6, north * 6}, 3, 53);
  const Color red = mix(rgb(0xB4492B), rgb(0xD98B5F), clamp01(0.45 + 0.5 * eye + 0.25 * std::sin(oval * 16)));
  c = mix(c, rgb(0xF4EAD6), 0.75 * smooth_step(1.35, 1.12, oval));
  return mix(c, red, smooth_step(1.06, 0.94, oval));
}

Color land(Vec3d d, double height, double cold) {
  const double dry = fractal_noise(d * 2.3, 4, 63) + 0.9 * (0.35 - std::abs(std::abs(d.y) - 0.38) * 2.2);
  Color c = mix(rgb(0x3E6B35), rgb(0xC9A56B), smooth_step(0.0, 0.35, dry));
  c = mix(c, rgb(0x27502E), smooth_step(0.1, -0.25, dry));
  c = mix(c, rgb(0x7A6650), smooth_step(0.16, 0.34, height));
  c = mix(c, rgb(0xF4F6F8), smooth_step(0.34, 0.44, height + 0.25 * cold));
  return c * (0.92 + 0.55 * (height - 0.1));
}

Color earth(Vec3d d) {
  const Vec3d warp{fractal_noise(d * 2.0, 3, 60), fractal_noise(d * 2.0, 3, 61), 0};
  const double height = fractal_noise(d * 1.7 + warp * 0.45, 8, 62) * 1.25 - 0.02;
  const double cold = smooth_step(0.66, 0.92, std::abs(d.y) + 0.10 * fractal_noise(d * 5.0, 4, 64));
  constexpr double kShore = 0.006;
  Color c = mix(rgb(0x0E2A52), rgb(0x2F86A6), smooth_step(-0.22, 0.0, height));
  if (height > -kShore) c = mix(c, land(d, height, cold), smooth_step(-kShore, kShore, height));
  c = mix(c, rgb(0xF2F5F8), smooth_step(0.45, 0.75, cold));

  const Vec3d wind = Vec3d{d.x * 2.6, d.y * 4.5, d.z * 2.6} + warp * 1.4;
  const double cloud = fractal_noise(wind, 6, 65) + 0.25 * fractal_noise(d * 12.0, 3, 66);
  return mix(c, rgb(0xFBFBFA), 0.88 * smooth_step(0.10, 0.46, cloud));
}

Image8 paint_cube(const CubeAtlas& atlas, const Context& context, Color (*color)(Vec3d)) {
  Image8 image(CubeAtlas::kWidth, CubeAtlas::kHeight, 3, ColorEncoding::srgb);
  for (int side = 0; side < 6; ++side) {
    paint(image, atlas.side(side), CubeAtlas::kGutter, context,
          [&](double s, double t) { return color(normalized(cube_direction(side, 2 * s - 1, 2 * t - 1))); });
  }
  return image;
}

}  // namespace

Vec3d cube_direction(int side, double s, double t) {
  const double a = equal_angle(s), b = equal_angle(t);
  switch (side) {
    case 0: return {1, b, -a};
    case 1: return {a, b, 1};
    case 2: return {-1, b, a};
    case 3: return {-a, b, -1};
    case 4: return {a, 1, -b};
    default: return {a, -1, b};
  }
}

Image8 paint_gas_giant(const CubeAtlas& atlas, const Context& context) {
  return paint_cube(atlas, context, gas_giant);
}

Image8 paint_earth(const CubeAtlas& atlas, const Context& context) {
  return paint_cube(atlas, context, earth);
}

}  // namespace fovea::sample
