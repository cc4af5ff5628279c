#pragma once

#include <cstdint>

#include "fovea/base/context.h"
#include "fovea/simplify/collapse_state.h"
#include "fovea/simplify/record.h"
#include "fovea/simplify/simplify.h"

namespace fovea {

class ViewMetric;

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
///       put it back if it costs more by now than it was queued for
///       if it is a component: drop its triangles
///       find the cheapest legal position for the merged vertex
///       none, or dearer than thought: put it back at that price
///       merge quadrics, fit attribute values, rewire, record
///
/// A merge adds to the cost of the edges around (but for the rare seam that ends there), so what they are
/// queued for stays a lower bound and is corrected when they come up. Several dozen are under way at once,
/// each in another stage, because memory is slow: what a stage reads is asked for a few edges earlier. They
/// cost about the same, and one is priced again if something around it has changed meanwhile.
///
/// A collapse that breaks the surface's topology is put off by a constant factor rather than refused, unless
/// `keep_topology`: a model of many handles and parts still reaches its target, late. So is one that leaves
/// next to nothing of a thin part.
///
/// Stops at `target_triangles`, or when every collapse left exceeds `max_error` (units of the scene's
/// diagonal). Sequential, O(#steps · one-ring); the initial costs are parallel. `state` is what is left, and
/// may be collapsed further: `outcome` goes on from what came before.
///
/// With `views`, which have looked at `state`, edges are priced by what these lose; else by the quadric
/// error.
void collapse(CollapseState& state, std::uint64_t target_triangles, double max_error,
              const SimplifyOptions& options, ViewMetric* views, Context& context, CollapseOutcome& outcome);

}  // namespace fovea
