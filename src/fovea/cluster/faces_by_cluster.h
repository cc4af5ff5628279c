#pragma once

#include <cstdint>
#include <span>
#include <vector>

// Private to cluster/.

namespace fovea {

/// The triangles of each cluster, in rising order.
class FacesByCluster {
 public:
  /// O(#F).
  FacesByCluster(std::span<const std::uint32_t> of_face, std::size_t count);

  std::span<const std::uint32_t> of(std::size_t cluster) const {
    return {faces_.data() + first_[cluster], faces_.data() + first_[cluster + 1]};
  }

 private:
  std::vector<std::uint32_t> first_;  // [count + 1]
  std::vector<std::uint32_t> faces_;  // [#F]
};

}  // namespace fovea
