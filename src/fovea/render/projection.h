#pragma once

#include <array>
#include <vector>

#include "fovea/base/math.h"
#include "fovea/render/screen_vertex.h"
#include "fovea/render/view.h"

namespace fovea {

/// The samples of a picture: `per_pixel` × `per_pixel` in each pixel, on a regular grid. They are worked on
/// in square tiles of whole pixels.
struct SampleGrid {
  int width = 0, height = 0;  ///< Of the picture, in pixels.
  int per_pixel = 1;          ///< 1 … kMostPerPixel, along each axis.

  static constexpr int kMostPerPixel = 8;
  static constexpr int kTileSamples = 128;  ///< Most along each axis.
  int tile_pixels() const { return kTileSamples / per_pixel; }
  int columns() const { return (width + tile_pixels() - 1) / tile_pixels(); }
  int rows() const { return (height + tile_pixels() - 1) / tile_pixels(); }
};

/// From eye space to the screen and back.
class Projection {
 public:
  Projection(const View& view, const SampleGrid& grid);
  const View& view() const { return view_; }

  /// False for points that are too near or too far outside of the picture to be put on the grid.
  bool project(Vec3d eye, ScreenVertex& out) const;
  /// Where a point of the picture (in pixels, from the top left) is at distance 1 (in parallel projection:
  /// at any).
  Vec2d to_plane(double x, double y) const;
  /// Plane units per pixel, to the right and up.
  double pixel() const { return pixel_; }
  /// The part of a triangle that can be put on the grid, as a fan; empty if there is none.
  std::vector<ScreenVertex> clip(const std::array<Vec3d, 3>& eye) const;

 private:
  View view_;
  double half_width_ = 1;  // of the plane
  double scale_ = 1;       // plane to screen units
  double center_x_ = 0, center_y_ = 0;
  double pixel_ = 1;
};

}  // namespace fovea
