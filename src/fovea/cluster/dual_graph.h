#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

#include "fovea/base/context.h"
#include "fovea/base/math.h"
#include "fovea/surface/surface.h"

// Private to cluster/.

namespace fovea {

/// The triangles of a surface as nodes of a connected graph. Triangles that share an edge are linked, those
/// on a non-manifold edge in a ring; bridges (bridges.h) link what would be apart otherwise.
struct DualGraph {
  struct Link {
    std::uint32_t face = 0;
    float distance = 0;  ///< Between the centres.
  };

  std::vector<std::uint32_t> first_link;  ///< [#F + 1]
  std::vector<Link> links;     ///< Each in both directions; those of a face in rising order of faces.
  std::vector<Vec3f> centers;  ///< [#F]
  std::vector<Vec3f> normals;  ///< [#F], unit; 0 for degenerate triangles.
  std::vector<float> areas;    ///< [#F]

  std::size_t face_count() const { return areas.size(); }
  /// What a triangle counts where triangles are averaged: its area, so much that degenerate ones count too.
  static double weight(float area) { return static_cast<double>(std::max(area, 1e-12f)); }
  std::span<const Link> around(std::size_t face) const {
    return {links.data() + first_link[face], links.data() + first_link[face + 1]};
  }
};

/// Of a surface that is about 1 large (unit_scale). O(#F log #F).
DualGraph dual_graph(const Surface& surface, const Context& context);

}  // namespace fovea
