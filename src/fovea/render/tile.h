#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <vector>

#include "fovea/render/scan_convert.h"
#include "fovea/render/screen.h"

// Private to render: what covers the samples of a tile.

namespace fovea {

/// A sample of a blended triangle in front of all opaque ones.
struct BlendedSample {
  std::uint32_t sample = 0;  ///< In the tile.
  float nearness = 0;
  std::uint32_t triangle = 0;
};

/// The nearest opaque triangle at each sample of a tile, and the blended ones in front of it.
class TileSamples {
 public:
  /// `column` and `row` of the tile in the grid.
  TileSamples(const SampleGrid& grid, int column, int row);

  /// Draws opaque triangles; of equally near ones the first drawn stays.
  void draw(const ScreenTriangle& triangle);
  /// Draws where `keep` of the sample's place in the picture (pixels) says so.
  void draw_where(const ScreenTriangle& triangle, const std::function<bool(double x, double y)>& keep);
  /// Notes a blended triangle. To be called after all opaque ones are drawn.
  void blend(const ScreenTriangle& triangle, std::vector<BlendedSample>& out) const;

  int width() const { return rect_.width; }    ///< Samples.
  int height() const { return rect_.height; }  ///< Samples.
  std::uint32_t triangle(int x, int y) const { return triangle_[index(x, y)]; }
  float nearness(int x, int y) const { return nearness_[index(x, y)]; }

 private:
  static std::size_t index(int x, int y) {
    return static_cast<std::size_t>(y) * SampleGrid::kTileSamples + static_cast<std::size_t>(x);
  }

  SampleRect rect_;  // in the grid
  int per_pixel_ = 1;
  std::array<float, std::size_t{SampleGrid::kTileSamples} * SampleGrid::kTileSamples> nearness_;
  std::array<std::uint32_t, std::size_t{SampleGrid::kTileSamples} * SampleGrid::kTileSamples> triangle_;
};

}  // namespace fovea
