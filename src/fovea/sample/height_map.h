#pragma once

#include <cstdint>
#include <vector>

namespace fovea::sample {

/// Heights at the corners of a square grid, read between them; x and y from 0 to 1.
class HeightMap {
 public:
  explicit HeightMap(int size) : size_(size), heights_(static_cast<std::size_t>(size) * size) {}

  int size() const { return size_; }
  double& at(int x, int y) { return heights_[index(x, y)]; }
  double at(int x, int y) const { return heights_[index(x, y)]; }
  /// Bicubic (Catmull-Rom), clamped to the square.
  double read(double x, double y) const;
  /// Bilinear: for what is smooth already.
  double read_linear(double x, double y) const;

 private:
  std::size_t index(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(size_) + static_cast<std::size_t>(x);
  }
  int size_;
  std::vector<double> heights_;
};

/// Mountains from ridged noise with a valley, 0 … about 1.
HeightMap make_mountains(int size, std::uint64_t seed);

/// Lets `drops` drops of rain run down the map, carrying ground with them (after Beyer 2015). Returns
/// how often water came by, per grid point.
HeightMap erode(HeightMap& map, int drops, std::uint64_t seed);

/// Mean over a square of (2 radius + 1)² grid points, twice: close to a Gaussian.
HeightMap blur(const HeightMap& map, int radius);

/// Share of the sun that reaches each grid point past the mountains, 0 … 1. `east`, `north` and `up`
/// point to the sun (y grows to the south); heights count in widths of the map.
HeightMap cast_light(const HeightMap& map, double east, double north, double up);

}  // namespace fovea::sample
