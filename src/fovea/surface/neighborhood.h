#pragma once

#include <span>
#include <vector>

#include "fovea/base/context.h"
#include "fovea/model/field.h"
#include "fovea/surface/surface.h"

namespace fovea {

/// How far two vertices are from each other.
enum class DistanceKind {
  euclidean,  ///< In a straight line through space.
  geodesic,   ///< Over the surface, exactly (geodesic.h).
  diffusion,  ///< Over the surface, by heat flow (diffusion.h): for large meshes.
};

/// Averages of a field under Gaussians of the widths `sigmas` (rising):
///   G(f, σ)(v) = Σ_x f(x) exp(−d(v, x)² / 2σ²) / Σ_x exp(−d(v, x)² / 2σ²)
/// over the vertices x with d(v, x) ≤ `cutoff` · σ (Lee et al. 2005 have a cutoff of 2, Munaretti 2007 of 1).
/// Vertices without triangles keep their value and count nowhere.
///
/// By `diffusion` vertices count by their area rather than each alike, and the heat flows for the time that
/// gives a Gaussian of the same second moment as the one that is cut off.
///
/// [#sigmas][#V]. Parallel; the same bits for any number of threads. Cost: by `euclidean` and `geodesic` what
/// is within the largest radius of every vertex; by `diffusion` a few dozen products with a sparse matrix.
std::vector<VertexField> gaussian_averages(const Surface& surface, const Adjacency& adjacency,
                                           const VertexField& field, std::span<const double> sigmas,
                                           double cutoff, DistanceKind kind, const Context& context);

}  // namespace fovea
