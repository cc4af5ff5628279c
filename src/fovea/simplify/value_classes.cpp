#include "fovea/simplify/value_classes.h"

#include <algorithm>
#include <bit>

namespace fovea {

namespace {

/// Up to so many values are searched one after the other.
constexpr std::size_t kFew = 16;

}  // namespace

std::uint32_t ValueClasses::index_of(std::uint32_t value) const {
  if (entries_.size() > kFew) return table_[slot_of(value)];
  std::uint32_t i = 0;
  while (i < entries_.size() && entries_[i].value != value) ++i;
  return i < entries_.size() ? i : kInvalid;
}

/// Where `value` is in the table, or where it would go.
std::size_t ValueClasses::slot_of(std::uint32_t value) const {
  const std::size_t mask = table_.size() - 1;
  std::size_t slot = (value * 0x9E3779B1u) & mask;
  while (table_[slot] != kInvalid && entries_[table_[slot]].value != value) slot = (slot + 1) & mask;
  return slot;
}

void ValueClasses::rebuild_table() {
  table_.assign(std::bit_ceil(4 * entries_.size()), kInvalid);
  for (std::uint32_t i = 0; i < entries_.size(); ++i) table_[slot_of(entries_[i].value)] = i;
}

/// Index of the entry of `value`, which is new if need be.
std::uint32_t ValueClasses::add(std::uint32_t value, bool at_b) {
  const std::uint32_t known = index_of(value);
  if (known != kInvalid) return known;
  const auto index = static_cast<std::uint32_t>(entries_.size());
  entries_.push_back({value, index, kInvalid, at_b});
  if (entries_.size() == kFew + 1 || (entries_.size() > kFew && 2 * entries_.size() > table_.size())) {
    rebuild_table();
  } else if (entries_.size() > kFew) {
    table_[slot_of(value)] = index;
  }
  return index;
}

void ValueClasses::join(std::uint32_t i, std::uint32_t j) {
  if (entries_[i].root == entries_[j].root) return;
  const std::uint32_t keep = std::min(entries_[i].root, entries_[j].root);
  const std::uint32_t drop = std::max(entries_[i].root, entries_[j].root);
  for (std::uint32_t k = drop; k != kInvalid; k = entries_[k].next) entries_[k].root = keep;
  std::uint32_t last = keep;
  while (entries_[last].next != kInvalid) last = entries_[last].next;
  entries_[last].next = drop;
}

void ValueClasses::find(const CollapseState& state, const Channel& channel, std::uint32_t a,
                        std::uint32_t b) {
  entries_.clear();
  const std::uint32_t single_a = channel.single[a], single_b = channel.single[b];
  if (single_a < Channel::kMany) add(single_a, false);
  if (single_b < Channel::kMany) add(single_b, true);
  if (single_a < Channel::kMany && single_b < Channel::kMany) {
    join(0, 1);
    return;
  }
  // Only the rings of vertices with several values are looked at, and the first of them for triangles
  // on the edge.
  const CollapseMesh& mesh = state.mesh;
  const auto look_around = [&](std::uint32_t v, std::uint32_t other, bool joins) {
    mesh.for_ring(v, [&](std::uint32_t c) {
      const std::uint32_t value = channel.corner_value[c];
      if (value == kInvalid) return;
      const std::uint32_t own = add(value, v == b);
      if (!joins) return;
      for (const std::uint32_t d : {CollapseMesh::next(c), CollapseMesh::previous(c)}) {
        if (mesh.vertex(d) == other) join(own, add(channel.corner_value[d], other == b));
      }
    });
  };
  if (single_a == Channel::kMany) look_around(a, b, true);
  if (single_b == Channel::kMany) look_around(b, a, single_a != Channel::kMany);
}

std::uint32_t ValueClasses::held_value(const Channel& channel, std::uint32_t a, std::uint32_t b,
                                       std::uint32_t root) const {
  if (!channel.is_uv()) return kInvalid;
  ClassEnds ends;
  for_class(root, [&](const Entry& entry) { ends.add(entry.value, entry.at_b); });
  return ends.held_value(channel.single[a] == Channel::kMany, channel.single[b] == Channel::kMany);
}

}  // namespace fovea
