#pragma once

#include <vector>

#include "fovea/base/context.h"
#include "fovea/model/field.h"
#include "fovea/surface/neighborhood.h"
#include "fovea/surface/surface.h"

namespace fovea {

/// How mesh saliency looks at a surface.
struct MeshSaliencyOptions {
  Neighborhood neighborhood;
  double unit_rel =
      0.003;  ///< ε, of the surface's diagonal; the centres are 2 … 6 ε wide, their surroundings twice.
};
/// As published: straight distances, cut off at two widths (Lee, Varshney, Jacobs 2005) ...
inline constexpr MeshSaliencyOptions kLeeSaliency{{DistanceKind::euclidean, 2, VertexWeight::one}, 0.003};
/// ... and exact geodesic ones, cut off at one (Munaretti 2007).
inline constexpr MeshSaliencyOptions kMunarettiSaliency{{DistanceKind::geodesic, 1, VertexWeight::one},
                                                        0.003};

/// Where a surface stands out by its shape, with what that was made of.
struct MeshSaliency {
  VertexField curvature;               ///< Mean curvature (curvature.h).
  std::vector<VertexField> contrasts;  ///< [5] from fine to coarse, before their peaks are promoted.
  VertexField saliency;                ///< [#V], ≥ 0; not scaled to 1.
};

/// Centre-surround contrast of mean curvature over five scales, peaks promoted at each, added up (Lee et al.
/// 2005, Munaretti 2007). A number everywhere, and the same in any unit of length; 0 on vertices without
/// triangles. Works on the surface in a local order (local_order.h). Throws Error(unsupported) for triangles
/// beyond what floats hold. Cost: that of `gaussian_averages`.
MeshSaliency mesh_saliency(const Surface& surface, const MeshSaliencyOptions& options,
                           const Context& context);

}  // namespace fovea
