#pragma once

#include <cstdint>
#include <functional>

#include "fovea/model/model.h"

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

}  // namespace fovea::bench
