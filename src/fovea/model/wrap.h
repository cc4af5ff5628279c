#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "fovea/model/material.h"

namespace fovea {

/// The texel of a row (or column) of `size` that a sampler reads at index `i`.
inline int wrapped_texel(std::int64_t i, int size, Wrap wrap) {
  if (i >= 0 && i < size) return static_cast<int>(i);
  if (wrap == Wrap::clamp) return i < 0 ? 0 : size - 1;
  const std::int64_t period = wrap == Wrap::mirror ? std::int64_t{2} * size : size;
  const std::int64_t rest = i % period, at = rest < 0 ? rest + period : rest;
  return static_cast<int>(at < size ? at : period - 1 - at);
}

/// A texture coordinate brought back into [0, 1] (repeat: [0, 1), but for rounding).
inline float wrapped_coordinate(float u, Wrap wrap) {
  if (wrap == Wrap::repeat) return u - std::floor(u);
  if (wrap == Wrap::clamp) return std::clamp(u, 0.0f, 1.0f);
  u -= 2 * std::floor(0.5f * u);
  return u > 1 ? 2 - u : u;
}

/// Turns of a texture beyond which floats know little of where in a texel they are.
inline constexpr float kMostTurns = 1e6f;

/// A texture coordinate that can be looked up: 0 for those beyond `kMostTurns` and not finite ones.
inline float usable_coordinate(float u) { return std::abs(u) < kMostTurns ? u : 0; }

/// The texel of a row of `size` in which a sampler finds a usable coordinate.
inline int nearest_texel(float u, int size, Wrap wrap) {
  return std::min(static_cast<int>(wrapped_coordinate(u, wrap) * static_cast<float>(size)), size - 1);
}

}  // namespace fovea
