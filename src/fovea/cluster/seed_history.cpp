#include "fovea/cluster/seed_history.h"

#include <algorithm>
#include <utility>

#include "fovea/base/random.h"

namespace fovea {

namespace {

std::uint64_t hash(const std::vector<std::uint32_t>& seeds) {
  std::uint64_t h = seeds.size();
  for (const std::uint32_t s : seeds) h = Random(h ^ s).next();
  return h;
}

}  // namespace

std::optional<ClusterEnd> SeedHistory::add(std::vector<std::uint32_t> seeds) {
  std::sort(seeds.begin(), seeds.end());
  if (seeds == last_) return ClusterEnd::converged;
  if (!hashes_.insert(hash(seeds)).second) return ClusterEnd::cycle;
  last_ = std::move(seeds);
  return {};
}

}  // namespace fovea
