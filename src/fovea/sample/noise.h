#pragma once

#include <cstdint>

#include "fovea/base/math.h"

namespace fovea::sample {

/// Gradient noise (Perlin 2002) with hashed gradients: smooth, 0 at whole coordinates, about [-1, 1],
/// features of size 1. The same on every machine.
double gradient_noise(Vec2d p, std::uint64_t seed);
double gradient_noise(Vec3d p, std::uint64_t seed);

/// Sum of `octaves` noises, each of twice the frequency and half the amplitude of the one before;
/// about [-1, 1].
double fractal_noise(Vec2d p, int octaves, std::uint64_t seed);
double fractal_noise(Vec3d p, int octaves, std::uint64_t seed);

/// Ridged multifractal (Musgrave 1993): sharp crests with detail where it is high; about [0, 1].
double ridged_noise(Vec2d p, int octaves, std::uint64_t seed);

/// Distances to the nearest and second nearest of points scattered one per unit square.
struct Cell {
  double nearest = 0, second = 0;
  std::uint32_t id = 0;  ///< Of the nearest point: random bits.
};
Cell cell_noise(Vec2d p, std::uint64_t seed);

}  // namespace fovea::sample
