#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "fovea/base/context.h"
#include "fovea/render/projection.h"
#include "fovea/render/scene.h"

// Private to render: triangles on their way from the scene to the tiles of a picture.

namespace fovea {

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
