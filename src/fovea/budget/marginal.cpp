#include "fovea/budget/marginal.h"

#include <algorithm>
#include <limits>
#include <map>
#include <optional>

namespace fovea {

namespace {

/// Measures each choice of rungs once.
class Measured {
 public:
  explicit Measured(const JointLadders& ladders) : ladders_(ladders) {}

  const JointPoint& operator()(const Rungs& rungs) {
    const auto [at, is_new] = points_.try_emplace(rungs);
    if (is_new) at->second = {rungs, ladders_.bytes(rungs), ladders_.loss(rungs)};
    return at->second;
  }

 private:
  const JointLadders& ladders_;
  std::map<Rungs, JointPoint> points_;
};

/// Loss for each byte of the step between two points, from the larger to the smaller.
double slope(const JointPoint& large, const JointPoint& small) {
  const double saved = large.bytes > small.bytes ? static_cast<double>(large.bytes - small.bytes) : 0;
  const double lost = small.loss - large.loss;
  if (saved > 0) return lost / saved;
  return lost <= 0 ? -std::numeric_limits<double>::infinity() : std::numeric_limits<double>::infinity();
}

Rungs moved(Rungs rungs, std::size_t ladder, int by) {
  rungs[ladder] = static_cast<std::size_t>(static_cast<std::ptrdiff_t>(rungs[ladder]) + by);
  return rungs;
}

}  // namespace

std::vector<JointPoint> prune(const JointLadders& ladders, std::uint64_t bytes,
                              std::span<const std::size_t> ahead) {
  /// What the next step of a ladder loses for each byte, how far it goes, and where that was measured.
  struct Next {
    double slope = 0;
    int rungs = 1;
    Rungs from;
  };
  Measured measured(ladders);
  std::vector<JointPoint> path{measured(Rungs(ladders.rungs.size(), 0))};
  std::vector<std::optional<Next>> next(ladders.rungs.size());
  while (path.back().bytes > bytes) {
    const JointPoint at = path.back();
    const auto step = [&](std::size_t ladder, int by) {
      return Next{slope(at, measured(moved(at.rungs, ladder, by))), by, at.rungs};
    };
    const auto measure = [&](std::size_t ladder) {
      const std::size_t most = ladder < ahead.size() ? std::max<std::size_t>(ahead[ladder], 1) : 1;
      for (std::size_t n = 1; n <= most && at.rungs[ladder] + n < ladders.rungs[ladder]; ++n) {
        const Next found = step(ladder, static_cast<int>(n));
        if (!next[ladder] || found.slope < next[ladder]->slope) next[ladder] = found;
      }
    };
    std::optional<std::size_t> best;
    for (std::size_t l = 0; l < next.size(); ++l) {
      if (at.rungs[l] + 1 >= ladders.rungs[l]) continue;
      if (!next[l]) measure(l);
      if (!best || next[l]->slope < next[*best]->slope) best = l;
    }
    if (!best) break;
    if (next[*best]->from != at.rungs) {
      next[*best] = step(*best, next[*best]->rungs);
      continue;  // another may be better now
    }
    path.push_back(measured(moved(at.rungs, *best, next[*best]->rungs)));
    next[*best].reset();
  }
  return path;
}

std::vector<JointPoint> grow(const JointLadders& ladders, std::uint64_t bytes) {
  Measured measured(ladders);
  Rungs smallest;
  for (const std::size_t count : ladders.rungs) smallest.push_back(count - 1);
  std::vector<JointPoint> path;
  if (ladders.bytes(smallest) > bytes) return path;
  path.push_back(measured(smallest));
  while (true) {
    const JointPoint at = path.back();
    std::optional<JointPoint> best;
    for (std::size_t l = 0; l < at.rungs.size(); ++l) {
      if (at.rungs[l] == 0 || ladders.bytes(moved(at.rungs, l, -1)) > bytes) continue;
      const JointPoint& up = measured(moved(at.rungs, l, -1));
      if (!best || slope(up, at) > slope(*best, at)) best = up;
    }
    if (!best) return path;
    path.push_back(*best);
  }
}

std::vector<JointPoint> exhaust(const JointLadders& ladders) {
  std::vector<JointPoint> points;
  Rungs rungs(ladders.rungs.size(), 0);
  while (true) {
    points.push_back({rungs, ladders.bytes(rungs), ladders.loss(rungs)});
    std::size_t l = 0;
    while (l < rungs.size() && ++rungs[l] == ladders.rungs[l]) rungs[l++] = 0;
    if (l == rungs.size()) return points;
  }
}

std::vector<JointPoint> lower_hull(std::vector<JointPoint> points) {
  std::ranges::sort(points, [](const JointPoint& a, const JointPoint& b) {
    return std::pair(a.bytes, a.loss) < std::pair(b.bytes, b.loss);
  });
  std::vector<JointPoint> hull;  // from the smallest up
  for (JointPoint& point : points) {
    if (!hull.empty() && point.loss >= hull.back().loss) continue;
    while (hull.size() > 1 && slope(point, hull.back()) >= slope(hull.back(), hull[hull.size() - 2]))
      hull.pop_back();
    hull.push_back(std::move(point));
  }
  std::ranges::reverse(hull);
  return hull;
}

}  // namespace fovea
