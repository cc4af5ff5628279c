#include "fovea/sample/terrain_paint.h"

#include <algorithm>
#include <cmath>
#include <functional>

#include "fovea/base/parallel.h"
#include "fovea/sample/noise.h"

namespace fovea::sample {

namespace {

const Vec3d kSun = normalized(Vec3d{-0.62, 0.48, 0.62});  // East, north, up.

/// What the colour of a place depends on.
struct Place {
  Vec2d p;            ///< 0 … 1 from west to east and north to south.
  double height = 0;  ///< Above the water, in widths of the map.
  double steep = 0;   ///< 0 flat … 1 upright.
  double north = 0;   ///< How much the slope looks north.
  double flow = 0;    ///< 0 … 1.
  double hollow = 0;  ///< Below (positive) or above its surroundings.
  double lit = 1;     ///< Sunlight past the mountains and at its angle.
};

/// Paints the land from above.
class LandPainter {
 public:
  LandPainter(const Landscape& land, int size, std::uint64_t seed, const Context& context)
      : land_(land),
        seed_(seed),
        relief_(make_relief(size + 1, context)),
        light_(blur(cast_light(land.ground, kSun.x, kSun.y, kSun.z), 1)),
        around_(blur(land.ground, land.ground.size() / 40)),
        flow_(blur(land.flow, 1)) {}

  Color operator()(double s, double t) const {
    const Place at = look({clamp01(s), clamp01(1 - t)});
    constexpr double kShore = 0.0012;
    if (at.height < -kShore) return grade(water(at), at);
    return grade(mix(water(at), dry_land(at), smooth_step(-kShore, kShore, at.height)), at);
  }

 private:
  double noise(Vec2d p, double scale, int octaves, int which) const {
    return fractal_noise(p * scale, octaves, seed_ + static_cast<std::uint64_t>(which));
  }

  /// The ground at the texels' corners, with finer relief than the map holds: it shows in the light only.
  HeightMap make_relief(int size, const Context& context) const {
    HeightMap relief(size);
    parallel_for(context, static_cast<std::size_t>(size), 8, [&](std::size_t begin, std::size_t end) {
      for (int y = static_cast<int>(begin); y < static_cast<int>(end); ++y) {
        for (int x = 0; x < size; ++x) {
          const Vec2d p{static_cast<double>(x) / (size - 1), static_cast<double>(y) / (size - 1)};
          const double ground = land_.ground.read(p.x, p.y);
          const double rough = 0.0032 * std::clamp(ground * 4, 0.1, 1.0);
          relief.at(x, y) = ground + rough * noise(p, 70, 3, 71);
        }
      }
    });
    return relief;
  }

  Place look(Vec2d p) const {
    Place at;
    at.p = p;
    const double ground = land_.ground.read(p.x, p.y);
    const int cells = relief_.size() - 1;
    const int x = std::min(static_cast<int>(p.x * cells), cells - 1);
    const int y = std::min(static_cast<int>(p.y * cells), cells - 1);
    const double a = relief_.at(x, y), b = relief_.at(x + 1, y), c = relief_.at(x, y + 1),
                 d = relief_.at(x + 1, y + 1);
    const double dx = (b + d - a - c) * 0.5 * cells, dy = (c + d - a - b) * 0.5 * cells;
    const Vec3d normal = normalized(Vec3d{-dx, dy, 1});  // East, north, up.
    at.height = ground - land_.water;
    at.steep = 1 - normal.z;
    at.north = normal.y;
    at.flow = clamp01(std::log1p(std::max(0.0, flow_.read_linear(p.x, p.y))) / 6.5);
    at.hollow = around_.read_linear(p.x, p.y) - ground;
    const double angle = std::max(0.0, at.height < 0 ? kSun.z : dot(normal, kSun));
    at.lit = angle * clamp01(light_.read_linear(p.x, p.y));
    return at;
  }

  Color rock(const Place& at) const {
    const double strata = std::sin(at.height * 420 + 5 * noise(at.p, 9, 4, 72));
    Color c = mix(rgb(0x6E655B), rgb(0x938676), clamp01(0.5 + 0.22 * strata + 0.7 * noise(at.p, 60, 4, 73)));
    return mix(c, rgb(0x7C6A56), 0.5 * clamp01(noise(at.p, 14, 3, 74) + 0.3));
  }

  Color meadow(const Place& at) const {
    const double dry = clamp01(0.45 + 0.8 * noise(at.p, 12, 5, 75) + 1.4 * at.height - 0.6 * at.flow);
    Color c = mix(rgb(0x566B2E), rgb(0x9C9352), dry);
    return c * (1 + 0.14 * noise(at.p, 170, 3, 76));
  }

  /// Single trees: round crowns with a lit and a dark side.
  Color trees(const Place& at, Color ground, double density) const {
    const Vec2d p = at.p * 190.0;
    const Cell tree = cell_noise(p, seed_ + 77);
    if ((tree.id & 1023) / 1023.0 > density) return ground * (1 - 0.25 * density);
    const Cell shifted = cell_noise(p + Vec2d{-0.22, -0.22}, seed_ + 77);
    const double tone = (tree.id >> 10 & 255) / 255.0;
    const Color crown =
        mix(rgb(0x1F3620), rgb(0x40572B), tone) * (0.75 + 0.8 * (shifted.nearest - tree.nearest + 0.2));
    return mix(ground * 0.55, crown, smooth_step(0.62, 0.42, tree.nearest));
  }

  Color dry_land(const Place& at) const {
    Color c = meadow(at);
    const double wet = 0.30 + 1.2 * noise(at.p, 6, 5, 78) + 0.5 * at.flow + 12 * at.hollow;
    const double wooded = clamp01(wet) * smooth_step(0.185, 0.13, at.height + 0.02 * noise(at.p, 40, 3, 79)) *
                          smooth_step(0.26, 0.17, at.steep) * smooth_step(0.004, 0.012, at.height);
    if (wooded > 0) c = trees(at, c, 0.95 * wooded);
    const double bare =
        smooth_step(0.12, 0.24, at.steep + 0.10 * noise(at.p, 45, 4, 80) + 0.55 * (at.height - 0.15));
    if (bare > 0) c = mix(c, rock(at), bare);
    c = mix(c, rgb(0xA39B8C), 0.55 * smooth_step(0.62, 0.9, at.flow) * smooth_step(0.35, 0.2, at.steep));
    const double snow_line = 0.165 + 0.035 * noise(at.p, 10, 5, 81) - 0.05 * at.north;
    const double snow = smooth_step(snow_line, snow_line + 0.018, at.height + 0.4 * at.hollow) *
                        smooth_step(0.52, 0.36, at.steep);
    c = mix(c, rgb(0xEDF1F5), snow);
    return mix(rgb(0xC2B48F), c, smooth_step(0.0015, 0.0055, at.height + 0.002 * noise(at.p, 90, 2, 82)));
  }

  Color water(const Place& at) const {
    const double depth = smooth_step(0.0, -0.012, at.height);
    const Color c = mix(rgb(0x4E8C86), rgb(0x123A52), depth);
    return c * (1 + 0.05 * noise({at.p.x, at.p.y * 3}, 60, 3, 83));
  }

  /// Sun and sky, a little haze, all in the curve that the image is stored in.
  Color grade(Color c, const Place& at) const {
    const double open = clamp01(0.80 - 7.0 * at.hollow);
    const Color sky = rgb(0x8FA4C4) * (0.78 * open), sun = rgb(0xFFF1DC) * 0.95;
    const Color light = sky + sun * at.lit;
    const Color lit{c.x * light.x, c.y * light.y, c.z * light.z};
    return {clamp01(std::pow(lit.x, 0.92)), clamp01(std::pow(lit.y, 0.92)), clamp01(std::pow(lit.z, 0.92))};
  }

  const Landscape& land_;
  std::uint64_t seed_;
  HeightMap relief_, light_, around_, flow_;
};

/// Paints what the cut through the earth shows.
class CutPainter {
 public:
  CutPainter(const Landscape& land, std::uint64_t seed) : land_(land), seed_(seed) {}

  /// A strip of two sides, the first of which is number `first` counted from the south through the east.
  Color side(int first, double s, double t) const {
    const double along = std::clamp(2 * s, 0.0, 2.0);
    const int number = first + (along < 1 ? 0 : 1);
    const double f = along < 1 ? along : along - 1;
    const Vec2d corners[] = {{0, 1}, {1, 1}, {1, 0}, {0, 0}, {0, 1}};
    const Vec2d p = corners[number] * (1 - f) + corners[number + 1] * f;
    const double brightness[] = {0.80, 0.72, 0.90, 1.0};  // The sun stands in the north-west.
    const double height = mix(land_.base, land_.crest, t);
    return earth({p.x, p.y, height}, land_.ground.read(p.x, p.y) - height) * brightness[number];
  }

  Color bottom(double s, double t) const {
    return rgb(0x51473D) * (1 + 0.1 * fractal_noise(Vec2d{s, t} * 9.0, 4, seed_ + 90));
  }

 private:
  double noise(Vec3d p, double scale, int octaves, int which) const {
    return fractal_noise(p * scale, octaves, seed_ + static_cast<std::uint64_t>(which));
  }

  Color earth(Vec3d p, double depth) const {
    const double lake = land_.water - p.z;
    if (depth < 0 && lake > 0) return mix(rgb(0x4E8C86), rgb(0x123A52), smooth_step(0, 0.03, lake));
    const double uneven = noise(p, 22, 4, 91);
    const Color soil = mix(rgb(0x3B2C20), rgb(0x4E3A28), clamp01(0.5 + noise(p, 120, 3, 92)));
    const Color loam = mix(rgb(0x7E5E3E), rgb(0x9A7A52), clamp01(0.5 + 0.8 * noise(p, 80, 4, 93)));
    const Color c = mix(loam, rock(p), smooth_step(0.012, 0.020, depth + 0.008 * uneven));
    return mix(soil, c, smooth_step(0.003, 0.006, depth + 0.003 * uneven));
  }

  /// Layers that run through the whole block, slanted and bent.
  Color rock(Vec3d p) const {
    const double level = p.z + 0.05 * p.x - 0.03 * p.y + 0.012 * noise(p, 3, 3, 94);
    const double layer = fractal_noise(Vec2d{level * 70, 0.5}, 3, seed_ + 95);
    const double fine = 0.5 + 0.5 * std::sin(level * 900 + 3 * noise(p, 30, 2, 96));
    Color c = mix(rgb(0x6A5F55), rgb(0xA8957C), clamp01(0.5 + 0.9 * layer));
    c = mix(c, rgb(0x8A5F45), 0.6 * smooth_step(0.15, 0.3, layer));
    return c * (0.92 + 0.10 * fine + 0.12 * noise(p, 140, 3, 97));
  }

  const Landscape& land_;
  std::uint64_t seed_;
};

}  // namespace

Image8 paint_terrain(const Landscape& land, const TerrainAtlas& atlas, std::uint64_t seed,
                     const Context& context) {
  Image8 image(TerrainAtlas::kWidth, TerrainAtlas::kHeight, 3, ColorEncoding::srgb);
  const LandPainter from_above(land, static_cast<int>(atlas.top.width), seed, context);
  const CutPainter cut(land, seed);
  const auto add = [&](const Chart& chart, const std::function<Color(double, double)>& color) {
    paint(image, chart, TerrainAtlas::kGutter, context, color);
  };
  add(atlas.top, [&](double s, double t) { return from_above(s, t); });
  for (const int strip : {0, 1}) {
    add(atlas.sides[strip], [&](double s, double t) { return cut.side(2 * strip, s, t); });
  }
  add(atlas.bottom, [&](double s, double t) { return cut.bottom(s, t); });
  return image;
}

}  // namespace fovea::sample
