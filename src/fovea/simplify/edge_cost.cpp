#include "fovea/simplify/edge_cost.h"

#include <algorithm>
#include <array>
#include <type_traits>

#include "fovea/base/prefetch.h"
#include "fovea/simplify/value_classes.h"

namespace fovea {

namespace {

/// Optimal positions further from the edge than this many edge lengths are not believed.
constexpr double kReach = 2;

/// The sum of attribute quadrics of one channel. `Width` is what fits the channel, or 0 for any.
template <int Width>
class AttributeSum {
 public:
  explicit AttributeSum(int width) : stride_(attribute_stride(width)) {}
  void add(const float* q) {
    const std::size_t stride = Width > 0 ? attribute_stride(Width) : stride_;
    if (sum_ == nullptr) {
      sum_ = q;  // most often nothing else comes, or one more
      return;
    }
    if constexpr (Width == 0) total_.resize(stride);
    for (std::size_t i = 0; i < stride; ++i) total_[i] = sum_[i] + q[i];
    sum_ = total_.data();
  }
  const float* get() const { return sum_; }

 private:
  std::size_t stride_;
  const float* sum_ = nullptr;
  std::conditional_t<Width == 0, std::vector<float>, std::array<float, attribute_stride(Width)>> total_;
};

/// Adds the error of an attribute quadric whose texture coordinates stay those of `value`.
void hold_at(Quadric& q, const Channel& channel, const float* attribute, std::uint32_t value,
             std::uint32_t mesh, double times = 1) {
  const double scale = channel.scale[mesh];
  const float* numbers = channel.value(value);
  const double scaled[2] = {scale * numbers[0], scale * numbers[1]};
  hold(q, attribute, 2, scaled, times);
}

/// Adds what a value makes up for by itself: texture coordinates at a seam stay as they are, everything else
/// becomes the best for the position. With `times` −1 it takes that back.
void settle_alone(Quadric& q, const Channel& channel, int width, std::uint32_t value, std::uint32_t mesh,
                  double times = 1) {
  const float* const attribute = channel.value_quadric(value);
  if (channel.is_uv()) {
    hold_at(q, channel, attribute, value, mesh, times);
  } else {
    reduce(q, attribute, width, times);
  }
}

}  // namespace

EdgeCost::EdgeCost(const CollapseState& state, Placement placement)
    : state_(state), mesh_(state.mesh), placement_(placement), slot_(mesh_.vertices.size(), kInvalid) {
  std::size_t count = 0;
  for (std::uint32_t v = 0; v < slot_.size(); ++v) {
    count += std::any_of(state.channels.begin(), state.channels.end(), [&](const Channel& channel) {
      return channel.kind == ChannelKind::fitted && channel.single[v] == Channel::kMany;
    });
  }
  separate_.reserve(count);
  for (std::uint32_t v = 0; v < slot_.size(); ++v) refresh(v);
}

void EdgeCost::refresh(std::uint32_t v) {
  Quadric sum;
  bool many = false;
  for (const Channel& channel : state_.channels) {
    if (channel.kind != ChannelKind::fitted || channel.single[v] != Channel::kMany) continue;
    many = true;
    values_.clear();
    for (const std::uint32_t c : mesh_.ring(v)) {
      if (channel.corner_value[c] != kInvalid) values_.push_back(channel.corner_value[c]);
    }
    std::sort(values_.begin(), values_.end());
    values_.erase(std::unique(values_.begin(), values_.end()), values_.end());
    for (const std::uint32_t value : values_)
      settle_alone(sum, channel, channel.fit_width, value, state_.slot_of_vertex(v));
  }
  if (!many) {
    forget(v);
    return;
  }
  if (slot_[v] == kInvalid) {
    if (free_slots_.empty()) {
      free_slots_.push_back(static_cast<std::uint32_t>(separate_.size()));
      separate_.emplace_back();
    }
    slot_[v] = free_slots_.back();
    free_slots_.pop_back();
  }
  separate_[slot_[v]] = sum;
}

void EdgeCost::forget(std::uint32_t v) {
  if (slot_[v] != kInvalid) free_slots_.push_back(slot_[v]);
  slot_[v] = kInvalid;
}

Quadric EdgeCost::separate(const Channel& channel, std::uint32_t v, std::uint32_t value) const {
  Quadric q;
  settle_alone(q, channel, channel.fit_width, value, state_.slot_of_vertex(v));
  return q;
}

/// For a channel with several values at an end: those that join on the edge are settled together instead
/// of by themselves.
template <int Width>
void EdgeCost::settle_joined(Quadric& q, const Channel& channel, std::uint32_t a, std::uint32_t b,
                             const EdgeCorners& corners) const {
  const int width = Width > 0 ? Width : channel.fit_width;
  const std::uint32_t mesh = state_.slot_of_vertex(a);
  const bool many_a = channel.single[a] == Channel::kMany, many_b = channel.single[b] == Channel::kMany;
  const JoinedValues joined(channel, corners);
  for (std::uint32_t root = 0; root < joined.size(); ++root) {
    if (joined[root].root != root) continue;
    AttributeSum<Width> sum(width);
    ClassEnds ends;
    for (std::uint32_t k = root; k < joined.size(); ++k) {
      const JoinedValues::Member& member = joined[k];
      if (member.root != root) continue;
      sum.add(channel.value_quadric(member.value));
      ends.add(member.value, member.at_b);
      if (member.at_b ? many_b : many_a) settle_alone(q, channel, width, member.value, mesh, -1);
    }
    const std::uint32_t held = channel.is_uv() ? ends.held_value(many_a, many_b) : kInvalid;
    if (held == kInvalid) {
      reduce(q, sum.get(), width);
    } else {
      hold_at(q, channel, sum.get(), held, mesh);
    }
  }
  // An end's only value that no triangle on the edge uses.
  for (const std::uint32_t v : {a, b}) {
    const std::uint32_t single = channel.single[v];
    if (single < Channel::kMany && !joined.contains(single)) settle_alone(q, channel, width, single, mesh);
  }
}

/// Adds what the values of one channel make up for, beyond those in `separate_`.
template <int Width>
void EdgeCost::settle(Quadric& q, const Channel& channel, std::uint32_t a, std::uint32_t b,
                      const EdgeCorners& corners) const {
  const int width = Width > 0 ? Width : channel.fit_width;
  const std::uint32_t single_a = channel.single[a], single_b = channel.single[b];
  if (single_a == Channel::kMany || single_b == Channel::kMany) {
    settle_joined<Width>(q, channel, a, b, corners);
    return;
  }
  AttributeSum<Width> sum(width);
  for (const std::uint32_t single : {single_a, single_b}) {
    if (single != kInvalid) sum.add(channel.value_quadric(single));
  }
  if (sum.get() != nullptr) reduce(q, sum.get(), width);
}

Quadric EdgeCost::quadric(std::uint32_t e) const {
  const auto [a, b] = mesh_.edges[e].ends;
  Quadric q = mesh_.quadrics[a] + mesh_.quadrics[b];
  EdgeCorners corners;
  const std::uint32_t slot_a = slot_[a], slot_b = slot_[b];
  if (slot_a != kInvalid || slot_b != kInvalid) {
    corners = mesh_.edge_corners(e, a);
    if (slot_a != kInvalid) q += separate_[slot_a];
    if (slot_b != kInvalid) q += separate_[slot_b];
  }
  for (const Channel& channel : state_.channels) {
    if (channel.kind != ChannelKind::fitted) continue;
    switch (channel.fit_width) {
      case 2: settle<2>(q, channel, a, b, corners); break;
      case 3: settle<3>(q, channel, a, b, corners); break;
      case 4: settle<4>(q, channel, a, b, corners); break;
      default: settle<0>(q, channel, a, b, corners);
    }
  }
  return q;
}

std::size_t EdgeCost::fallbacks(std::uint32_t e, const Quadric& q, Candidate* out) const {
  const auto [a, b] = mesh_.edges[e].ends;
  const Vec3d pa = mesh_.position(a), pb = mesh_.position(b);
  std::size_t count = 0;
  const auto add = [&](Vec3d p) {
    Candidate c{std::max(q.value(p), 0.0), p};
    std::size_t at = count++;
    for (; at > 0 && out[at - 1].cost > c.cost; --at) out[at] = out[at - 1];
    out[at] = c;
  };
  if (!mesh_.vertices[a].locked) add(pb);
  if (!mesh_.vertices[b].locked) add(pa);
  if (count == 2 && placement_ == Placement::optimal) add((pa + pb) * 0.5);
  return count;
}

void EdgeCost::fetch_ends(std::uint32_t e) const {
  for (const std::uint32_t v : mesh_.edges[e].ends) {
    prefetch(&mesh_.vertices[v]);
    prefetch(&mesh_.quadrics[v]);
    prefetch(&mesh_.quadrics[v].weight);
    prefetch(&slot_[v]);
    if (!state_.channels.empty()) prefetch(&state_.channels.front().single[v]);
  }
}

void EdgeCost::fetch_values(std::uint32_t e) const {
  const CollapseEdge& edge = mesh_.edges[e];
  bool at_seam = false;
  for (const std::uint32_t v : edge.ends) {
    for (const Channel& channel : state_.channels) {
      if (channel.kind == ChannelKind::fitted && channel.single[v] < Channel::kMany)
        fetch_value(channel, channel.single[v]);
    }
    if (slot_[v] == kInvalid) continue;
    at_seam = true;
    prefetch(&separate_[slot_[v]]);
    prefetch(&separate_[slot_[v]].weight);
  }
  if (!at_seam || !edge.is_listed()) return;
  for (const std::uint32_t half_edge : edge.half_edges) {
    if (half_edge == kInvalid) continue;
    prefetch(&mesh_.faces[half_edge / 3]);
    prefetch(&state_.channels.front().corner_value[half_edge]);
  }
}

void EdgeCost::fetch_joined(std::uint32_t e) const {
  const CollapseEdge& edge = mesh_.edges[e];
  const auto [a, b] = edge.ends;
  if ((slot_[a] == kInvalid && slot_[b] == kInvalid) || !edge.is_listed()) return;
  for (const std::uint32_t half_edge : edge.half_edges) {
    if (half_edge == kInvalid) continue;
    for (const Channel& channel : state_.channels) {
      if (channel.kind != ChannelKind::fitted) continue;
      for (const std::uint32_t c : {half_edge, CollapseMesh::next(half_edge)}) {
        if (channel.corner_value[c] != kInvalid) fetch_value(channel, channel.corner_value[c]);
      }
    }
  }
}

void EdgeCost::fetch_value(const Channel& channel, std::uint32_t value) const {
  const float* const quadric = channel.value_quadric(value);
  prefetch(quadric);
  prefetch(quadric + attribute_stride(channel.fit_width) - 1);
}

Candidate EdgeCost::best_place(std::uint32_t e, const Quadric& q) const {
  const auto [a, b] = mesh_.edges[e].ends;
  if (placement_ == Placement::optimal && !mesh_.vertices[a].locked && !mesh_.vertices[b].locked) {
    const Vec3d pa = mesh_.position(a), pb = mesh_.position(b);
    Candidate best;
    if (q.minimum(best.position) &&
        length_squared(best.position - (pa + pb) * 0.5) <= kReach * kReach * length_squared(pb - pa)) {
      best.cost = std::max(q.value_at_minimum(best.position), 0.0);
      return best;
    }
  }
  std::array<Candidate, 3> all;
  return fallbacks(e, q, all.data()) > 0 ? all[0] : Candidate{};
}

}  // namespace fovea
