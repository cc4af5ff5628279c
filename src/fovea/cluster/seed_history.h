#pragma once

#include <cstdint>
#include <optional>
#include <unordered_set>
#include <vector>

#include "fovea/cluster/clusters.h"

// Private to cluster/.

namespace fovea {

/// Tells when seeds come back. Which cluster grows from which does not matter.
class SeedHistory {
 public:
  /// Adds the seeds of a round: `converged` if they are those of the last one, `cycle` if those of an earlier
  /// one (by hashes of 64 bits). O(#seeds log #seeds).
  std::optional<ClusterEnd> add(std::vector<std::uint32_t> seeds);

 private:
  std::vector<std::uint32_t> last_;
  std::unordered_set<std::uint64_t> hashes_;
};

}  // namespace fovea
