#pragma once

#include <cstdint>

#include "fovea/model/image.h"

/// Pictures made by a formula, so that values of other programs can be stored for them.
namespace fovea::test {

/// Stripes, checks and rings of three channels.
Image8 pattern(int width, int height);

/// `image` with its right half shifted by two pixels, noise in its lower half and an inverted square: coarse
/// and fine differences.
Image8 distorted(const Image8& image);

/// Square, each byte of its three channels `value`.
Image8 even(int size, std::uint8_t value);

}  // namespace fovea::test
