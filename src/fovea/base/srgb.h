#pragma once

#include <cstdint>

namespace fovea {

// The sRGB curve (IEC 61966-2-1) between display values and amounts of light, both 0 … 1. Without functions
// of the C library that differ between machines: the same bits everywhere.

/// Display value to light; odd around 0.
float srgb_to_linear(float display);
/// Light to display value: the inverse.
float linear_to_srgb(float light);

/// Amount of light of a display value as a byte.
float to_light(std::uint8_t display);
/// The display value as a byte that is nearest to an amount of light; beyond [0, 1] and for what is not a
/// number the nearest end, 0.
std::uint8_t to_display(float light);

}  // namespace fovea
