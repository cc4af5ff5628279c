#include "fovea/simplify/view_pricer.h"

#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "fovea/simplify/value_merge.h"

namespace fovea {

ViewPricer::ViewPricer(ViewMetric& views, CollapseState& state, const EdgeCost& cost, Placement placement,
                       int threads)
    : views_(views), mesh_(state.mesh), cost_(cost), placement_(placement) {
  for (int i = 0; i < threads; ++i) memory_.push_back(views.make_memory(state));
}

void ViewPricer::price(std::uint32_t e, const Quadric& q) {
  price(e, q, std::numeric_limits<double>::infinity(), memory_.front());
}

void ViewPricer::price(std::span<const EdgeLimit> edges) {
  views_.team().run(edges.size(), [&](std::size_t i) {
    ViewMetric::Memory memory = take_memory();
    price(edges[i].edge, cost_.quadric(edges[i].edge), edges[i].limit, memory);
    give_back(std::move(memory));
  });
}

/// Notes the best place at its price, or at one beyond the limit. Of half-edge collapses the cheaper.
void ViewPricer::price(std::uint32_t e, const Quadric& q, double limit, ViewMetric::Memory& memory) {
  const auto [a, b] = mesh_.edges[e].ends;
  PartialChange part = views_.noted_part(e);
  if (placement_ != Placement::half_edge) {
    Candidate best = cost_.best_place(e, q);
    if (std::isfinite(best.cost)) {
      memory.merge.plan(e, a, b, best.position);
      best.cost = views_.price_up_to(limit, e, best, memory.merge, *memory.scratch, part);
    }
    views_.note(e, best, part);
    return;
  }
  std::array<Candidate, 3> places;
  const std::size_t count = cost_.fallbacks(e, q, places.data());
  Candidate best;
  for (std::size_t i = 0; i < count; ++i) {
    memory.merge.plan(e, a, b, places[i].position);
    const double price = views_.price(e, places[i], memory.merge, *memory.scratch);
    if (price < best.cost) best = {price, places[i].position};
  }
  views_.note(e, best, views_.whole());
}

/// A memory that no other thread uses.
ViewMetric::Memory ViewPricer::take_memory() {
  const std::lock_guard lock(mutex_);
  ViewMetric::Memory memory = std::move(memory_.back());
  memory_.pop_back();
  return memory;
}

void ViewPricer::give_back(ViewMetric::Memory&& memory) {
  const std::lock_guard lock(mutex_);
  memory_.push_back(std::move(memory));
}

}  // namespace fovea
