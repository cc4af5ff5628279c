#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "fovea/budget/seen_detail.h"
#include "fovea/model/image.h"

namespace fovea {

/// The wavelet transform of Cohen, Daubechies and Feauveau with filters of 9 and 7 taps, in place, by lifting
/// (Daubechies and Sweldens 1998), `levels` times: `plane` [height × width] becomes its smooth part, of half
/// the sides rounded up, in the top left, what columns, rows and both add to it around, and so on inside the
/// smooth part. Any size; beyond the borders the plane is mirrored. Scaled to be nearly orthonormal: squares
/// of coefficients add up to squares of values within some 15 %. O(#values).
void transform(std::span<float> plane, int width, int height, int levels);
/// The way back.
void inverse_transform(std::span<float> plane, int width, int height, int levels);

/// An image as whole multiples of `step` of its wavelet coefficients.
struct WaveletImage {
  int width = 0, height = 0;
  int channels = 0;  ///< As of the image: 1 grey, 2 with alpha, 3 colour, 4 with alpha.
  int levels = 0;
  float step = 1;  ///< In display values, 0 … 255.
  ColorEncoding encoding = ColorEncoding::srgb;
  std::vector<std::vector<std::int32_t>>
      planes;  ///< [channels][height × width], laid out as `transform` does.

  friend bool operator==(const WaveletImage&, const WaveletImage&) = default;
};

/// Levels until the smooth part is at most 8 values long.
int wavelet_levels(int width, int height);

/// Colours become brightness and two differences of display values (Y′CbCr of ITU-R BT.601, full range),
/// which makes most coefficients of the differences 0; errors of all three weigh about alike in red, green
/// and blue (3 : 3.3 : 2.5), so one step serves all. Magnitudes are rounded up from two thirds of a step on,
/// not from half of it, as many small coefficients cost more bits than they are worth. Throws Error(usage)
/// for a step that is not above 0.
WaveletImage wavelet_image(const Image8& image, float step);
Image8 reconstructed(const WaveletImage& wavelets);

/// What pruning leaves.
struct PrunedWavelets {
  WaveletImage image;
  std::uint64_t kept = 0;  ///< Coefficients of one plane that may be other than 0.
};

/// Leaves out what cannot be seen from 2^`octaves` times as far as `map` was made for: coefficients of level
/// l (1 the finest) stand for waves of 2^l to 2^(l + 1) texels, and a picture shows waves of two pixels and
/// longer, so they stay where a texel takes at least 2^(octaves − l) pixels, and next to there, as waves
/// reach beyond their places. The smooth part always stays. (Horbelt, Balmelli and Vetterli 2001, with d = d₀
/// 2^octaves; what stays from far also stays from nearby.)
PrunedWavelets pruned(const WaveletImage& wavelets, const ResolutionMap& map, double octaves);

/// All of it in few bytes: band by band from the coarsest, squares without any coefficient as a bit, the rest
/// by adaptive arithmetic coding with neighbours and the coarser band as context. Throws Error(limit) for
/// more than 2^28 values. O(#values · log side).
std::vector<std::uint8_t> encode(const WaveletImage& wavelets);
/// The way back, exactly. Throws Error(format) for what `encode` did not write, as far as that shows,
/// Error(limit) for more than `max_pixels`.
WaveletImage decode_wavelets(std::span<const std::uint8_t> bytes, std::int64_t max_pixels = 1 << 26);

}  // namespace fovea
