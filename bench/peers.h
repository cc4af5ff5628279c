#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "fovea/model/model.h"
#include "fovea/surface/surface.h"

namespace fovea::bench {

/// A simplification that is ready to start: data is in the peer's own layout already, the call does
/// nothing but simplify to `ratio` of the triangles and returns how many are left.
using PeerWork = std::function<std::uint64_t()>;

/// meshopt_simplify without an error bound, mesh by mesh. `welded` gives it the positions alone;
/// otherwise it gets vertices split at seams, which it keeps (Debian's version has no attribute
/// error).
PeerWork meshopt_peer(const Model& model, double ratio, bool welded);

/// CGAL's edge collapse with Garland and Heckbert's plane quadrics, positions only. Meshes that are
/// no oriented manifold lose the triangles that do not fit.
PeerWork cgal_peer(const Model& model, double ratio);

/// Exact distances over a surface from one vertex to others by CGAL's Surface_mesh_shortest_path, which knows
/// no radius. [#targets]; empty for what is no oriented manifold.
std::vector<double> cgal_geodesics(const Surface& surface, std::uint32_t source,
                                   std::span<const std::uint32_t> targets);

}  // namespace fovea::bench
