#pragma once

#include <cstdint>
#include <vector>

#include "fovea/base/context.h"
#include "fovea/cluster/dual_graph.h"
#include "fovea/model/field.h"
#include "fovea/surface/surface.h"

// Private to cluster/.

namespace fovea {

/// What clusters grow over: a surface that is about 1 large (unit_scale), ready for searches.
struct ClusterGround {
  /// `saliency` [#V], 0 or more, is scaled to 0 … 1; if it is the same everywhere, or empty, it is 0. O(#F
  /// log #F).
  ClusterGround(Surface surface, const VertexField& saliency, const Context& context);

  /// The most salient corner of a triangle, of equals the vertex with the smallest number.
  std::uint32_t peak_vertex(std::uint32_t face) const;

  Surface surface;
  Adjacency adjacency;
  DualGraph graph;
  std::vector<float> vertex_saliency;  ///< [#V], 0 … 1
  std::vector<float> face_saliency;    ///< [#F], mean of the corners.
};

}  // namespace fovea
