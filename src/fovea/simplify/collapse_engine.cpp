#include "fovea/simplify/collapse_engine.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
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
#include "fovea/simplify/view_pricer.h"

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
/// So many items are taken from the queue between two stages of one, while its memory is fetched.
constexpr std::size_t kSpacing = 4;
/// Room for all items between the queue and their collapse.
constexpr std::size_t kLine = 64;
/// Views are asked until an edge costs so many times what it was queued for, and what was last taken.
constexpr double kEnough = 1.3;

/// An edge or component that was taken out of the queue.
struct Due {
  std::uint32_t item = kInvalid;
  double cost = 0;  ///< What it was queued for.
  // Of an edge, when it was priced last:
  Quadric quadric = {};
  Candidate place = {};
  std::size_t merges = 0;  ///< How many there had been.
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
    if (views_ != nullptr) pricer_.emplace(*views_, state, cost_, options.placement, context.thread_count());
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
  bool advance();
  void take_next(Due& due);
  bool is_edge(const Due& due) const { return due.item < edge_count_; }
  void fetch_rings(const Due& due) const;
  void fetch_faces(const Due& due) const;
  void fetch_neighbors(const Due& due) const;
  void fetch_leftovers(const Due& due) const;
  void price(Due& due);
  void price_in_line(Due& due);
  void take(Due& due);
  bool has_changed(const Due& due, std::uint32_t v) const;
  void price_by_views(std::span<const EdgeLimit> edges);
  double enough(double cost) const { return kEnough * std::max(cost, level_); }
  bool take_by_views();
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
  std::optional<ViewPricer> pricer_;  // with views
  Legality legality_;
  ValueMerge merge_;
  std::array<Due, kLine> line_;  // what was taken from the queue at each of the last ticks
  std::size_t tick_ = 0, oldest_ = 1;
  std::array<std::uint32_t, kLine> merged_;  // the last vertices that were left by a collapse
  std::size_t merges_ = 0;
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
      queue_.set(first + i, views_ == nullptr ? quadric_cost : views_->least_price(quadric_cost));
    }
  }
}

/// The price of losing what is left of a component.
double Engine::vanish_price(std::uint32_t component) {
  const double cost = state_.vanish[component].cost;
  if (views_ == nullptr) return cost;
  find_living(component);
  return views_->price_of_loss(ring_, cost, pricer_->scratch());
}

/// Lists the faces of a component that are left, in `ring_`.
void Engine::find_living(std::uint32_t component) {
  const FaceComponents& all = state_.components;
  ring_.clear();
  for (std::uint32_t k = all.first[component]; k < all.first[component + 1]; ++k) {
    if (mesh_.face_alive(all.faces[k])) ring_.push_back(all.faces[k]);
  }
}

/// Prices edges by views, in parallel, and puts them into the queue.
void Engine::price_by_views(std::span<const EdgeLimit> edges) {
  pricer_->price(edges);
  for (const auto& [edge, limit] : edges) {
    const double price = views_->noted(edge).cost;
    if (std::isfinite(price)) queue_.set(edge, price);
  }
}

/// Room for the steps to the target, if there is one: most take a vertex with its share of the triangles, and
/// one value of each channel.
void Engine::reserve_record() {
  const std::uint64_t faces = mesh_.live_faces > target_ ? mesh_.live_faces - target_ : 0;
  CollapseRecord& record = outcome_.record;
  if (record.steps.empty()) record.triangles_before = mesh_.live_faces;
  if (target_ == 0 || faces == 0) return;
  // Some more, as a value can be set again and again.
  const double share = 1.125 * static_cast<double>(faces) / static_cast<double>(mesh_.faces.size());
  const auto part = [&](std::size_t all) {
    return static_cast<std::size_t>(share * static_cast<double>(all));
  };
  std::size_t values = 0, floats = 0;
  for (const Channel& channel : state_.channels) {
    const std::size_t size = channel.layer_value.size();
    values += size;
    floats += size * static_cast<std::size_t>(channel.width);
  }
  record.removed_faces.reserve(record.removed_faces.size() + faces + 1);
  record.steps.reserve(record.steps.size() + part(mesh_.vertices.size()));
  record.joins.reserve(record.joins.size() + part(values));
  record.writes.reserve(record.writes.size() + part(values));
  record.floats.reserve(record.floats.size() + part(floats));
}

// --- The loop --------------------------------------------------------------------------------------

StopReason Engine::loop() {
  const std::uint64_t start = mesh_.live_faces;
  std::uint64_t turns = 0;
  const std::uint64_t some = views_ == nullptr ? 1 << 14 : 1 << 4;  // a few milliseconds
  while (mesh_.live_faces > target_) {
    if (++turns % some == 0) {
      const double done =
          static_cast<double>(start - mesh_.live_faces) / static_cast<double>(start - target_);
      if (!context_.advance("collapse", done)) return StopReason::cancelled;
    }
    if (!(views_ == nullptr ? advance() : take_by_views()))
      return over_error_ ? StopReason::error : StopReason::stuck;
  }
  return StopReason::target;
}

/// Takes the next item from the queue, and those before it each one stage further. Every stage asks for the
/// memory that the next one reads, which arrives while others have their turn. Returns false when nothing is
/// left.
bool Engine::advance() {
  ++tick_;
  take_next(line_[tick_ % kLine]);
  std::size_t stage = 0;
  const auto next = [&](auto&& f) {
    ++stage;
    if (tick_ <= stage * kSpacing) return;
    Due& due = line_[(tick_ - stage * kSpacing) % kLine];
    if (due.item != kInvalid) f(due);
  };
  const auto next_of_edge = [&](auto&& f) {
    next([&](Due& due) {
      if (is_edge(due)) f(due);
    });
  };
  next_of_edge([&](const Due& due) { cost_.fetch_ends(due.item); });
  if (!state_.channels.empty()) {
    next_of_edge([&](const Due& due) { cost_.fetch_values(due.item); });
    next_of_edge([&](const Due& due) { cost_.fetch_seams(due.item); });
  }
  next_of_edge([&](Due& due) { price_in_line(due); });
  next_of_edge([&](const Due& due) { fetch_faces(due); });
  next_of_edge([&](const Due& due) { fetch_neighbors(due); });
  next_of_edge([&](const Due& due) { fetch_leftovers(due); });
  next([&](Due& due) { take(due); });
  static_assert(8 * kSpacing < kLine);
  return oldest_ <= tick_;
}

/// The next item if it costs about as much as the oldest in line.
void Engine::take_next(Due& due) {
  due.item = kInvalid;
  while (oldest_ < tick_ && line_[oldest_ % kLine].item == kInvalid) ++oldest_;
  const std::uint32_t item = queue_.first();
  if (item == kInvalid) {
    if (oldest_ == tick_) ++oldest_;
    return;
  }
  const double cost = queue_.cost_floor(item);
  if (oldest_ < tick_ && cost > line_[oldest_ % kLine].cost * kTolerance) return;
  queue_.remove(item);
  due.item = item;
  due.cost = cost;
  if (is_edge(due)) prefetch(&mesh_.edges[item]);
}

/// Takes the cheapest item that has the price it was queued for. Edges are priced when they come up for the
/// first time, and anew when something has changed around them; the next few with them, in parallel. Returns
/// false when nothing is left.
bool Engine::take_by_views() {
  for (;;) {
    const std::uint32_t item = queue_.first();
    if (item == kInvalid) return false;
    if (item >= edge_count_ || views_->is_fresh(item)) {
      Due due{.item = item, .cost = queue_.cost_floor(item)};
      level_ = due.cost;
      queue_.remove(item);
      if (is_edge(due)) {
        price(due);
        if (is_dearer(due, due.place.cost)) return true;
      }
      take(due);
      return true;
    }
    // What is priced for the first time will be needed; new prices can go out of date before they are.
    const std::size_t most = views_->is_noted(item) ? kTogether : kAhead;
    std::vector<EdgeLimit> stale;
    std::vector<std::pair<std::uint32_t, double>> others;
    for (std::size_t i = 0; i < kAhead && stale.size() < most; ++i) {
      const std::uint32_t next = queue_.first();
      if (next == kInvalid) break;
      if (next >= edge_count_ || views_->is_fresh(next)) {
        others.emplace_back(next, queue_.cost_floor(next));
      } else {
        stale.push_back({next, enough(queue_.cost_floor(next))});
      }
      queue_.remove(next);
    }
    for (const auto& [other, cost] : others) queue_.set(other, cost);
    price_by_views(stale);
  }
}

void Engine::price(Due& due) {
  due.merges = merges_;
  due.quadric = cost_.quadric(due.item);
  if (views_ == nullptr) {
    due.place = cost_.best_place(due.item, due.quadric);
    return;
  }
  if (!views_->is_fresh(due.item)) pricer_->price(due.item, due.quadric);
  due.place = views_->noted(due.item);
}

/// Prices an edge; puts it back if it costs more by now than it was queued for.
void Engine::price_in_line(Due& due) {
  if (!mesh_.edge_alive(due.item) || queue_.contains(due.item)) {
    due.item = kInvalid;
    return;
  }
  price(due);
  if (is_dearer(due, due.place.cost)) {
    due.item = kInvalid;
  } else {
    fetch_rings(due);
  }
}

void Engine::fetch_rings(const Due& due) const {
  for (const std::uint32_t v : mesh_.edges[due.item].ends) prefetch(mesh_.ring(v).data());
}

/// Calls f(corner) for the corners at the ends of edge e, or some if they are many.
template <class F>
void for_corners(const CollapseMesh& mesh, std::uint32_t e, F&& f) {
  for (const std::uint32_t v : mesh.edges[e].ends) {
    const auto ring = mesh.ring(v);
    for (const std::uint32_t c : ring.first(std::min<std::size_t>(ring.size(), 12))) f(c);
  }
}

void Engine::fetch_faces(const Due& due) const {
  for_corners(mesh_, due.item, [&](std::uint32_t c) {
    prefetch(&mesh_.faces[c / 3]);
    if (!state_.channels.empty()) prefetch(&state_.channels.front().corner_value[c]);
  });
}

/// The vertices, edges and values next to each corner: around a vertex that is all of them, once.
void Engine::fetch_neighbors(const Due& due) const {
  for_corners(mesh_, due.item, [&](std::uint32_t c) {
    const CornerView at_c = mesh_.view(c);
    prefetch(&mesh_.vertices[at_c.next]);
    prefetch(&mesh_.edges[at_c.to_next]);
    for (const Channel& channel : state_.channels) {
      if (!channel.is_uv()) continue;
      const std::uint32_t value = channel.corner_value[CollapseMesh::next(c)];
      if (value != kInvalid) prefetch(channel.value(value));
    }
  });
}

/// What its vertices and the triangles on the edge leave when they go.
void Engine::fetch_leftovers(const Due& due) const {
  for (const std::uint32_t v : mesh_.edges[due.item].ends) {
    prefetch(&state_.mesh_vertex[v]);
    for (const Channel& channel : state_.channels) {
      const std::uint32_t value = channel.single[v];
      if (value >= Channel::kMany) continue;
      prefetch(channel.value(value));
      prefetch(&channel.layer_value[value]);
    }
  }
  if (!mesh_.edges[due.item].is_listed()) return;
  for (const std::uint32_t half_edge : mesh_.edges[due.item].half_edges) {
    if (half_edge == kInvalid) continue;
    const std::uint32_t across = mesh_.vertex(CollapseMesh::previous(half_edge));
    prefetch(mesh_.ring(across).data());
    cost_.fetch_slot(across);
    prefetch(&state_.mesh_face[half_edge / 3]);
  }
}

/// Carries out what is due, if it is still there and that is legal.
void Engine::take(Due& due) {
  if (!is_edge(due)) {
    try_vanish(due);
  } else if (mesh_.edge_alive(due.item) && !queue_.contains(due.item)) {
    try_edge(due);
  }
  due.item = kInvalid;
}

/// Whether v was left by a collapse since the edge was priced.
bool Engine::has_changed(const Due& due, std::uint32_t v) const {
  for (std::size_t i = due.merges; i < merges_; ++i) {
    if (merged_[i % kLine] == v) return true;
  }
  return false;
}

/// Collapses the edge if that is legal at about the cost that it was queued for; else puts it back.
void Engine::try_edge(Due& due) {
  const auto [a, b] = mesh_.edges[due.item].ends;
  if (has_changed(due, a) || has_changed(due, b)) {
    price(due);
    if (is_dearer(due, due.place.cost)) return;
  }
  if (!legality_.look_at(a, b) && (legality_.topology() == Block::last || options_.keep_topology)) {
    put_off(due);
    return;
  }
  if (legality_.loses_locked() || (options_.keep_topology && legality_.cuts_strap())) {
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
    if (views_ != nullptr) places[i].cost = views_->price(due.item, places[i], merge_, pricer_->scratch());
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
  merged_[merges_++ % kLine] = b;
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
      const EdgeLimit edge{e, enough(0)};
      price_by_views({&edge, 1});
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
    } else if (legality_.loses_locked()) {
      ++outcome_.blocked.locked;
    } else if (options_.keep_topology && legality_.cuts_strap()) {
      ++outcome_.blocked.topology;
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
