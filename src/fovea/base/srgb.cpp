#include "fovea/base/srgb.h"

#include <array>
#include <bit>
#include <cmath>
#include <cstddef>

namespace fovea {

namespace {

/// The root of a positive number: Newton's steps from an estimate within a few percent, which double the
/// digits that are right.
template <int Order>
double root(double x) {
  // As an integer a double is about a logarithm: divided by the order it is that of the root.
  constexpr std::int64_t kOne = std::bit_cast<std::int64_t>(1.0);
  double y = std::bit_cast<double>(kOne + (std::bit_cast<std::int64_t>(x) - kOne) / Order);
  for (int i = 0; i < 5; ++i) {
    double power = y;
    for (int k = 2; k < Order; ++k) power *= y;
    y -= (y - x / power) / Order;
  }
  return y;
}

double light_of(double display) {
  if (display <= 0.04045) return display / 12.92;
  const double x = (display + 0.055) / 1.055, fifth = root<5>(x);
  return x * x * fifth * fifth;  // x^2.4
}

double display_of(double light) {
  if (light <= 0.0031308) return light * 12.92;
  const double twelfth = std::sqrt(std::sqrt(root<3>(light))), squared = twelfth * twelfth;
  return 1.055 * squared * squared * twelfth - 0.055;  // x^(1/2.4)
}

struct ByteCurve {
  static constexpr int kSteps = 1024;
  std::array<float, 256> light;                // of each display value
  std::array<float, 256> ends;                 // light above which the next display value is nearer
  std::array<std::uint8_t, kSteps + 1> first;  // display value at light i / kSteps

  ByteCurve() {
    for (int i = 0; i < 256; ++i) {
      light[static_cast<std::size_t>(i)] = static_cast<float>(light_of(i / 255.0));
      ends[static_cast<std::size_t>(i)] = i < 255 ? static_cast<float>(light_of((i + 0.5) / 255)) : 2.0f;
    }
    std::size_t value = 0;
    for (int i = 0; i <= kSteps; ++i) {
      while (static_cast<float>(i) / kSteps > ends[value]) ++value;
      first[static_cast<std::size_t>(i)] = static_cast<std::uint8_t>(value);
    }
  }
};

const ByteCurve& byte_curve() {
  static const ByteCurve kCurve;
  return kCurve;
}

}  // namespace

float srgb_to_linear(float display) {
  return std::copysign(static_cast<float>(light_of(static_cast<double>(std::abs(display)))), display);
}

float linear_to_srgb(float light) {
  return std::copysign(static_cast<float>(display_of(static_cast<double>(std::abs(light)))), light);
}

float to_light(std::uint8_t display) { return byte_curve().light[display]; }

std::uint8_t to_display(float light) {
  const ByteCurve& curve = byte_curve();
  if (!(light > 0)) return 0;
  if (light >= 1) return 255;
  std::uint8_t value = curve.first[static_cast<std::size_t>(light * ByteCurve::kSteps)];
  while (light > curve.ends[value]) ++value;
  return value;
}

}  // namespace fovea
