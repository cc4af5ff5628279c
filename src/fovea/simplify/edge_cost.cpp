#include "fovea/simplify/edge_cost.h"

#include <algorithm>
#include <array>
#include <type_traits>

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
    : state_(state), mesh_(state.mesh), placement_(placement) {
  std::size_t count = 0;
  for (std::uint32_t v = 0; v < mesh_.vertices.size(); ++v) {
    count += std::any_of(state.channels.begin(), state.channels.end(), [&](const Channel& channel) {
      return channel.kind == ChannelKind::fitted && channel.single[v] == Channel::kMany;
    });
  }
  seam_.reserve(count * state.channels.size());
  if (count == 0) return;
  for (std::uint32_t v = 0; v < mesh_.vertices.size(); ++v) refresh(v);
}

void EdgeCost::refresh(std::uint32_t v) {
  forget(v);
  for (std::size_t i = 0; i < state_.channels.size(); ++i) {
    const Channel& channel = state_.channels[i];
    if (channel.kind != ChannelKind::fitted || channel.single[v] != Channel::kMany) continue;
    if (!has_many(v)) take_slot(v);
    seam_values(v, i) = look_at_values(channel, v);
  }
}

void EdgeCost::forget(std::uint32_t v) {
  if (!has_many(v)) return;
  for (std::size_t i = 0; i < state_.channels.size(); ++i) {
    SeamValues& values = seam_values(v, i);
    if (!values.is_listed()) free_sums_.push_back(values.value[0]);
    values.count = 0;
  }
  free_slots_.push_back(slot_[v]);
  slot_[v] = kInvalid;
}

void EdgeCost::take_slot(std::uint32_t v) {
  if (slot_.empty()) slot_.assign(mesh_.vertices.size(), kInvalid);
  if (free_slots_.empty()) {
    free_slots_.push_back(static_cast<std::uint32_t>(seam_.size() / state_.channels.size()));
    seam_.resize(seam_.size() + state_.channels.size());
  }
  slot_[v] = free_slots_.back();
  free_slots_.pop_back();
}

/// The different values at v, which are several, or their sum.
EdgeCost::SeamValues EdgeCost::look_at_values(const Channel& channel, std::uint32_t v) {
  SeamValues found;
  for (const std::uint32_t c : mesh_.ring(v)) {
    const std::uint32_t value = channel.corner_value[c];
    const auto list = found.list();
    if (value == kInvalid || std::find(list.begin(), list.end(), value) != list.end()) continue;
    if (found.count == SeamValues::kMost) {
      found.value[0] = sum_values(channel, v);
      found.count = SeamValues::kMost + 1;
      break;
    }
    found.value[found.count++] = value;
  }
  return found;
}

/// Index of a new sum of what all values at v make up for by themselves.
std::uint32_t EdgeCost::sum_values(const Channel& channel, std::uint32_t v) {
  values_.clear();
  for (const std::uint32_t c : mesh_.ring(v)) {
    if (channel.corner_value[c] != kInvalid) values_.push_back(channel.corner_value[c]);
  }
  std::sort(values_.begin(), values_.end());
  values_.erase(std::unique(values_.begin(), values_.end()), values_.end());
  Quadric sum;
  for (const std::uint32_t value : values_)
    settle_alone(sum, channel, channel.fit_width, value, state_.slot_of_vertex(v));
  if (free_sums_.empty()) {
    free_sums_.push_back(static_cast<std::uint32_t>(sums_.size()));
    sums_.emplace_back();
  }
  const std::uint32_t index = free_sums_.back();
  free_sums_.pop_back();
  sums_[index] = sum;
  return index;
}

Quadric EdgeCost::separate(const Channel& channel, std::uint32_t v, std::uint32_t value) const {
  Quadric q;
  settle_alone(q, channel, channel.fit_width, value, state_.slot_of_vertex(v));
  return q;
}

/// Adds what those values at v make up for by themselves that no triangle on the edge uses.
template <int Width>
void EdgeCost::settle_rest(Quadric& q, std::size_t channel_index, std::uint32_t v, const JoinedValues& joined,
                           bool is_b) const {
  const Channel& channel = state_.channels[channel_index];
  const auto alone = [&](std::uint32_t value, double times = 1) {
    settle_alone(q, channel, Width > 0 ? Width : channel.fit_width, value, state_.slot_of_vertex(v), times);
  };
  const std::uint32_t single = channel.single[v];
  if (single != Channel::kMany) {
    if (single != kInvalid && joined.count_at(is_b) == 0) alone(single);
    return;
  }
  const SeamValues& values = seam_values(v, channel_index);
  if (values.is_listed()) {
    if (joined.count_at(is_b) == values.count) return;
    for (const std::uint32_t value : values.list()) {
      if (!joined.contains(value)) alone(value);
    }
    return;
  }
  q += sums_[values.value[0]];
  for (std::uint32_t k = 0; k < joined.size(); ++k) {
    if (joined[k].at_b == is_b) alone(joined[k].value, -1);
  }
}

/// For a channel with several values at an end: those that join on the edge are settled together.
template <int Width>
void EdgeCost::settle_joined(Quadric& q, std::size_t channel_index, std::uint32_t a, std::uint32_t b,
                             const EdgeCorners& corners) const {
  const Channel& channel = state_.channels[channel_index];
  const int width = Width > 0 ? Width : channel.fit_width;
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
    }
    const std::uint32_t held = channel.is_uv() ? ends.held_value(many_a, many_b) : kInvalid;
    if (held == kInvalid) {
      reduce(q, sum.get(), width);
    } else {
      hold_at(q, channel, sum.get(), held, state_.slot_of_vertex(a));
    }
  }
  settle_rest<Width>(q, channel_index, a, joined, false);
  settle_rest<Width>(q, channel_index, b, joined, true);
}

/// Adds what the values of one channel make up for.
template <int Width>
void EdgeCost::settle(Quadric& q, std::size_t channel_index, std::uint32_t a, std::uint32_t b,
                      const EdgeCorners& corners) const {
  const Channel& channel = state_.channels[channel_index];
  const std::uint32_t single_a = channel.single[a], single_b = channel.single[b];
  if (single_a == Channel::kMany || single_b == Channel::kMany) {
    settle_joined<Width>(q, channel_index, a, b, corners);
    return;
  }
  const int width = Width > 0 ? Width : channel.fit_width;
  AttributeSum<Width> sum(width);
  for (const std::uint32_t single : {single_a, single_b}) {
    if (single != kInvalid) sum.add(channel.value_quadric(single));
  }
  if (sum.get() != nullptr) reduce(q, sum.get(), width);
}

Quadric EdgeCost::quadric(std::uint32_t e) const {
  const auto [a, b] = mesh_.edges[e].ends;
  Quadric q = mesh_.quadric(a) + mesh_.quadric(b);
  EdgeCorners corners;
  if (state_.channels.empty()) return q;
  if (has_many(a) || has_many(b)) corners = mesh_.edge_corners(e, a);
  for (std::size_t i = 0; i < state_.channels.size(); ++i) {
    const Channel& channel = state_.channels[i];
    if (channel.kind != ChannelKind::fitted) continue;
    switch (channel.fit_width) {
      case 2: settle<2>(q, i, a, b, corners); break;
      case 3: settle<3>(q, i, a, b, corners); break;
      case 4: settle<4>(q, i, a, b, corners); break;
      default: settle<0>(q, i, a, b, corners);
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
    if (state_.channels.empty()) continue;
    fetch_slot(v);
    prefetch(&state_.channels.front().single[v]);
  }
}

void EdgeCost::fetch_values(std::uint32_t e) const {
  if (state_.channels.empty()) return;
  const CollapseEdge& edge = mesh_.edges[e];
  bool at_seam = false;
  for (const std::uint32_t v : edge.ends) {
    for (const Channel& channel : state_.channels) {
      if (channel.kind == ChannelKind::fitted && channel.single[v] < Channel::kMany)
        fetch_value(channel, channel.single[v]);
    }
    if (!has_many(v)) continue;
    at_seam = true;
    prefetch(&seam_values(v, 0));
  }
  if (!at_seam || !edge.is_listed()) return;
  for (const std::uint32_t half_edge : edge.half_edges) {
    if (half_edge == kInvalid) continue;
    prefetch(&mesh_.faces[half_edge / 3]);
    prefetch(&state_.channels.front().corner_value[half_edge]);
  }
}

void EdgeCost::fetch_seams(std::uint32_t e) const {
  if (state_.channels.empty()) return;
  for (const std::uint32_t v : mesh_.edges[e].ends) {
    if (!has_many(v)) continue;
    for (std::size_t i = 0; i < state_.channels.size(); ++i) {
      const SeamValues& values = seam_values(v, i);
      if (!values.is_listed()) continue;
      for (const std::uint32_t value : values.list()) {
        fetch_value(state_.channels[i], value);
        if (state_.channels[i].is_uv()) prefetch(state_.channels[i].value(value));  // it may be held
      }
    }
  }
}

void EdgeCost::fetch_value(const Channel& channel, std::uint32_t value) const {
  const float* const quadric = channel.value_quadric(value);
  prefetch(quadric);
  prefetch(quadric + channel.stride - 1);
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
