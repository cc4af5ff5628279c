#include "fovea/cluster/seeds.h"

#include <algorithm>
#include <limits>
#include <queue>
#include <utility>

#include "fovea/base/parallel.h"
#include "fovea/base/random.h"
#include "fovea/cluster/faces_by_cluster.h"
#include "fovea/cluster/radix_heap.h"
#include "fovea/model/ids.h"

namespace fovea {

namespace {

constexpr std::size_t kPoolFactor = 5;  // λ_c
/// What a step counts for at least, of its length: as printed ways over what is not salient would have none.
constexpr float kLeastShare = 0.01f;
constexpr float kUnreached = std::numeric_limits<float>::infinity();

/// The first `count` of the items by `less`, in that order.
template <class Less>
void keep_first(std::vector<std::uint32_t>& items, std::size_t count, Less less) {
  if (count < items.size()) {
    std::nth_element(items.begin(), items.begin() + static_cast<std::ptrdiff_t>(count), items.end(), less);
    items.resize(count);
  }
  std::sort(items.begin(), items.end(), less);
}

/// One search inwards in each cluster.
class Inwards {
 public:
  Inwards(const ClusterGround& ground, std::span<const std::uint32_t> of_face)
      : ground_(ground), of_face_(of_face), distance_(of_face.size(), kUnreached) {}

  /// The last triangle of a cluster that is reached from its border; none without border.
  std::uint32_t last_of(std::span<const std::uint32_t> faces, RadixHeap<std::uint32_t>& queue) {
    queue.clear();
    float peak = 0;
    for (const std::uint32_t f : faces) {
      peak = std::max(peak, ground_.face_saliency[f]);
      if (is_border(f)) reach(f, 0, queue);
    }
    std::uint32_t last = kInvalid;
    while (!queue.empty()) {
      const auto [key, f] = queue.pop();
      const auto distance = static_cast<float>(key);
      if (distance > distance_[f]) continue;
      if (last == kInvalid || distance > distance_[last] || f < last) last = f;
      for (const DualGraph::Link& link : ground_.graph.around(f)) {
        if (of_face_[link.face] != of_face_[f]) continue;
        const float share = peak > 0 ? std::max(ground_.face_saliency[link.face] / peak, kLeastShare) : 1;
        reach(link.face, distance + link.distance * share, queue);
      }
    }
    return last;
  }

 private:
  bool is_border(std::uint32_t face) const {
    const auto links = ground_.graph.around(face);
    return std::any_of(links.begin(), links.end(),
                       [&](const DualGraph::Link& link) { return of_face_[link.face] != of_face_[face]; });
  }
  void reach(std::uint32_t face, float distance, RadixHeap<std::uint32_t>& queue) {
    if (distance >= distance_[face]) return;
    distance_[face] = distance;
    queue.push(static_cast<double>(distance), face);
  }

  const ClusterGround& ground_;
  std::span<const std::uint32_t> of_face_;
  std::vector<float> distance_;  // [#F]
};

}  // namespace

std::vector<std::uint32_t> salient_seeds(const ClusterGround& ground, std::size_t count, std::uint64_t seed) {
  std::vector<std::uint32_t> pool;
  for (std::uint32_t v = 0; v < ground.vertex_saliency.size(); ++v) {
    if (!ground.adjacency.corners(v).empty()) pool.push_back(v);
  }
  keep_first(pool, kPoolFactor * count, [&](std::uint32_t a, std::uint32_t b) {
    return std::pair(-ground.vertex_saliency[a], a) < std::pair(-ground.vertex_saliency[b], b);
  });
  Random random(seed);
  const std::size_t picked = std::min(count, pool.size());
  for (std::size_t i = 0; i < picked; ++i)
    std::swap(pool[i], pool[i + random.below(static_cast<std::uint32_t>(pool.size() - i))]);
  std::vector<std::uint32_t> seeds(count);
  for (std::size_t i = 0; i < count; ++i) seeds[i] = pool[i % picked];
  return seeds;
}

std::vector<std::uint32_t> spread_faces(const DualGraph& graph, std::size_t count, std::uint64_t seed) {
  Random random(seed);
  std::vector<float> distance(graph.face_count(), kUnreached);
  std::vector<std::uint32_t> chosen{random.below(static_cast<std::uint32_t>(graph.face_count()))};
  // Farthest first, then by number; what came nearer since is put back when it comes up.
  using Far = std::pair<float, std::uint32_t>;
  const auto later = [](const Far& a, const Far& b) {
    return std::pair(-a.first, a.second) > std::pair(-b.first, b.second);
  };
  std::vector<Far> all;
  RadixHeap<std::uint32_t> queue;
  const auto reach = [&](std::uint32_t face, float d) {
    if (d >= distance[face]) return;
    distance[face] = d;
    queue.push(static_cast<double>(d), face);
  };
  const auto search = [&](std::uint32_t from) {
    queue.clear();
    distance[from] = kUnreached;
    reach(from, 0);
    while (!queue.empty()) {
      const auto [key, f] = queue.pop();
      const auto d = static_cast<float>(key);
      if (d > distance[f]) continue;
      for (const DualGraph::Link& link : graph.around(f)) reach(link.face, d + link.distance);
    }
    distance[from] = -1;  // chosen
  };
  search(chosen[0]);
  for (std::uint32_t f = 0; f < graph.face_count(); ++f) all.emplace_back(distance[f], f);
  std::priority_queue farthest(later, std::move(all));
  while (chosen.size() < count) {
    const auto [d, f] = farthest.top();
    farthest.pop();
    if (distance[f] < d) {
      if (distance[f] >= 0) farthest.emplace(distance[f], f);
      continue;
    }
    chosen.push_back(f);
    search(f);
  }
  return chosen;
}

std::vector<std::uint32_t> inner_seeds(const ClusterGround& ground, std::span<const std::uint32_t> of_face,
                                       std::span<const std::uint32_t> seeds, const Context& context) {
  const FacesByCluster members(of_face, seeds.size());
  Inwards inwards(ground, of_face);
  std::vector<std::uint32_t> result(seeds.begin(), seeds.end());
  const std::size_t grain = 1 + seeds.size() / 64;
  parallel_for(context, seeds.size(), grain, [&](std::size_t begin, std::size_t end) {
    RadixHeap<std::uint32_t> queue;
    for (std::size_t c = begin; c < end; ++c) {
      const std::uint32_t last = inwards.last_of(members.of(c), queue);
      if (last != kInvalid) result[c] = ground.peak_vertex(last);
    }
  });
  return result;
}

}  // namespace fovea
