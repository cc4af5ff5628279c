#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "fovea/base/context.h"
#include "fovea/render/scene.h"

// Private to render: triangles on their way from the scene to the tiles of a picture.

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

/// A vertex on the sample grid, x to the right, y down. In 1/256 of the distance between samples, which are
/// at odd multiples of 128.
struct ScreenVertex {
  std::int32_t x = 0, y = 0;
  float nearness = 0;  ///< Linear on the screen, larger in front: 1 / distance, or −distance in parallel.
};

constexpr int kSubsampleBits = 8;

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

/// A triangle of the scene on the screen.
struct ScreenTriangle {
  std::array<ScreenVertex, 3> v;
  std::uint32_t triangle = 0;  ///< In the scene.
  std::uint32_t mesh = 0;      ///< That it belongs to, in the scene.
};

/// All triangles that may cover a sample, sorted into tiles.
class TileBins {
 public:
  /// Projects the scene; leaves out triangles that face away and are not double-sided, and those between
  /// samples. In each tile triangles are in the order of the scene. O(#V + #F).
  TileBins(const RenderScene& scene, const Projection& projection, const SampleGrid& grid,
           const Context& context);

  /// The opaque (or alpha-tested) triangles that touch a tile.
  std::span<const std::uint32_t> opaque(std::size_t tile) const { return list(opaque_, tile); }
  /// Those that are blended.
  std::span<const std::uint32_t> blended(std::size_t tile) const { return list(blended_, tile); }
  /// An entry of a list.
  ScreenTriangle at(std::uint32_t entry) const;

 private:
  struct Lists {
    std::vector<std::uint32_t> first;  // [#tiles + 1] into entries
    std::vector<std::uint32_t> entries;
  };
  struct Chunk;

  std::span<const std::uint32_t> list(const Lists& lists, std::size_t tile) const {
    return {lists.entries.data() + lists.first[tile], lists.entries.data() + lists.first[tile + 1]};
  }
  void project(const Projection& projection, const Context& context);
  void sort(const Projection& projection, const SampleGrid& grid, std::size_t begin, std::size_t end,
            Chunk& chunk) const;
  void gather(const std::vector<Chunk>& chunks, std::size_t tiles, bool blended, Lists& lists) const;

  const RenderScene& scene_;
  std::vector<std::vector<ScreenVertex>> vertices_;  // [#meshes][#V]
  std::vector<ScreenTriangle> clipped_;              // entries from triangle_count on
  Lists opaque_, blended_;
};

}  // namespace fovea
