#pragma once

#include <cstdint>
#include <mutex>
#include <span>
#include <vector>

#include "fovea/simplify/edge_cost.h"
#include "fovea/simplify/simplify.h"
#include "fovea/simplify/view_metric.h"

// Private to simplify.

namespace fovea {

/// An edge to price, and the price beyond which no more views are asked.
struct EdgeLimit {
  std::uint32_t edge = 0;
  double limit = 0;
};

/// Finds the best places of edges by what views lose there, and notes them in the metric
/// (`ViewMetric::noted`). Several at once, each thread with a memory of its own.
class ViewPricer {
 public:
  /// Keeps references to all.
  ViewPricer(ViewMetric& views, CollapseState& state, const EdgeCost& cost, Placement placement, int threads);

  /// By all views.
  void price(std::uint32_t e, const Quadric& q);
  /// In parallel.
  void price(std::span<const EdgeLimit> edges);

  /// For other prices of this metric; not while edges are priced.
  ViewCost::Scratch& scratch() { return *memory_.front().scratch; }

 private:
  void price(std::uint32_t e, const Quadric& q, double limit, ViewMetric::Memory& memory);
  ViewMetric::Memory take_memory();
  void give_back(ViewMetric::Memory&& memory);

  ViewMetric& views_;
  CollapseMesh& mesh_;
  const EdgeCost& cost_;
  const Placement placement_;
  std::vector<ViewMetric::Memory> memory_;  // [#threads], less those in use
  std::mutex mutex_;
};

}  // namespace fovea
