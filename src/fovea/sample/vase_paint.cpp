#include "fovea/sample/vase_paint.h"

#include <array>
#include <cmath>
#include <numbers>
#include <string_view>

#include "fovea/sample/noise.h"

namespace fovea::sample {

namespace {

constexpr Color kCobalt = rgb(0x1D3F94), kDeep = rgb(0x101F52), kWhite = rgb(0xEFEBDD), kSky = rgb(0x7FA3D6),
                kCream = rgb(0xF2E6C9), kGold = rgb(0xC79A3C), kBrick = rgb(0xB8412A), kClay = rgb(0xA9764F);

constexpr double kPixel = 1.0 / 380;  ///< Size of a texel on the body in units of length, about.

/// `over` where the distance to a shape is negative.
Color cover(Color under, Color over, double distance, double pixel) {
  return mix(under, over, coverage(distance, pixel));
}

/// Overlapping discs of rings, each row over the one above it; a and b in units of a disc's width.
Color waves(double a, double b, double pixel) {
  constexpr double kRadius = 0.5, kRowStep = 0.25;
  const int first = static_cast<int>(std::ceil((b - kRadius) / kRowStep));
  for (int row = first;; ++row) {
    const double shift = (row & 1) ? 0.5 : 0.0;
    const double column = std::round(a - shift);
    const double x = a - shift - column, y = b - row * kRowStep;
    const double d = std::sqrt(x * x + y * y);
    if (d > kRadius && row < first + 6) continue;
    const Cell tint = cell_noise({column + shift + 0.5, row + 0.5}, 11);
    const std::array<Color, 4> hearts{kBrick, kGold, kWhite, kSky};
    Color c = kDeep;
    c = cover(c, kWhite, d - 0.455, pixel);
    c = cover(c, kCobalt, d - 0.375, pixel);
    c = cover(c, kWhite, d - 0.29, pixel);
    c = cover(c, kCobalt, d - 0.215, pixel);
    return cover(c, hearts[tint.id & 3], d - 0.12, pixel);
  }
}

/// A running key on a base line; a in periods, b from 0 (below) to 1.
double meander(double a, double b, double pixel_a, double pixel_b) {
  constexpr std::array<std::string_view, 6> kKey{"#####.", "#...#.", "#.#.#.", "#.###.", "#.....", "######"};
  double sum = 0;
  for (const double da : {-0.25, 0.25}) {
    for (const double db : {-0.25, 0.25}) {
      const double x = a + da * pixel_a, y = b + db * pixel_b;
      const auto column = static_cast<std::size_t>(6 * (x - std::floor(x))) % 6;
      const auto row = static_cast<std::size_t>(6 * (1 - clamp01(y)) * 0.9999);
      sum += kKey[row][column] == '#' ? 0.25 : 0;
    }
  }
  return sum;
}

/// Pointed leaves side by side; a in leaves, b from root to tip.
Color leaves(double a, double b, Color leaf, Color ground, double pixel) {
  const double x = a - std::round(a);
  const double half = 0.46 * std::sqrt(clamp01(1 - b)) * smooth_step(-0.25, 0.25, b);
  const double edge = std::abs(x) - half;
  Color c = cover(ground, kDeep, edge, pixel);
  c = cover(c, kWhite, edge + 0.05, pixel);
  c = cover(c, leaf, edge + 0.11, pixel);
  const double vein = std::max(std::abs(x) - 0.03 * (1 - b), b - 0.8);
  return cover(c, kWhite, vein, pixel);
}

/// One horse, about 2 wide and 1.8 high around the origin, looking to the right.
struct Horse {
  Figure shape, lines;

  Horse() {
    shape.softness = 0.07;
    add_line(shape, {{{-0.44, 0.06}, 0.245}, {{0.0, 0.01}, 0.225}, {{0.42, 0.07}, 0.245}});
    add_line(shape, {{{0.44, 0.18}, 0.22}, {{0.64, 0.46}, 0.165}, {{0.80, 0.68}, 0.105}});
    add_line(shape, {{{0.82, 0.68}, 0.105}, {{1.00, 0.50}, 0.075}, {{1.10, 0.39}, 0.06}});
    add_line(shape, {{{0.79, 0.74}, 0.045}, {{0.81, 0.90}, 0.008}});
    add_line(shape,
             {{{0.52, -0.03}, 0.15}, {{0.88, -0.10}, 0.085}, {{0.95, -0.36}, 0.05}, {{0.84, -0.48}, 0.052}});
    add_line(shape,
             {{{0.40, -0.06}, 0.15}, {{0.50, -0.42}, 0.075}, {{0.53, -0.72}, 0.05}, {{0.61, -0.88}, 0.056}});
    add_line(shape, {{{-0.52, 0.04}, 0.21},
                     {{-0.52, -0.28}, 0.12},
                     {{-0.72, -0.52}, 0.065},
                     {{-0.66, -0.80}, 0.05},
                     {{-0.56, -0.89}, 0.054}});
    add_line(shape, {{{-0.42, 0.02}, 0.22},
                     {{-0.26, -0.32}, 0.12},
                     {{-0.39, -0.58}, 0.065},
                     {{-0.26, -0.82}, 0.05},
                     {{-0.16, -0.90}, 0.054}});
    add_line(shape, {{{-0.62, 0.20}, 0.05},
                     {{-0.80, 0.24}, 0.08},
                     {{-0.98, 0.02}, 0.095},
                     {{-1.02, -0.30}, 0.06},
                     {{-1.14, -0.50}, 0.012}});
    add_line(lines,
             {{{0.30, 0.36}, 0.006}, {{0.46, 0.46}, 0.014}, {{0.60, 0.64}, 0.016}, {{0.71, 0.80}, 0.008}});
    add_line(lines, {{{0.885, 0.67}, 0.020}, {{0.905, 0.665}, 0.020}});
    add_line(lines, {{{1.00, 0.42}, 0.006}, {{1.09, 0.36}, 0.010}});
    add_line(lines, {{{0.22, -0.15}, 0.006}, {{0.30, -0.02}, 0.011}, {{0.32, 0.16}, 0.006}});
    add_line(lines, {{{-0.22, -0.14}, 0.006}, {{-0.24, 0.04}, 0.011}, {{-0.33, 0.2}, 0.006}});
    add_line(lines, {{{-0.72, 0.20}, 0.006}, {{-0.90, 0.06}, 0.011}, {{-0.95, -0.22}, 0.006}});
  }

  Color over(Color ground, Vec2d p, double pixel) const {
    if (std::abs(p.x) > 1.3 || std::abs(p.y) > 1.1) return ground;
    const double outline = shape.distance(p);
    Color c = cover(ground, kDeep, outline - 0.035, pixel);
    c = cover(c, kCream, outline, pixel);
    return outline < 0 ? cover(c, kDeep, lines.distance(p), pixel) : c;
  }
};

/// The painting of the body: borders from foot to lip, and the field with the figure.
class Body {
 public:
  explicit Body(const VaseMeasure& measure) : measure_(measure) {}

  Color operator()(double s, double t) const {
    Color c = ground(s, t);
    for (const double edge : {0.055, 0.205, 0.255, 0.70, 0.75, 0.80, 0.968}) {
      const double d = std::abs(t - edge) * measure_.along;
      c = cover(cover(c, kDeep, d - 0.010, kPixel), kGold, d - 0.006, kPixel);
    }
    return c;
  }

 private:
  Color ground(double s, double t) const {
    const auto local = [&](double low, double high) { return (t - low) / (high - low); };
    const auto pixel_of = [&](double count) { return kPixel * count / measure_.around; };
    if (t < 0.055) return kCobalt;
    if (t < 0.205) return leaves(18 * s, local(0.055, 0.205), kCobalt, kGold, pixel_of(18));
    if (t < 0.255) return key(s, local(0.205, 0.255));
    if (t < 0.70) return field(s, t);
    if (t < 0.75) return key(s, local(0.70, 0.75));
    if (t < 0.80) return dots(s, local(0.75, 0.80));
    if (t < 0.968) return leaves(20 * s, local(0.80, 0.968), kCobalt, kWhite, pixel_of(20));
    return kCobalt;
  }

  Color key(double s, double t) const {
    constexpr double kCount = 44, kHeight = 0.05;
    const double inner = (t - 0.2) / 0.6;
    if (inner < 0 || inner > 1) return kWhite;
    const double pixel_t = kPixel / (0.6 * kHeight * measure_.along);
    return mix(kWhite, kCobalt, meander(kCount * s, inner, kPixel * kCount / measure_.around, pixel_t));
  }

  Color dots(double s, double t) const {
    constexpr double kCount = 36;
    const double width = measure_.around / kCount;
    const double x = (kCount * s - std::round(kCount * s)) * width, y = (t - 0.5) * 0.05 * measure_.along;
    const double d = std::sqrt(x * x + y * y);
    return cover(cover(kCobalt, kWhite, d - 0.022, kPixel), kBrick, d - 0.010, kPixel);
  }

  Color field(double s, double t) const {
    constexpr double kWaves = 26;
    const double x = (s - 0.5) * measure_.around, y = (t - 0.478) * measure_.along;
    const double width = measure_.around / kWaves;
    const Color ground = waves(kWaves * s, y / width, kPixel / width);
    constexpr double kHorseSize = 0.335;
    return horse_.over(ground, Vec2d{x, y} * (1 / kHorseSize), kPixel / kHorseSize);
  }

  VaseMeasure measure_;
  Horse horse_;
};

/// Small, slow differences in brightness, as glaze has them.
Color glaze(Color c, double s, double t, double strength) {
  const double angle = 2 * std::numbers::pi * s;
  const Vec3d p{3 * std::cos(angle), 3 * std::sin(angle), 9 * t};
  return c * (1 + strength * fractal_noise(p, 3, 5));
}

Color inside(double s, double t) { return glaze(mix(kWhite, kSky * 0.8, 0.5 * t), s, t, 0.06); }

Color clay(double s, double t) {
  const double x = s - 0.5, y = t - 0.5, r = std::sqrt(x * x + y * y);
  const double grain = fractal_noise(Vec2d{60 * s, 60 * t}, 4, 9) + 0.4 * std::sin(140 * r);
  return kClay * (1 + 0.10 * grain);
}

Color handle_ring(double s, double t) {
  const double stripe = to_whole(15 * t) - 0.16, spine = std::abs(s - 0.25) - 0.08;
  return cover(cover(kCobalt, kWhite, stripe, 0.08), kGold, spine, 0.01);
}

}  // namespace

Image8 paint_vase(const VaseAtlas& atlas, const VaseMeasure& measure, const Context& context) {
  constexpr double kGutter = 5;
  Image8 image(VaseAtlas::kSize, VaseAtlas::kSize, 3, ColorEncoding::srgb);
  paint(image, {0, 0, VaseAtlas::kSize, VaseAtlas::kSize}, 0, context,
        [](double, double) { return kCobalt; });
  const Body body(measure);
  paint(image, atlas.body, kGutter, context,
        [&](double s, double t) { return glaze(body(s, t), s, t, 0.05); });
  paint(image, atlas.inside, kGutter, context, inside);
  paint(image, atlas.lip, kGutter, context, [](double, double) { return kGold; });
  paint(image, atlas.bottom, kGutter, context, clay);
  for (const Chart& chart : atlas.handles) paint(image, chart, kGutter, context, handle_ring);
  return image;
}

}  // namespace fovea::sample
