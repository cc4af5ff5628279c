#include "fovea/lod/contraction.h"

#include <algorithm>
#include <numeric>

namespace fovea {

std::uint64_t LevelIndices::triangle_count() const {
  return std::accumulate(triangles.begin(), triangles.end(), std::uint64_t{0});
}

Contraction::Contraction(const VertexHierarchy& hierarchy)
    : hierarchy_(hierarchy), target_(hierarchy.node_count()) {
  for (LevelIndices& level : levels_) {
    level.indices.resize(3 * hierarchy.face_count());
    level.triangles.assign(hierarchy.parts.size(), 0);
  }
}

void Contraction::begin(const StepBits& taken) {
  taken_ = &taken;
  std::fill(levels_[1 - shown_].triangles.begin(), levels_[1 - shown_].triangles.end(), 0);
  done_ = part_ = 0;
}

bool Contraction::advance(std::size_t work) {
  const std::size_t nodes = hierarchy_.node_count(), total = total_work();
  const std::size_t end = work < total - done_ ? done_ + work : total;
  if (done_ < nodes) find_targets(done_, std::min(end, nodes));
  if (end > nodes) write_faces(std::max(done_, nodes) - nodes, end - nodes);
  done_ = end;
  if (done_ < total) return false;
  shown_ = 1 - shown_;
  return true;
}

/// Of the nodes from the last but `begin` to the last but `end`.
void Contraction::find_targets(std::size_t begin, std::size_t end) {
  const std::size_t count = hierarchy_.node_count();
  for (std::size_t i = count - begin; i-- > count - end;) {
    const std::uint32_t step = hierarchy_.step[i];
    target_[i] = step != kInvalid && taken_->has(step) ? target_[hierarchy_.parent[i]] : hierarchy_.vertex[i];
  }
}

void Contraction::write_faces(std::size_t begin, std::size_t end) {
  LevelIndices& level = levels_[1 - shown_];
  while (begin < end) {
    const LevelPart& part = hierarchy_.parts[part_];
    const std::size_t part_end = std::min<std::size_t>(end, part.end_face);
    std::uint32_t* const first = level.indices.data() + 3 * std::size_t{part.first_face};
    std::uint32_t* to = first + 3 * std::size_t{level.triangles[part_]};
    for (; begin < part_end; ++begin) {
      const std::uint32_t step = hierarchy_.removed_by[begin];
      if (step != kInvalid && taken_->has(step)) continue;
      for (const std::uint32_t node : hierarchy_.corners[begin]) *to++ = target_[node];
    }
    level.triangles[part_] = static_cast<std::uint32_t>(to - first) / 3;
    if (begin == part.end_face) ++part_;
  }
}

}  // namespace fovea
