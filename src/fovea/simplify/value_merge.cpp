#include "fovea/simplify/value_merge.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace fovea {

namespace {

/// Sets a unit vector: that of `direction`, or the first three of `instead` where opposing ones have
/// cancelled.
void set_direction(Vec3d direction, const float* instead, float* out) {
  constexpr double kCancelled = 1e-3;
  const Vec3f unit(normalized(direction));
  const bool cancelled = !(length(direction) >= kCancelled);
  const std::array<float, 3> set{cancelled ? instead[0] : unit.x, cancelled ? instead[1] : unit.y,
                                 cancelled ? instead[2] : unit.z};
  std::copy(set.begin(), set.end(), out);
}

}  // namespace

void ValueMerge::plan(std::uint32_t e, std::uint32_t a, std::uint32_t b, Vec3d p) {
  if (plans_.empty()) return;
  const Vec3d pa = state_.mesh.position(a), edge = state_.mesh.position(b) - pa;
  const double l2 = length_squared(edge);
  along_ = l2 > 0 ? static_cast<float>(std::clamp(dot(p - pa, edge) / l2, 0.0, 1.0)) : 0.5f;
  position_ = p;
  slot_ = state_.slot_of_vertex(a);
  const EdgeCorners corners = state_.mesh.edge_corners(e, a);
  for (std::size_t i = 0; i < plans_.size(); ++i) {
    const Channel& channel = state_.channels[i];
    Plan& plan = plans_[i];
    plan.classes.find(state_.mesh, channel, a, b, corners);
    plan.values.resize(plan.classes.size() * static_cast<std::size_t>(channel.width));
    for (std::uint32_t root = 0; root < plan.classes.size(); ++root) {
      if (plan.classes[root].root != root) continue;
      const std::uint32_t held = plan.classes.held_value(channel, a, b, root);
      plan_class(channel, plan, root, held);
    }
  }
}

void ValueMerge::plan_class(const Channel& channel, Plan& plan, std::uint32_t root, std::uint32_t held) {
  const float *at_a = nullptr, *at_b = nullptr;
  plan.classes.for_class(root, [&](const ValueClasses::Entry& entry) {
    (entry.at_b ? at_b : at_a) = channel.value(entry.value);
  });
  if (at_a == nullptr) at_a = at_b;
  if (at_b == nullptr) at_b = at_a;
  const auto width = static_cast<std::size_t>(channel.width);
  float* out = plan.values.data() + root * width;
  if (held != kInvalid) {
    std::copy_n(channel.value(held), width, out);
    return;
  }

  const float* const nearer = along_ < 0.5f ? at_a : at_b;
  if (channel.kind == ChannelKind::nearest || placement_ == Placement::half_edge) {
    std::copy_n(nearer, width, out);
    return;
  }
  if (channel.kind == ChannelKind::skin) {
    mix_skin(channel, at_a, at_b, out);
    return;
  }
  for (std::size_t k = 0; k < width; ++k) out[k] = at_a[k] + (at_b[k] - at_a[k]) * along_;
  if (channel.semantic == Semantic::tangent) out[3] = nearer[3];
  if (channel.semantic == Semantic::tangent || channel.semantic == Semantic::normal)
    set_direction({out[0], out[1], out[2]}, nearer, out);
  // Along a seam (more than one value at an end) texture coordinates stay on it: mixed, not fitted.
  if (channel.kind == ChannelKind::fitted && !(channel.is_uv() && plan.classes.size() > 2))
    fit(channel, plan, root, out);
}

void ValueMerge::fit(const Channel& channel, const Plan& plan, std::uint32_t root, float* out) {
  const double scale = channel.scale[slot_];
  const std::size_t stride = attribute_stride(channel.fit_width);
  sum_.assign(stride, 0.0f);
  plan.classes.for_class(root, [&](const ValueClasses::Entry& entry) {
    const float* q = channel.value_quadric(entry.value);
    for (std::size_t k = 0; k < stride; ++k) sum_[k] += q[k];
  });
  if (!(sum_[stride - 1] > 0) || !(scale > 0)) return;
  double fitted[3] = {};
  for (int k = 0; k < channel.fit_width; ++k) {
    const double value = fitted_value(sum_.data(), channel.fit_width, k, position_) / scale;
    if (channel.semantic == Semantic::normal) {
      fitted[k] = value;
    } else if (channel.semantic == Semantic::color) {
      out[k] = static_cast<float>(std::clamp(value, 0.0, 1.0));
    } else {
      out[k] = static_cast<float>(value);
    }
  }
  if (channel.semantic != Semantic::normal) return;
  set_direction({fitted[0], fitted[1], fitted[2]}, out, out);
}

/// Mixes two influence lists and keeps as many of the strongest as there is room for.
void ValueMerge::mix_skin(const Channel& channel, const float* at_a, const float* at_b, float* out) const {
  // Joints and weights come in layers of their own, in the same order of sets.
  std::vector<std::pair<float, float>> mixed;  // joint, weight
  std::vector<std::pair<int, int>> places;     // offsets of joint and weight
  std::vector<int> joints, weights;
  const auto& slices = channel.slices[slot_];
  for (const ChannelSlice& slice : slices) {
    auto& list = slice.semantic == Semantic::joints ? joints : weights;
    for (int i = 0; i < slice.width; ++i) list.push_back(slice.offset + i);
  }
  for (std::size_t i = 0; i < std::min(joints.size(), weights.size()); ++i)
    places.emplace_back(joints[i], weights[i]);
  const auto add = [&](const float* from, float share) {
    for (const auto& [j, w] : places) {
      if (from[w] * share <= 0) continue;
      const auto known =
          std::find_if(mixed.begin(), mixed.end(), [&, j = j](const auto& m) { return m.first == from[j]; });
      if (known == mixed.end()) {
        mixed.emplace_back(from[j], from[w] * share);
      } else {
        known->second += from[w] * share;
      }
    }
  };
  add(at_a, 1 - along_);
  add(at_b, along_);
  std::stable_sort(mixed.begin(), mixed.end(),
                   [](const auto& x, const auto& y) { return x.second > y.second; });
  mixed.resize(std::min(mixed.size(), places.size()));
  float total = 0;
  for (const auto& m : mixed) total += m.second;
  std::fill_n(out, channel.width, 0.0f);
  for (std::size_t i = 0; i < mixed.size(); ++i) {
    out[places[i].first] = mixed[i].first;
    out[places[i].second] = mixed[i].second / total;
  }
}

const float* ValueMerge::planned(std::size_t channel, std::uint32_t value) const {
  const Plan& plan = plans_[channel];
  const std::uint32_t root = plan.classes[plan.classes.index_of(value)].root;
  return plan.values.data() + root * static_cast<std::size_t>(state_.channels[channel].width);
}

/// Sets the numbers of class `root`, and writes down which values it joined and the numbers if they are new.
void ValueMerge::set_class(Channel& channel, const Plan& plan, std::uint32_t root, std::uint32_t mesh,
                           CollapseRecord& record) const {
  const std::uint32_t kept = plan.classes[root].kept;
  const auto width = static_cast<std::size_t>(channel.width);
  const float* const numbers = plan.values.data() + root * width;
  const bool is_new = !std::equal(numbers, numbers + width, channel.value(kept));
  std::copy_n(numbers, width, channel.value(kept));
  for (const ChannelSlice& slice : channel.slices[mesh]) {
    if (slice.layer != kInvalid) {
      plan.classes.for_class(root, [&](const ValueClasses::Entry& entry) {
        if (entry.value != kept)
          record.joins.push_back({slice.layer, channel.layer_value[entry.value], channel.layer_value[kept]});
      });
    }
    if (!is_new) continue;
    record.writes.push_back({slice.layer, channel.layer_value[kept].value});
    const float* values = numbers + slice.offset;
    record.floats.insert(record.floats.end(), values, values + slice.width);
  }
}

void ValueMerge::apply(std::uint32_t a, std::uint32_t b, std::uint32_t mesh, CollapseRecord& record) {
  for (std::size_t i = 0; i < plans_.size(); ++i) {
    Channel& channel = state_.channels[i];
    const Plan& plan = plans_[i];
    if (plan.classes.size() == 0) continue;
    const std::size_t stride = attribute_stride(channel.fit_width);
    for (std::uint32_t root = 0; root < plan.classes.size(); ++root) {
      if (plan.classes[root].root != root) continue;
      const std::uint32_t kept = plan.classes[root].kept;
      if (channel.kind == ChannelKind::fitted) {
        float* to = channel.value_quadric(kept);
        plan.classes.for_class(root, [&](const ValueClasses::Entry& entry) {
          if (entry.value == kept) return;
          const float* from = channel.value_quadric(entry.value);
          for (std::size_t k = 0; k < stride; ++k) to[k] += from[k];
        });
      }
      set_class(channel, plan, root, mesh, record);
    }
    relabel(channel, plan.classes, a, b);
    const bool many = channel.single[a] == Channel::kMany || channel.single[b] == Channel::kMany;
    channel.single[b] = many ? Channel::kMany : plan.classes[0].kept;
    channel.single[a] = kInvalid;
  }
}

/// Gives the corners at a and b the values that theirs become.
void ValueMerge::relabel(Channel& channel, const ValueClasses& classes, std::uint32_t a, std::uint32_t b) {
  if (classes.is_one_pair()) {
    const std::uint32_t kept = classes[0].kept;
    state_.mesh.for_ring(a, [&](std::uint32_t c) {
      std::uint32_t& value = channel.corner_value[c];
      value = value == kInvalid ? kInvalid : kept;
    });
    return;
  }
  const auto relabel_corner = [&](std::uint32_t c) {
    std::uint32_t& value = channel.corner_value[c];
    if (value != kInvalid) value = classes.kept_for(value);
  };
  state_.mesh.for_ring(a, relabel_corner);
  bool changes_b = false;
  for (std::uint32_t i = 0; i < classes.size(); ++i)
    changes_b |= classes[i].at_b && classes[classes[i].root].kept != classes[i].value;
  if (changes_b) state_.mesh.for_ring(b, relabel_corner);
}

void ValueMerge::update_singles(std::uint32_t b) {
  for (Channel& channel : state_.channels) {
    if (channel.single[b] != Channel::kMany) continue;
    std::uint32_t single = kInvalid;
    state_.mesh.for_ring(b, [&](std::uint32_t c) {
      const std::uint32_t value = channel.corner_value[c];
      if (value == kInvalid) return;
      single = single == kInvalid || single == value ? value : Channel::kMany;
    });
    channel.single[b] = single;
  }
}

}  // namespace fovea
