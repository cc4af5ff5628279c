#include "fovea/simplify/value_classes.h"

#include <algorithm>
#include <bit>

namespace fovea {

// --- Values that join -------------------------------------------------------------------------------

/// The values of another triangle on the edge join.
void JoinedValues::join(std::uint32_t at_a, std::uint32_t at_b) {
  const std::uint32_t x = members_[add(at_a, false)].root, y = members_[add(at_b, true)].root;
  if (x == y) return;
  for (std::uint32_t k = 0; k < count_; ++k) {
    if (members_[k].root == std::max(x, y)) members_[k].root = std::min(x, y);
  }
}

std::uint32_t JoinedValues::add(std::uint32_t value, bool at_b) {
  for (std::uint32_t i = 0; i < count_; ++i) {
    if (members_[i].value == value) return i;
  }
  members_[count_] = {value, count_, at_b};
  return count_++;
}

// --- All values -------------------------------------------------------------------------------------

void ValueClasses::find(const CollapseMesh& mesh, const Channel& channel, std::uint32_t a, std::uint32_t b,
                        const EdgeCorners& corners) {
  entries_.clear();
  const std::uint32_t single_a = channel.single[a], single_b = channel.single[b];
  is_one_pair_ = single_a < Channel::kMany && single_b < Channel::kMany;
  if (is_one_pair_) {
    entries_.push_back({single_a, 0, 1, false, single_b});
    entries_.push_back({single_b, 0, kInvalid, true, kInvalid});
    return;
  }
  const JoinedValues joined(channel, corners);
  for (std::uint32_t i = 0; i < joined.size(); ++i) {
    const auto& [value, root, at_b] = joined[i];
    entries_.push_back({value, root, kInvalid, at_b, value});
    if (root == i) continue;
    std::uint32_t last = root;
    while (entries_[last].next != kInvalid) last = entries_[last].next;
    entries_[last].next = i;
    // The root is at a: corners at a come first.
    if (at_b && entries_[root].kept == entries_[root].value) entries_[root].kept = value;
  }
  add_rest(mesh, channel, a, false);
  add_rest(mesh, channel, b, true);
}

/// Adds the values at v that join with none.
void ValueClasses::add_rest(const CollapseMesh& mesh, const Channel& channel, std::uint32_t v, bool at_b) {
  const std::uint32_t single = channel.single[v];
  if (single != Channel::kMany) {
    if (single != kInvalid && index_of(single) == kInvalid) add_class(single, at_b);
    return;
  }
  for (const std::uint32_t c : mesh.ring(v)) {
    const std::uint32_t value = channel.corner_value[c];
    if (value != kInvalid && index_of(value) == kInvalid) add_class(value, at_b);
  }
}

void ValueClasses::add_class(std::uint32_t value, bool at_b) {
  const auto index = static_cast<std::uint32_t>(entries_.size());
  entries_.push_back({value, index, kInvalid, at_b, value});
  if (entries_.size() == kFew + 1 || (entries_.size() > kFew && 2 * entries_.size() > table_.size())) {
    rebuild_table();
  } else if (entries_.size() > kFew) {
    table_[slot_of(value)] = index;
  }
}

std::uint32_t ValueClasses::held_value(const Channel& channel, std::uint32_t a, std::uint32_t b,
                                       std::uint32_t root) const {
  if (!channel.is_uv()) return kInvalid;
  ClassEnds ends;
  for_class(root, [&](const Entry& entry) { ends.add(entry.value, entry.at_b); });
  return ends.held_value(channel.single[a] == Channel::kMany, channel.single[b] == Channel::kMany);
}

std::uint32_t ValueClasses::index_in_table(std::uint32_t value) const { return table_[slot_of(value)]; }

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

}  // namespace fovea
