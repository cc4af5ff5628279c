#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "fovea/lod/live_level.h"
#include "fovea/lod/multi_tessellation.h"
#include "fovea/model/key_table.h"
#include "fovea/model/model.h"
#include "fovea/surface/closest_point.h"
#include "fovea/surface/facing_point.h"
#include "fovea/surface/surface.h"

namespace fovea::bench {

/// What is wrong with a level.
struct LevelFaults {
  std::size_t cracks =
      0;  ///< Edges of one triangle that no edge of the original of one, three, ... has become.
  std::size_t non_manifold = 0;  ///< Edges of three triangles or more, or of two that disagree in direction.
  std::size_t doubled = 0;       ///< Triangles with the vertices of another.
  std::size_t turned = 0;  ///< Triangles that face more than 120° away from the nearest of the original.
  /// Of these, those that the level's error does not allow for. Corners may be off by it to either side, so
  /// it turns slivers up to twice as high, and walls up to twice as thick have what faces like the triangle
  /// behind.
  std::size_t flipped = 0;
};

/// Looks at a level that goes from cut to cut, each time only at the triangles that have changed. Levels of a
/// record have few different ones, so what is known of one is kept. For records whose vertices do not move.
class LevelCheck {
 public:
  /// All must outlive this.
  LevelCheck(const Model& original, const MultiTessellation& levels, const LiveLevel& live);

  /// What is wrong with the level as it is now.
  LevelFaults update();
  /// Whether `level`, the same read from the record, is sound and has just these triangles and faults.
  bool is_same(const Model& level) const;

 private:
  using Corners = std::array<VertexId, 3>;
  struct Triangle {
    std::array<std::uint32_t, 3> edges{};  ///< In `edges_`.
    std::array<std::uint8_t, 3>
        forward{};               ///< Whether it goes along each from the lower vertex to the higher.
    std::uint32_t vertices = 0;  ///< In `times_`.
    float turned = 0;  ///< The least error that allows for it, if it is turned; else 0. In scene units.
  };
  std::uint32_t triangle(std::uint32_t mesh, const Corners& corners);
  std::uint32_t edge(std::uint32_t a, std::uint32_t b);
  float error_that_turns(std::uint32_t mesh, const Corners& corners) const;
  void add(const Triangle& triangle, int times);
  std::size_t count_cracks();
  std::size_t count_flipped();

  const MultiTessellation& levels_;
  const LiveLevel& live_;
  std::vector<Surface> surfaces_;                      // [#meshes]
  std::vector<double> scales_;                         // [#meshes], as nodes show them
  std::vector<ClosestPoint> nearest_;                  // [#meshes]
  std::vector<FacingPoint> facing_;                    // [#meshes]
  std::vector<std::array<std::uint32_t, 2>> borders_;  // edges of the original of one triangle, three, ...
  std::vector<std::vector<Corners>> shown_;            // [#meshes][#F], none where no triangle is there
  KeyTable triangle_numbers_{3, 0}, vertices_numbers_{3, 0}, edge_numbers_{2, 0};
  std::vector<Triangle> triangles_;
  std::vector<std::array<int, 2>> edges_;  // triangles that go along each, backward and forward
  std::vector<int> times_;                 // that triangles with these vertices are there
  std::size_t open_ = 0;
  LevelFaults now_;
};

}  // namespace fovea::bench
