#include "fovea/simplify/collapse_engine.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <mutex>
#include <span>
#include <utility>
#include <vector>

#include "fovea/base/parallel.h"
#include "fovea/base/prefetch.h"
#include "fovea/simplify/collapse_queue.h"
#include "fovea/simplify/collapse_step.h"
#include "fovea/simplify/edge_cost.h"
#include "fovea/simplify/legality.h"
#include "fovea/simplify/value_merge.h"
#include "fovea/simplify/view_metric.h"

namespace fovea {

namespace {

/// A collapse that breaks topology or leaves a scrap counts as this much dearer than one that does not: once
/// a thin part (a leg, a finger) is a prism, that makes a flat sheet of it and then next to nothing.
constexpr double kRuinPenalty = 4;
/// After a refusal an edge is tried again when costs have risen by this factor ...
constexpr double kRetryFactor = 2;
/// ... so often, until a change around it gives it a new life.
constexpr std::uint8_t kMaxRetries = 12;
/// A legal position may cost this much more than the edge was queued for; else the edge goes back.
constexpr double kTolerance = 1.1;
/// Edges that are looked at in parallel when views have to price one again.
constexpr std::size_t kTogether = 4;
/// So many are searched for them, in the order of the queue.
constexpr std::size_t kAhead = 64;
/// Items that are taken from the queue together, so that their memory is fetched together.
constexpr std::size_t kBatch = 16;
/// Views are asked until an edge costs so many times what it was queued for, and what was last taken.
constexpr double kEnough = 1.3;

/// An edge or component that was taken out of the queue.
struct Due {
  std::uint32_t item = kInvalid;
  double cost = 0;  ///< What it was queued for.
  // Of an edge, as it is now:
  Quadric quadric;
  Candidate place;
};

class Engine {
 public:
  Engine(CollapseState& state, std::uint64_t target, double max_error, const SimplifyOptions& options,
         ViewMetric* views, Context& context, CollapseOutcome& outcome)
      : state_(state),
        mesh_(state.mesh),
        target_(target),
        max_error_(max_error),
        options_(options),
        views_(views),
        context_(context),
        edge_count_(static_cast<std::uint32_t>(mesh_.edges.size())),
        queue_(edge_count_ + state.components.count()),
        tries_(edge_count_, 0),
        cost_(state, options.placement),
        legality_(state),
        merge_(state, options.placement),
        outcome_(outcome),
        stepper_(state, cost_, legality_, merge_, queue_, views, outcome.record, outcome.error) {
    if (views_ == nullptr) return;
    for (int i = 0; i < context.thread_count(); ++i) memory_.push_back(views_->make_memory(state));
  }

  void run() {
    fill_queue();
    reserve_record();
    outcome_.stop = loop();
    outcome_.error = stepper_.error();
    if (outcome_.stop == StopReason::stuck) count_blocked();
  }

 private:
  void fill_queue();
  void price_edges();
  void reserve_record();
  StopReason loop();
  void take_batch();
  void drop_dearer();
  void fetch_surroundings() const;
  void price(Due& due);
  void price_by_views(std::uint32_t e, const Quadric& q, double limit, ViewMetric::Memory& memory);
  void price_by_views(std::span<const Due> edges);
  ViewMetric::Memory take_memory();
  void give_back(ViewMetric::Memory&& memory);
  void take_by_views();
  void try_edge(Due& due);
  bool is_dearer(const Due& due, double price);
  bool is_legal(std::uint32_t e, Vec3d p);
  void take_or_requeue(const Due& due, const Candidate& where);
  void try_vanish(const Due& due);
  double vanish_price(std::uint32_t component);
  void find_living(std::uint32_t component);
  void put_off(const Due& due);
  void count_blocked();

  void revive_edges(std::uint32_t b);

  CollapseState& state_;
  CollapseMesh& mesh_;
  const std::uint64_t target_;
  const double max_error_;
  const SimplifyOptions& options_;
  ViewMetric* const views_;  // null: the quadric error alone
  Context& context_;
  const std::uint32_t edge_count_;
  CollapseQueue queue_;              // edges, then components
  std::vector<std::uint8_t> tries_;  // [#E], refusals since the last change around
  EdgeCost cost_;
  std::vector<ViewMetric::Memory> memory_;  // with views: [#threads], less those in use
  std::mutex memory_mutex_;
  Legality legality_;
  ValueMerge merge_;
  std::vector<Due> batch_;
  std::vector<std::uint32_t> changed_;  // vertices merged since the batch was priced
  CollapseOutcome& outcome_;
  CollapseStepper stepper_;
  double level_ = 0;  // with views: what the last item cost that was taken from the queue
  bool over_error_ = false;
  std::vector<std::uint32_t> ring_;  // scratch
};

void Engine::fill_queue() {
  price_edges();
  if (options_.keep_topology || state_.components.count() < 2) return;
  for (std::uint32_t i = 0; i < state_.components.count(); ++i) queue_.set(edge_count_ + i, vanish_price(i));
}

/// Prices all edges by the quadric error; where views decide that is the least that they can cost.
void Engine::price_edges() {
  constexpr std::uint32_t kStep = 1 << 17;
  std::vector<float> cost(std::min(edge_count_, kStep));
  for (std::uint32_t first = 0; first < edge_count_; first += kStep) {
    const std::uint32_t count = std::min(edge_count_ - first, kStep);
    parallel_for(context_, count, 1 << 13, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        const auto e = first + static_cast<std::uint32_t>(i);
        cost[i] = mesh_.edge_alive(e) ? static_cast<float>(cost_.best_place(e, cost_.quadric(e)).cost)
                                      : std::numeric_limits<float>::infinity();
      }
    });
    for (std::uint32_t i = 0; i < count; ++i) {
      if (!std::isfinite(cost[i])) continue;
      const auto quadric_cost = static_cast<double>(cost[i]);
      queue_.set(first + i, views_ == nullptr ? quadric_cost : ViewMetric::least_price(quadric_cost));
    }
  }
}

/// The price of losing what is left of a component.
double Engine::vanish_price(std::uint32_t component) {
  const double cost = state_.vanish[component].cost;
  if (views_ == nullptr) return cost;
  find_living(component);
  return views_->price_of_loss(ring_, cost, *memory_[0].scratch);
}

/// Lists the faces of a component that are left, in `ring_`.
void Engine::find_living(std::uint32_t component) {
  const FaceComponents& all = state_.components;
  ring_.clear();
  for (std::uint32_t k = all.first[component]; k < all.first[component + 1]; ++k) {
    if (mesh_.face_alive(all.faces[k])) ring_.push_back(all.faces[k]);
  }
}

/// Notes the best place for an edge by what views lose there, at that price or one beyond the limit. Of
/// half-edge collapses the cheaper.
void Engine::price_by_views(std::uint32_t e, const Quadric& q, double limit, ViewMetric::Memory& memory) {
  const auto [a, b] = mesh_.edges[e].ends;
  PartialChange part = views_->noted_part(e);
  if (options_.placement != Placement::half_edge) {
    Candidate best = cost_.best_place(e, q);
    if (std::isfinite(best.cost)) {
      memory.merge.plan(e, a, b, best.position);
      best.cost = views_->price_up_to(limit, e, best, memory.merge, *memory.scratch, part);
    }
    views_->note(e, best, part);
    return;
  }
  std::array<Candidate, 3> places;
  const std::size_t count = cost_.fallbacks(e, q, places.data());
  Candidate best;
  for (std::size_t i = 0; i < count; ++i) {
    memory.merge.plan(e, a, b, places[i].position);
    const double price = views_->price(e, places[i], memory.merge, *memory.scratch);
    if (price < best.cost) best = {price, places[i].position};
  }
  views_->note(e, best, views_->whole());
}

/// A memory that no other thread uses.
ViewMetric::Memory Engine::take_memory() {
  const std::lock_guard lock(memory_mutex_);
  ViewMetric::Memory memory = std::move(memory_.back());
  memory_.pop_back();
  return memory;
}

void Engine::give_back(ViewMetric::Memory&& memory) {
  const std::lock_guard lock(memory_mutex_);
  memory_.push_back(std::move(memory));
}

/// Prices edges and puts them into the queue, in parallel.
void Engine::price_by_views(std::span<const Due> edges) {
  views_->team().run(edges.size(), [&](std::size_t i) {
    const std::uint32_t e = edges[i].item;
    ViewMetric::Memory memory = take_memory();
    price_by_views(e, cost_.quadric(e), kEnough * std::max(edges[i].cost, level_), memory);
    give_back(std::move(memory));
  });
  for (const Due& due : edges) {
    const double price = views_->noted(due.item).cost;
    if (std::isfinite(price)) queue_.set(due.item, price);
  }
}

/// Room for the steps to the target, if there is one: most take two triangles, and one value of each channel.
void Engine::reserve_record() {
  const std::uint64_t faces = mesh_.live_faces > target_ ? mesh_.live_faces - target_ : 0;
  CollapseRecord& record = outcome_.record;
  if (record.steps.empty()) record.triangles_before = mesh_.live_faces;
  if (target_ == 0) return;
  const std::uint64_t steps = faces / 2 + faces / 32;
  record.removed_faces.reserve(record.removed_faces.size() + faces + 1);
  record.steps.reserve(record.steps.size() + steps);
  std::uint64_t values = 0, floats = 0;
  for (const Channel& channel : state_.channels) {
    const std::uint64_t size = channel.layer_value.size();
    values += size;
    floats += size * static_cast<std::uint64_t>(channel.width);
  }
  record.joins.reserve(values);
  record.writes.reserve(values);
  record.floats.reserve(floats);
}

// --- The loop --------------------------------------------------------------------------------------

StopReason Engine::loop() {
  const std::uint64_t start = mesh_.live_faces;
  std::uint64_t turns = 0;
  const std::uint64_t some = views_ == nullptr ? 1 << 10 : 1 << 4;  // a few milliseconds
  while (mesh_.live_faces > target_) {
    if (++turns % some == 0) {
      const double done =
          static_cast<double>(start - mesh_.live_faces) / static_cast<double>(start - target_);
      if (!context_.advance("collapse", done)) return StopReason::cancelled;
    }
    take_batch();
    if (batch_.empty()) return over_error_ ? StopReason::error : StopReason::stuck;
    drop_dearer();
    fetch_surroundings();
    changed_.clear();
    for (Due& due : batch_) {
      if (mesh_.live_faces <= target_) break;
      if (due.item >= edge_count_) {
        try_vanish(due);
      } else if (mesh_.edge_alive(due.item) && !queue_.contains(due.item)) {
        try_edge(due);
      }
    }
  }
  return StopReason::target;
}

/// Takes the next items out of the queue: those that cost about as much as the first.
void Engine::take_batch() {
  batch_.clear();
  if (views_ != nullptr) {
    take_by_views();
    return;
  }
  while (batch_.size() < kBatch) {
    const std::uint32_t item = queue_.first();
    if (item == kInvalid) break;
    const double cost = queue_.cost_floor(item);
    if (!batch_.empty() && cost > batch_.front().cost * kTolerance) break;
    queue_.remove(item);
    batch_.push_back({item, cost, {}, {}});
    if (item < edge_count_) prefetch(&mesh_.edges[item]);
  }
  for (const Due& due : batch_) {
    if (due.item < edge_count_) cost_.fetch_ends(due.item);
  }
  for (const Due& due : batch_) {
    if (due.item < edge_count_) cost_.fetch_values(due.item);
  }
  for (const Due& due : batch_) {
    if (due.item < edge_count_) cost_.fetch_seams(due.item);
  }
}

/// Takes the cheapest item that has the price it was queued for. Edges are priced when they come up for the
/// first time, and anew when something has changed around them; the next few with them, in parallel.
void Engine::take_by_views() {
  for (;;) {
    const std::uint32_t item = queue_.first();
    if (item == kInvalid) return;
    if (item >= edge_count_ || views_->is_fresh(item)) {
      batch_.push_back({item, queue_.cost_floor(item), {}, {}});
      level_ = batch_.back().cost;
      queue_.remove(item);
      return;
    }
    // What is priced for the first time will be needed; new prices can go out of date before they are.
    const std::size_t most = views_->is_noted(item) ? kTogether : kAhead;
    std::vector<Due> stale;
    std::vector<std::pair<std::uint32_t, double>> others;
    for (std::size_t i = 0; i < kAhead && stale.size() < most; ++i) {
      const std::uint32_t next = queue_.first();
      if (next == kInvalid) break;
      if (next >= edge_count_ || views_->is_fresh(next)) {
        others.emplace_back(next, queue_.cost_floor(next));
      } else {
        stale.push_back({next, queue_.cost_floor(next), {}, {}});
      }
      queue_.remove(next);
    }
    for (const auto& [other, cost] : others) queue_.set(other, cost);
    price_by_views(stale);
  }
}

void Engine::price(Due& due) {
  due.quadric = cost_.quadric(due.item);
  if (views_ == nullptr) {
    due.place = cost_.best_place(due.item, due.quadric);
    return;
  }
  if (!views_->is_fresh(due.item))
    price_by_views(due.item, due.quadric, std::numeric_limits<double>::infinity(), memory_[0]);
  due.place = views_->noted(due.item);
}

/// Puts back the edges of the batch that cost more by now than they were queued for.
void Engine::drop_dearer() {
  std::erase_if(batch_, [&](Due& due) {
    if (due.item >= edge_count_) return false;
    const auto [a, b] = mesh_.edges[due.item].ends;
    price(due);
    const bool dearer = is_dearer(due, due.place.cost);
    if (!dearer) {
      prefetch(mesh_.ring(a).data());
      prefetch(mesh_.ring(b).data());
    }
    return dearer;
  });
}

/// Fetches the triangles around the edges of the batch, then their vertices, all at once.
void Engine::fetch_surroundings() const {
  const auto for_corners = [&](auto&& f) {
    for (const Due& due : batch_) {
      if (due.item >= edge_count_) continue;
      for (const std::uint32_t v : mesh_.edges[due.item].ends) {
        const auto ring = mesh_.ring(v);
        for (const std::uint32_t c : ring.first(std::min<std::size_t>(ring.size(), 12))) f(c);
      }
    }
  };
  for_corners([&](std::uint32_t c) {
    prefetch(&mesh_.faces[c / 3]);
    if (!state_.channels.empty()) prefetch(&state_.channels.front().corner_value[c]);
  });
  // The vertices, edges and values next to each corner: around a vertex that is all of them, once.
  for_corners([&](std::uint32_t c) {
    const CornerView at_c = mesh_.view(c);
    prefetch(&mesh_.vertices[at_c.next]);
    prefetch(&mesh_.edges[at_c.to_next]);
    for (const Channel& channel : state_.channels) {
      if (!channel.is_uv()) continue;
      const std::uint32_t value = channel.corner_value[CollapseMesh::next(c)];
      if (value != kInvalid) prefetch(channel.value(value));
    }
  });
  // What the triangles on the edges leave when they go.
  for (const Due& due : batch_) {
    if (due.item >= edge_count_ || !mesh_.edges[due.item].is_listed()) continue;
    for (const std::uint32_t half_edge : mesh_.edges[due.item].half_edges) {
      if (half_edge == kInvalid) continue;
      prefetch(mesh_.ring(mesh_.vertex(CollapseMesh::previous(half_edge))).data());
      prefetch(&state_.mesh_face[half_edge / 3]);
    }
  }
}

/// Collapses the edge if that is legal at about the cost that it was queued for; else puts it back.
void Engine::try_edge(Due& due) {
  const auto [a, b] = mesh_.edges[due.item].ends;
  if (std::find(changed_.begin(), changed_.end(), a) != changed_.end() ||
      std::find(changed_.begin(), changed_.end(), b) != changed_.end()) {
    price(due);
    if (is_dearer(due, due.place.cost)) return;
  }
  if (!legality_.look_at(a, b) && (legality_.topology() == Block::last || options_.keep_topology)) {
    put_off(due);
    return;
  }
  if (is_legal(due.item, due.place.position)) {
    take_or_requeue(due, due.place);
    return;
  }
  std::array<Candidate, 3> places;
  const std::size_t count = cost_.fallbacks(due.item, due.quadric, places.data());
  for (std::size_t i = 0; i < count; ++i) {
    if (!is_legal(due.item, places[i].position)) continue;
    if (views_ != nullptr) places[i].cost = views_->price(due.item, places[i], merge_, *memory_[0].scratch);
    take_or_requeue(due, places[i]);
    return;
  }
  put_off(due);
}

/// Whether the edge, which `legality_` looks at, may collapse to p.
bool Engine::is_legal(std::uint32_t e, Vec3d p) {
  if (!legality_.shape(p)) return false;
  const auto [a, b] = mesh_.edges[e].ends;
  merge_.plan(e, a, b, p);
  return legality_.texture(merge_);
}

/// Whether the edge costs more than it was queued for; then it goes back into the queue at its price,
/// if there is one.
bool Engine::is_dearer(const Due& due, double price) {
  if (price <= due.cost * kTolerance + std::numeric_limits<float>::min()) return false;
  if (std::isfinite(price)) queue_.set(due.item, price);
  return true;
}

/// A collapse that is legal is carried out if it costs about what it was queued for.
void Engine::take_or_requeue(const Due& due, const Candidate& where) {
  const bool ruins = legality_.topology() != Block::none || legality_.leaves_scrap();
  if (is_dearer(due, where.cost * (ruins ? kRuinPenalty : 1))) return;
  const double squared = views_ != nullptr ? std::max(due.quadric.value(where.position), 0.0) : where.cost;
  const double error = std::sqrt(squared / std::max(due.quadric.weight, 1e-30));
  if (error > max_error_) {
    over_error_ = true;
    return;
  }
  const std::uint32_t b = stepper_.collapse(due.item, where.position, error);
  revive_edges(b);
  changed_.push_back(b);
}

void Engine::put_off(const Due& due) {
  for (const std::uint32_t v : mesh_.edges[due.item].ends) mesh_.vertices[v].refused = 1;
  if (++tries_[due.item] <= kMaxRetries) queue_.set(due.item, std::max(due.cost, 1e-20) * kRetryFactor);
}

void Engine::try_vanish(const Due& due) {
  const std::uint32_t component = due.item - edge_count_;
  find_living(component);
  if (ring_.empty() || ring_.size() == mesh_.live_faces) return;
  for (const std::uint32_t f : ring_) {
    for (const std::uint32_t v : mesh_.faces[f].vertex) {
      if (mesh_.vertices[v].locked) return;
    }
  }
  if (views_ != nullptr && is_dearer(due, vanish_price(component))) return;
  if (state_.vanish[component].error > max_error_) {
    over_error_ = true;
    return;
  }
  stepper_.vanish(ring_, state_.vanish[component].error);
}

/// Gives edges at b that were refused another chance, at their present cost. The others keep the cost
/// that they have in the queue: a merged vertex adds to it, so it is a lower bound, and `try_edge`
/// looks again when it comes up.
void Engine::revive_edges(std::uint32_t b) {
  if (!mesh_.vertices[b].refused) return;
  mesh_.vertices[b].refused = 0;
  const auto revive = [&](std::uint32_t e) {
    if (tries_[e] == 0) return;
    tries_[e] = 0;
    if (views_ != nullptr) {
      const Due due{e, 0, {}, {}};
      price_by_views({&due, 1});
      return;
    }
    const double cost = cost_.best_place(e, cost_.quadric(e)).cost;
    if (std::isfinite(cost)) queue_.set(e, cost);
  };
  mesh_.for_ring(b, [&](std::uint32_t c) {
    const CornerView at_c = mesh_.view(c);
    revive(at_c.to_next);
    revive(at_c.to_previous);
  });
}

void Engine::count_blocked() {
  for (std::uint32_t e = 0; e < edge_count_; ++e) {
    if (!mesh_.edge_alive(e)) continue;
    ++outcome_.blocked.edges;
    const auto [a, b] = mesh_.edges[e].ends;
    if (mesh_.vertices[a].locked && mesh_.vertices[b].locked) {
      ++outcome_.blocked.locked;
    } else if (!legality_.look_at(a, b)) {
      ++(legality_.topology() == Block::last ? outcome_.blocked.last : outcome_.blocked.topology);
    } else {
      ++outcome_.blocked.flip;
    }
  }
}

}  // namespace

void collapse(CollapseState& state, std::uint64_t target_triangles, double max_error,
              const SimplifyOptions& options, ViewMetric* views, Context& context, CollapseOutcome& outcome) {
  Engine(state, target_triangles, max_error, options, views, context, outcome).run();
}

}  // namespace fovea
