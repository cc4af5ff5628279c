#include "fovea/simplify/edge_cost.h"

#include <algorithm>

#include "fovea/simplify/value_classes.h"

namespace fovea {

namespace {

/// Optimal positions further from the edge than this many edge lengths are not believed.
constexpr double kReach = 2;

/// The sum of attribute quadrics of one channel.
class AttributeSum {
 public:
  explicit AttributeSum(std::size_t stride) : stride_(stride) {
    if (stride > near_.size()) far_.resize(stride);
  }
  void add(const double* q) {
    double* const total = far_.empty() ? near_.data() : far_.data();
    for (std::size_t i = 0; i < stride_; ++i) total[i] = (sum_ == nullptr ? 0 : sum_[i]) + q[i];
    sum_ = total;
  }
  const double* get() const { return sum_; }

 private:
  std::size_t stride_;
  const double* sum_ = nullptr;
  std::array<double, attribute_stride(4)> near_;
  std::vector<double> far_;  // of wide channels
};

/// Adds the error of a sum of attribute quadrics whose texture coordinates stay those of `value`.
void hold_at(Quadric& q, const Channel& channel, const double* attribute, std::uint32_t value,
             std::uint32_t mesh) {
  const double scale = channel.scale[mesh];
  const float* numbers = channel.value(value);
  const double scaled[2] = {scale * numbers[0], scale * numbers[1]};
  hold(q, attribute, channel.fit_width, scaled);
}

}  // namespace

EdgeCost::EdgeCost(const CollapseState& state, Placement placement)
    : state_(state), mesh_(state.mesh), placement_(placement), slot_(mesh_.vertices.size(), kInvalid) {
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
    for (const std::uint32_t value : values_) sum += separate(channel, v, value);
  }
  if (!many) {
    slot_[v] = kInvalid;
    return;
  }
  if (slot_[v] == kInvalid) {
    slot_[v] = static_cast<std::uint32_t>(separate_.size());
    separate_.emplace_back();
  }
  separate_[slot_[v]] = sum;
}

Quadric EdgeCost::separate(const Channel& channel, std::uint32_t v, std::uint32_t value) const {
  Quadric q;
  const double* const attribute = channel.value_quadric(value);
  if (channel.is_uv()) {
    hold_at(q, channel, attribute, value, state_.slot_of_vertex(v));
  } else {
    reduce(q, attribute, channel.fit_width);
  }
  return q;
}

EdgeCost::EdgeCorners EdgeCost::corners_of(std::uint32_t a, std::uint32_t b) const {
  EdgeCorners corners;
  const bool from_a = mesh_.vertices[a].ring_size <= mesh_.vertices[b].ring_size;
  const std::uint32_t other = from_a ? b : a;
  mesh_.for_ring(from_a ? a : b, [&](std::uint32_t c) {
    for (const std::uint32_t d : {CollapseMesh::next(c), CollapseMesh::previous(c)}) {
      if (mesh_.vertex(d) != other || corners.count == EdgeCorners::kMost) continue;
      corners.pairs[corners.count][0] = from_a ? c : d;
      corners.pairs[corners.count++][1] = from_a ? d : c;
    }
  });
  return corners;
}

/// For a channel with several values at an end: those that join on the edge are settled together instead
/// of by themselves.
void EdgeCost::settle_joined(Quadric& q, const Channel& channel, std::uint32_t a, std::uint32_t b,
                             const EdgeCorners& corners) const {
  struct Member {
    std::uint32_t value = kInvalid;
    bool at_b = false;
    std::size_t root = 0;
  };
  std::array<Member, 2 * EdgeCorners::kMost> members;
  std::size_t count = 0;
  const auto add = [&](std::uint32_t value, bool at_b) {
    for (std::size_t i = 0; i < count; ++i) {
      if (members[i].value == value) return i;
    }
    members[count] = {value, at_b, count};
    return count++;
  };
  for (std::size_t i = 0; i < corners.count; ++i) {
    const auto [ca, cb] = corners.pairs[i];
    if (channel.corner_value[ca] == kInvalid || channel.corner_value[cb] == kInvalid) continue;
    const std::size_t x = members[add(channel.corner_value[ca], false)].root;
    const std::size_t y = members[add(channel.corner_value[cb], true)].root;
    for (std::size_t k = 0; k < count; ++k) {
      if (members[k].root == std::max(x, y)) members[k].root = std::min(x, y);
    }
  }
  const bool many_a = channel.single[a] == Channel::kMany, many_b = channel.single[b] == Channel::kMany;
  for (std::size_t root = 0; root < count; ++root) {
    if (members[root].root != root) continue;
    AttributeSum sum(attribute_stride(channel.fit_width));
    ClassEnds ends;
    for (std::size_t k = root; k < count; ++k) {
      const Member& member = members[k];
      if (member.root != root) continue;
      sum.add(channel.value_quadric(member.value));
      ends.add(member.value, member.at_b);
      if (member.at_b ? many_b : many_a)
        q.add_scaled(separate(channel, member.at_b ? b : a, member.value), -1);
    }
    const std::uint32_t held = channel.is_uv() ? ends.held_value(many_a, many_b) : kInvalid;
    if (held == kInvalid) {
      reduce(q, sum.get(), channel.fit_width);
    } else {
      hold_at(q, channel, sum.get(), held, state_.slot_of_vertex(a));
    }
  }
  // An end's only value that no triangle on the edge uses.
  const auto add_single = [&](std::uint32_t v) {
    const std::uint32_t single = channel.single[v];
    if (single >= Channel::kMany) return;
    for (std::size_t i = 0; i < count; ++i) {
      if (members[i].value == single) return;
    }
    q += separate(channel, v, single);
  };
  add_single(a);
  add_single(b);
}

Quadric EdgeCost::quadric(std::uint32_t a, std::uint32_t b) const {
  Quadric q = mesh_.quadrics[a] + mesh_.quadrics[b];
  EdgeCorners corners;
  const std::uint32_t slot_a = slot_[a], slot_b = slot_[b];
  if (slot_a != kInvalid || slot_b != kInvalid) {
    corners = corners_of(a, b);
    if (slot_a != kInvalid) q += separate_[slot_a];
    if (slot_b != kInvalid) q += separate_[slot_b];
  }
  for (const Channel& channel : state_.channels) {
    if (channel.kind != ChannelKind::fitted) continue;
    const std::uint32_t single_a = channel.single[a], single_b = channel.single[b];
    if (single_a == Channel::kMany || single_b == Channel::kMany) {
      settle_joined(q, channel, a, b, corners);
    } else if (single_a != kInvalid && single_b != kInvalid) {
      AttributeSum sum(attribute_stride(channel.fit_width));
      sum.add(channel.value_quadric(single_a));
      sum.add(channel.value_quadric(single_b));
      reduce(q, sum.get(), channel.fit_width);
    } else if (single_a != kInvalid || single_b != kInvalid) {
      reduce(q, channel.value_quadric(std::min(single_a, single_b)), channel.fit_width);
    }
  }
  return q;
}

std::size_t EdgeCost::fallbacks(std::uint32_t a, std::uint32_t b, const Quadric& q, Candidate* out) const {
  const Vec3d pa = mesh_.vertices[a].position, pb = mesh_.vertices[b].position;
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

Candidate EdgeCost::best_place(std::uint32_t a, std::uint32_t b, const Quadric& q) const {
  if (placement_ == Placement::optimal && !mesh_.vertices[a].locked && !mesh_.vertices[b].locked) {
    const Vec3d pa = mesh_.vertices[a].position, pb = mesh_.vertices[b].position;
    Candidate best;
    if (q.minimum(best.position) &&
        length_squared(best.position - (pa + pb) * 0.5) <= kReach * kReach * length_squared(pb - pa)) {
      best.cost = std::max(q.value_at_minimum(best.position), 0.0);
      return best;
    }
  }
  std::array<Candidate, 3> all;
  return fallbacks(a, b, q, all.data()) > 0 ? all[0] : Candidate{};
}

}  // namespace fovea
