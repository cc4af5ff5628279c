#include "fovea/cluster/faces_by_cluster.h"

namespace fovea {

FacesByCluster::FacesByCluster(std::span<const std::uint32_t> of_face, std::size_t count)
    : first_(count + 1, 0), faces_(of_face.size()) {
  for (const std::uint32_t c : of_face) ++first_[c + 1];
  for (std::size_t c = 0; c < count; ++c) first_[c + 1] += first_[c];
  std::vector<std::uint32_t> next(first_.begin(), first_.end() - 1);
  for (std::uint32_t f = 0; f < of_face.size(); ++f) faces_[next[of_face[f]]++] = f;
}

}  // namespace fovea
