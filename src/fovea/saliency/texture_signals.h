#pragma once

#include <algorithm>
#include <array>
#include <cstdint>

#include "fovea/base/context.h"
#include "fovea/model/image.h"
#include "fovea/model/material.h"

namespace fovea {

/// How the texels of an image are judged.
struct TextureSignalOptions {
  int entropy_window = 9;  ///< n of the n × n texels around each; odd, 3 … 63.
  int entropy_bins = 32;   ///< Greys that are told apart; 2 … 256.
};

/// What the texels of an image say to the eye (Yang et al. 2016, section 4). One channel each, all of one
/// size.
struct TextureSignals {
  ImageF intensity;  ///< (r + g + b) / 3: 0 … 1.
  ImageF opponency;  ///< Of red and green plus that of blue and yellow: −1 … 2.
  ImageF entropy;    ///< Of greys in the window, in bits: 0 … log₂ of the bins.
};

/// Intensity and opponency of one colour, as display values 0 … 1: (r − g) / max + (b − min(r, g)) / max; 0
/// where the maximum is below 0.01.
struct ColorSignals {
  float intensity = 0, opponency = 0;
};
inline ColorSignals color_signals(float r, float g, float b) {
  constexpr float kDark = 0.01f;
  const float least = std::min(r, g), most = std::max(std::max(r, g), b);
  const float opponency = (r - g + b - least) / std::max(most, kDark);
  return {(r + g + b) * (1.0f / 3), most < kDark ? 0.0f : opponency};
}

/// Grey of display values: 0.30 r + 0.59 g + 0.11 b.
inline float grey(float r, float g, float b) { return 0.30f * r + 0.59f * g + 0.11f * b; }

/// Most texels of an image that are judged; larger ones are reduced first.
inline constexpr std::int64_t kMostTexels = std::int64_t{4096} * 4096;

/// The image's colours times light, rounded to bytes again: a colour factor on its texels. Three channels.
/// O(#texels), parallel.
Image8 with_factor(const Image8& image, const std::array<double, 3>& light, const Context& context);

/// The image smoothed by the kernel 1 2 1 both ways, exactly: [height × width × 3], kSmoothUnit stands for
/// 1. Alpha is left out, grey repeated. What is beyond the border is as `sampler` wraps it. O(#texels),
/// parallel.
Image<std::uint16_t> smoothed(const Image8& image, const Sampler& sampler, const Context& context);
inline constexpr int kSmoothUnit = 16 * 255;

/// Signals of the texels of an image, from its stored display values as the paper has it, smoothed as by
/// `smoothed`. Greys of the window around a texel count in bins of equal width; beyond the border they are as
/// `sampler` wraps them. Images beyond kMostTexels are `fitted` first. Exact: the same bits as by counting
/// each window anew, for any number of threads. O(#texels · window), parallel; 13 bytes per texel.
///
/// Throws Error(usage) for options out of range.
TextureSignals texture_signals(const Image8& image, const Sampler& sampler,
                               const TextureSignalOptions& options, const Context& context);

}  // namespace fovea
