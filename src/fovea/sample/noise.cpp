#include "fovea/sample/noise.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace fovea::sample {

namespace {

/// Random bits of a lattice point: a multiplicative mix, as seeds and coordinates are small.
std::uint32_t hash(std::int64_t x, std::int64_t y, std::int64_t z, std::uint64_t seed) {
  std::uint32_t h =
      static_cast<std::uint32_t>(x) * 0x8DA6B343u ^ static_cast<std::uint32_t>(y) * 0xD8163841u ^
      static_cast<std::uint32_t>(z) * 0xCB1AB31Fu ^ static_cast<std::uint32_t>(seed) * 0x9E3779B1u;
  h = (h ^ h >> 15) * 0x2C1B3C6Du;
  h = (h ^ h >> 12) * 0x297A2D39u;
  return h ^ h >> 15;
}

double fade(double t) { return t * t * t * (t * (t * 6 - 15) + 10); }
double blend(double a, double b, double t) { return a + (b - a) * t; }

double slope(std::uint32_t h, double x, double y) {
  constexpr double kHalf = 0.70710678118654752;
  constexpr std::array<Vec2d, 8> kDirections{
      {{1, 0}, {-1, 0}, {0, 1}, {0, -1}, {kHalf, kHalf}, {-kHalf, kHalf}, {kHalf, -kHalf}, {-kHalf, -kHalf}}};
  const Vec2d g = kDirections[h >> 29];
  return g.x * x + g.y * y;
}

double slope(std::uint32_t h, double x, double y, double z) {
  // The twelve directions to the edges of a cube, four of them twice.
  const double u = (h >> 28) < 8 ? x : y;
  const double v = (h >> 28) < 4 ? y : ((h >> 28) == 12 || (h >> 28) == 14 ? x : z);
  return ((h >> 28 & 1) ? -u : u) + ((h >> 28 & 2) ? -v : v);
}

/// Each octave has a seed of its own, so that crests do not pile up at the origin.
std::uint64_t octave_seed(std::uint64_t seed, int octave) {
  return seed + 0x9E3779B9u * static_cast<std::uint64_t>(octave + 1);
}

template <class Point>
double octave_sum(Point p, int octaves, std::uint64_t seed) {
  double sum = 0, amplitude = 1, total = 0;
  for (int i = 0; i < octaves; ++i) {
    sum += amplitude * gradient_noise(p, octave_seed(seed, i));
    total += amplitude;
    p = p * 2.0;
    amplitude *= 0.5;
  }
  return total > 0 ? sum / total : 0;
}

}  // namespace

double gradient_noise(Vec2d p, std::uint64_t seed) {
  const double fx = std::floor(p.x), fy = std::floor(p.y);
  const auto ix = static_cast<std::int64_t>(fx), iy = static_cast<std::int64_t>(fy);
  const double x = p.x - fx, y = p.y - fy, u = fade(x);
  const auto at = [&](int i, int j) { return slope(hash(ix + i, iy + j, 0, seed), x - i, y - j); };
  const double low = blend(at(0, 0), at(1, 0), u), high = blend(at(0, 1), at(1, 1), u);
  constexpr double kToUnit = 1.5;
  return kToUnit * blend(low, high, fade(y));
}

double gradient_noise(Vec3d p, std::uint64_t seed) {
  const double fx = std::floor(p.x), fy = std::floor(p.y), fz = std::floor(p.z);
  const auto ix = static_cast<std::int64_t>(fx), iy = static_cast<std::int64_t>(fy),
             iz = static_cast<std::int64_t>(fz);
  const double x = p.x - fx, y = p.y - fy, z = p.z - fz;
  const double u = fade(x), v = fade(y);
  const auto layer = [&](int k) {
    const auto at = [&](int i, int j) {
      return slope(hash(ix + i, iy + j, iz + k, seed), x - i, y - j, z - k);
    };
    return blend(blend(at(0, 0), at(1, 0), u), blend(at(0, 1), at(1, 1), u), v);
  };
  return blend(layer(0), layer(1), fade(z));
}

double fractal_noise(Vec2d p, int octaves, std::uint64_t seed) { return octave_sum(p, octaves, seed); }
double fractal_noise(Vec3d p, int octaves, std::uint64_t seed) { return octave_sum(p, octaves, seed); }

double ridged_noise(Vec2d p, int octaves, std::uint64_t seed) {
  double sum = 0, amplitude = 0.5, weight = 1;
  for (int i = 0; i < octaves; ++i) {
    const double crest = 1 - std::abs(gradient_noise(p, octave_seed(seed, i)));
    const double signal = crest * crest * weight;
    sum += amplitude * signal;
    weight = std::min(1.0, signal * 1.8);
    p = p * 2.03;
    amplitude *= 0.5;
  }
  return sum;
}

Cell cell_noise(Vec2d p, std::uint64_t seed) {
  const double fx = std::floor(p.x), fy = std::floor(p.y);
  Cell cell{9, 9, 0};
  for (int j = -1; j <= 1; ++j) {
    for (int i = -1; i <= 1; ++i) {
      const std::uint32_t h =
          hash(static_cast<std::int64_t>(fx) + i, static_cast<std::int64_t>(fy) + j, 1, seed);
      const double x = fx + i + (h & 0xFFFF) / 65536.0 - p.x, y = fy + j + (h >> 16) / 65536.0 - p.y;
      const double distance = std::sqrt(x * x + y * y);
      if (distance < cell.nearest) {
        cell = {distance, cell.nearest, h};
      } else if (distance < cell.second) {
        cell.second = distance;
      }
    }
  }
  return cell;
}

}  // namespace fovea::sample
