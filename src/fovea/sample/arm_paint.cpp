#include "fovea/sample/arm_paint.h"

#include <cmath>
#include <numbers>

#include "fovea/sample/noise.h"

namespace fovea::sample {

namespace {

constexpr Color kNavy = rgb(0x1B2A55), kWool = rgb(0xEFE9DB), kRed = rgb(0xB03A2E), kSkin = rgb(0xD9A17C),
                kBlush = rgb(0xC97F66), kFreckle = rgb(0xA8694B), kInk = rgb(0x2C4257), kNail = rgb(0xEBC0AC);

/// Point on a cylinder, so that noise has no seam at s = 0 | 1.
Vec3d around(double s, double t, double radius) {
  const double angle = 2 * std::numbers::pi * s;
  return {radius * std::cos(angle), radius * std::sin(angle), t};
}

/// Brightness of knitted stitches: columns of small Vs.
double knit(double s, double length) {
  constexpr double kColumns = 110, kRowsPerUnit = 62;
  const double a = kColumns * s, x = std::abs(a - std::round(a));
  const double y = kRowsPerUnit * length - 1.2 * x;
  const double yarn = std::cos(2 * std::numbers::pi * y) * 0.5 + 0.5;
  return 0.80 + 0.16 * std::sqrt(yarn) + 0.20 * (0.25 - std::abs(x - 0.25));
}

Color sleeve(double s, double t, double along) {
  const double length = t * along, left = (1 - t) * along;
  constexpr double kCuff = 0.13, kPeriod = 0.132;
  const double stripe = std::abs(length / kPeriod - std::round(length / kPeriod)) * kPeriod - 0.026;
  Color c = mix(kWool, kNavy, coverage(stripe, 0.004));
  double shade = knit(s, length);
  if (left < kCuff) {
    c = kNavy;
    shade = 0.78 + 0.3 * smooth_step(-0.7, 0.9, std::cos(2 * std::numbers::pi * 72 * s));
  }
  c = mix(c, kRed, coverage(std::abs(left - kCuff) - 0.010, 0.004));
  const double worn = fractal_noise(around(s, 5 * length, 1.6), 4, 21);
  return c * (shade * (1 + 0.07 * worn));
}

/// Ink under the skin: an anchor about 1 high around the origin, its ring up.
struct Anchor {
  Figure shape;
  Anchor() {
    add_line(shape, {{{0, 0.34}, 0.040}, {{0, -0.42}, 0.045}});
    add_line(shape, {{{-0.20, 0.22}, 0.035}, {{0.20, 0.22}, 0.035}});
    const auto arc = [](double degrees, double radius, double middle) {
      const double a = degrees * std::numbers::pi / 180;
      return Vec2d{radius * std::sin(a), middle - radius * std::cos(a)};
    };
    for (int a = -75; a < 75; a += 15) {
      add_line(shape, {{arc(a, 0.40, -0.06), 0.045}, {arc(a + 15, 0.40, -0.06), 0.045}});
    }
    for (int a = 0; a < 360; a += 30) {
      add_line(shape, {{arc(a, 0.075, 0.44), 0.026}, {arc(a + 30, 0.075, 0.44), 0.026}});
    }
    for (const double side : {-1.0, 1.0}) {
      add_line(shape, {{{side * 0.385, -0.17}, 0.075}, {{side * 0.40, 0.02}, 0.012}});
    }
  }
};

Color bare_skin(double s, double t, double scale) {
  const Vec3d p = around(s, 2.2 * scale * t, 0.6);
  const double tone = fractal_noise(p, 4, 31), pores = fractal_noise(p * 26.0, 2, 32);
  Color c = mix(kSkin, kBlush, clamp01(0.25 + 0.55 * tone));
  const Cell freckle = cell_noise({34 * s, 34 * scale * t}, 33);
  const double size = 0.05 + 0.12 * (freckle.id & 255) / 255.0;
  const double spot = (freckle.id >> 8 & 7) < 3 ? coverage(freckle.nearest - size, 0.14) : 0;
  c = mix(c, kFreckle, 0.45 * spot);
  return c * (1 + 0.05 * pores);
}

class Forearm {
 public:
  explicit Forearm(double along) : along_(along) {}

  Color operator()(double s, double t) const {
    constexpr double kGirth = 0.95, kSize = 0.34;
    Color c = bare_skin(s, t, along_);
    const double vein = std::abs(gradient_noise(around(s, 3.0 * t, 0.9), 35));
    c = mix(c, rgb(0x7F8A94), 0.22 * smooth_step(0.07, 0.0, vein) * smooth_step(0.75, 0.5, t));
    const double crease = palm_crease(s, t);
    c = mix(c, kBlush * 0.75, 0.6 * crease);
    const Vec2d p{(s - 0.5) * kGirth / kSize, (0.27 - t) * along_ / kSize};
    const double ink = coverage(anchor_.shape.distance(p), 0.03);
    const double faded = 0.82 + 0.18 * fractal_noise(Vec2d{40 * s, 40 * t}, 3, 36);
    return mix(c, kInk, ink * faded);
  }

 private:
  /// Three bent lines across the inner side of the hand.
  static double palm_crease(double s, double t) {
    double depth = 0;
    const double x = (s - 0.5) / 0.17;
    for (const double line : {0.70, 0.78, 0.84}) {
      const double d = std::abs(t - line - 0.03 * x * x * (line - 0.74) * 20) - 0.0012;
      depth = std::max(depth, coverage(d, 0.004) * smooth_step(1.1, 0.7, std::abs(x)));
    }
    return depth;
  }

  double along_;
  Anchor anchor_;
};

/// The nail lies in the middle of the chart, near its upper end.
Color finger(double s, double t, int index) {
  Color c = bare_skin(s + 0.37 * index, 0.8 * t + index, 1);
  c = mix(c, kBlush, 0.35 * smooth_step(0.7, 1.0, t));
  for (const double knuckle : {0.42, 0.45, 0.66, 0.68}) {
    c = c * (1 - 0.10 * smooth_step(0.012, 0.0, std::abs(t - knuckle)));
  }
  const double x = (s - 0.5) / 0.15, y = (t - 0.83) / 0.075;
  const double nail = std::pow(std::pow(std::abs(x), 3.0) + std::pow(std::abs(y), 3.0), 1 / 3.0) - 1;
  c = mix(c, kBlush * 0.8, 0.5 * coverage(nail - 0.10, 0.15));
  const Color plate = mix(kNail, rgb(0xF6E6DA), smooth_step(0.55, 0.7, y));
  return mix(c, plate, coverage(nail, 0.10));
}

}  // namespace

Image8 paint_arm(const ArmAtlas& atlas, const ArmMeasure& measure, const Context& context) {
  constexpr double kGutter = 5;
  Image8 image(ArmAtlas::kSize, ArmAtlas::kSize, 3, ColorEncoding::srgb);
  paint(image, {0, 0, ArmAtlas::kSize, ArmAtlas::kSize}, 0, context, [](double, double) { return kSkin; });
  paint(image, atlas.sleeve, kGutter, context,
        [&](double s, double t) { return sleeve(s, t, measure.sleeve); });
  const Forearm forearm(measure.skin);
  paint(image, atlas.skin, kGutter, context, [&](double s, double t) { return forearm(s, t); });
  for (int i = 0; i < ArmAtlas::kFingers; ++i) {
    paint(image, atlas.finger(i), kGutter, context, [i](double s, double t) { return finger(s, t, i); });
  }
  return image;
}

}  // namespace fovea::sample
