#include "fovea/simplify/value_classes.h"

#include <algorithm>

namespace fovea {

std::size_t ValueClasses::index_of(std::uint32_t value) const {
  std::size_t i = 0;
  while (entries_[i].value != value) ++i;
  return i;
}

std::size_t ValueClasses::add(std::uint32_t value, bool at_b) {
  for (std::size_t i = 0; i < entries_.size(); ++i) {
    if (entries_[i].value == value) return i;
  }
  entries_.push_back({value, static_cast<std::uint32_t>(entries_.size()), at_b});
  return entries_.size() - 1;
}

void ValueClasses::join(std::size_t i, std::size_t j) {
  if (entries_[i].root == entries_[j].root) return;
  const std::uint32_t keep = std::min(entries_[i].root, entries_[j].root);
  const std::uint32_t drop = std::max(entries_[i].root, entries_[j].root);
  for (Entry& e : entries_) {
    if (e.root == drop) e.root = keep;
  }
}

void ValueClasses::find(const CollapseState& state, const Channel& channel, std::uint32_t a,
                        std::uint32_t b) {
  entries_.clear();
  const std::uint32_t single_a = channel.single[a], single_b = channel.single[b];
  if (single_a < Channel::kMany) entries_.push_back({single_a, 0, false});
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
      const std::size_t own = add(value, v == b);
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
  const bool seam_a = channel.single[a] == Channel::kMany, seam_b = channel.single[b] == Channel::kMany;
  if (!channel.is_uv() || (!seam_a && !seam_b)) return kInvalid;
  std::size_t at_a = 0, at_b = 0;
  std::uint32_t value_a = kInvalid, value_b = kInvalid;
  for (std::size_t i = root; i < entries_.size(); ++i) {
    if (entries_[i].root != root) continue;
    ++(entries_[i].at_b ? at_b : at_a);
    (entries_[i].at_b ? value_b : value_a) = entries_[i].value;
  }
  if (at_a == 0 || at_b == 0) return at_a == 0 ? value_b : value_a;
  if (at_a != at_b) return at_a > at_b ? value_b : value_a;
  if (seam_a != seam_b) return seam_a ? value_a : value_b;
  return kInvalid;
}

}  // namespace fovea
