#pragma once

#include <array>
#include <span>
#include <vector>

#include "fovea/base/context.h"
#include "fovea/model/field.h"
#include "fovea/surface/neighborhood.h"
#include "fovea/surface/surface.h"

namespace fovea {

/// Widths of a Gaussian at the centre and of one around it, as lengths.
struct ScalePair {
  double center = 0, surround = 0;
};

/// How much signals differ from their surroundings at several scales: |G(f, center) − G(f, surround)| for
/// each pair. The same for every signal: curvature, intensity, opponency, entropy. Widths that pairs share
/// are averaged once. `weights` as for `gaussian_averages`. [#signals][#pairs][#V]. Cost: that of
/// `gaussian_averages`.
std::vector<std::vector<VertexField>> center_surround(const Surface& surface, const Adjacency& adjacency,
                                                      std::span<const VertexField> signals,
                                                      std::span<const ScalePair> pairs,
                                                      const Neighborhood& neighborhood,
                                                      const Context& context,
                                                      std::span<const VertexField> weights = {});

/// Promotes fields with few strong peaks (Itti, Koch, Niebur 1998; on meshes Lee et al. 2005): scales the
/// field to [0, 1] and multiplies it by (M − m)², with M = 1 its maximum and m the mean of the other local
/// maxima (vertices above all their neighbours; 0 if there are none). A field without differences becomes 0.
/// O(#E).
VertexField promote_peaks(const VertexField& field, const Adjacency& adjacency);

}  // namespace fovea
