#pragma once

#include <cmath>

namespace fovea {

/// Display value (sRGB curve, IEC 61966-2-1) to amount of light, both 0 … 1; odd around 0.
inline float srgb_to_linear(float display) {
  const float x = std::abs(display);
  const float y = x <= 0.04045f ? x / 12.92f : std::pow((x + 0.055f) / 1.055f, 2.4f);
  return std::copysign(y, display);
}

/// Amount of light to display value: the inverse of the above.
inline float linear_to_srgb(float light) {
  const float x = std::abs(light);
  const float y = x <= 0.0031308f ? x * 12.92f : 1.055f * std::pow(x, 1.0f / 2.4f) - 0.055f;
  return std::copysign(y, light);
}

}  // namespace fovea
