#pragma once

#include <functional>
#include <vector>

#include "fovea/model/field.h"
#include "fovea/surface/surface.h"

namespace fovea::test {

using Distance = std::function<double(std::uint32_t a, std::uint32_t b)>;

/// The Gaussian average at every vertex, over all vertices, by its formula; vertices count by `weights`, or
/// alike without. O(#V²).
VertexField gaussian_average(const VertexField& field, double sigma, double cutoff, const Distance& distance,
                             const VertexField& weights = {});

/// The same over the local filter window of Yang et al. (2016) with sphere and Gaussian of one radius, as
/// neighborhood.h reads it; `fall` is k. O(#V² + #V #F).
VertexField window_average(const VertexField& field, const Surface& surface, double radius, double fall);

/// Itti's normalisation by its words: scale to [0, 1], find the local maxima, multiply.
VertexField promoted(const VertexField& field, const Surface& surface);

/// Mesh saliency of Lee et al. (2005) from mean curvature, with any distance. O(#V²).
VertexField lee_saliency(const VertexField& curvature, const Surface& surface, double unit, double cutoff,
                         const Distance& distance);

/// S_b + Σ_j (S_j − S_b) at each vertex, S_b the least over the poses (Munaretti 2007, equation 4.1).
VertexField multi_pose_saliency(const std::vector<VertexField>& poses);

}  // namespace fovea::test
