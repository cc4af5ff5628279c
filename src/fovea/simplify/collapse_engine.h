#pragma once

#include <cstdint>

#include "fovea/base/context.h"
#include "fovea/simplify/collapse_state.h"
#include "fovea/simplify/record.h"
#include "fovea/simplify/simplify.h"

namespace fovea {

/// What the collapse loop leaves behind.
struct CollapseOutcome {
  CollapseRecord record;
  StopReason stop = StopReason::target;
  BlockCounts blocked;
  double error = 0;  ///< Largest error of the steps taken, in units of the scene's diagonal.
};

/// The collapse loop.
///
///     queue every edge by its cost, every component by the cost of losing it
///     while there are too many triangles
///       take the cheapest
///       if it is a component: drop its triangles
///       find the cheapest legal position for the merged vertex
///       none, or dearer than thought: put it back at that price
///       merge quadrics, fit attribute values, rewire, record
///       cost the edges around the merged vertex again
///
/// Where the
/// surface's topology forbids a collapse it is put off by a constant factor rather than refused,
/// unless `keep_topology`: a model of many handles and parts still reaches its target, late.
///
/// `state` is used up. Stops at `target_triangles`, or when every collapse left exceeds `max_error`
/// (units of the scene's diagonal). Sequential, O(#steps · one-ring); the initial costs are parallel.
CollapseOutcome collapse(CollapseState& state, std::uint64_t target_triangles, double max_error,
                         const SimplifyOptions& options, Context& context);

}  // namespace fovea
