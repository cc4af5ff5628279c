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
  window,     ///< In a straight line, within the local filter window of Yang et al. (2016).
  diffusion,  ///< Over the surface, by filtering its spectrum (spectral_filter.h): fast.
};

/// What a vertex counts for in an average.
enum class VertexWeight {
  one,   ///< Each alike, as published: what is finely meshed counts more.
  area,  ///< Its area: averages over the surface, whatever its mesh.
};

/// What surrounds a vertex, and how much of it counts.
struct Neighborhood {
  DistanceKind distance = DistanceKind::diffusion;
  double cutoff = 2;  ///< Gaussians end at this many widths.
  VertexWeight weight = VertexWeight::area;
};

/// Averages of fields under Gaussians of the widths `sigmas` (rising):
///   G(f, σ)(v) = Σ_x f(x) w(x) exp(−d(v, x)² / 2σ²) / Σ_x w(x) exp(−d(v, x)² / 2σ²)
/// over the vertices x with d(v, x) ≤ cutoff · σ (Lee et al. 2005 have a cutoff of 2, Munaretti 2007 of 1).
/// Vertices without triangles keep their value and count nowhere.
///
/// In the `window` of Yang et al. the neighbours along edges count at any distance, and so do the points
/// where edges leave the sphere: estimated, and given values, by the mean of the edge's ends and the two
/// corners opposite, under weights exp(−k d²) with k = 1, 1.2, 1.5, 2 from the first width to the fourth and
/// on, and d the distance to the straight crossing in mean edge lengths (the paper does not say its unit).
///
/// `weights`, one [#V] and above 0 for each field, replace what `neighborhood` says of w; an empty one leaves
/// it. By `diffusion` with weights other than areas, the filtered f w / area over the filtered w / area,
/// where w / area counts as no less than 1 / 100 and no more than 100 times its mean.
///
/// [#fields][#sigmas][#V]. Parallel; the same bits for any number of threads. Cost: but for `diffusion` what
/// is within the largest radius of every vertex; by `diffusion` some dozens of products with a sparse matrix.
/// Throws Error(cancelled).
std::vector<std::vector<VertexField>> gaussian_averages(const Surface& surface, const Adjacency& adjacency,
                                                        std::span<const VertexField> fields,
                                                        std::span<const double> sigmas,
                                                        const Neighborhood& neighborhood,
                                                        const Context& context,
                                                        std::span<const VertexField> weights = {});

}  // namespace fovea
