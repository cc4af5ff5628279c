#pragma once

#include <span>

#include "fovea/base/context.h"
#include "fovea/model/tri_mesh.h"
#include "fovea/simplify/collapse_state.h"
#include "fovea/simplify/simplify.h"

namespace fovea {

/// What a state that is laid out begins with: how long a unit of each attribute is, the quadrics of vertices
/// and of values by the faces around them and by boundaries and seams, and what it costs if a component goes.
/// `importance` [#V] multiplies quadrics; empty is 1 everywhere. O(#F · #channels), parallel.
void add_first_quadrics(CollapseState& state, std::span<const TriMesh* const> meshes,
                        std::span<const double> importance, const SimplifyOptions& options,
                        const Context& context);

}  // namespace fovea
