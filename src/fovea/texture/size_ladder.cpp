#include "fovea/texture/size_ladder.h"

#include <algorithm>
#include <limits>
#include <utility>

namespace fovea {

namespace {

/// Loss for each byte that b saves against a.
double price(const LadderStep& a, const LadderStep& b) { return (b.loss - a.loss) / (a.bytes - b.bytes); }

double sum_of_bytes(std::span<const SizeLadder> ladders, std::span<const std::size_t> steps) {
  double sum = 0;
  for (std::size_t i = 0; i < ladders.size(); ++i) {
    if (!ladders[i].empty()) sum += ladders[i][steps[i]].bytes;
  }
  return sum;
}

/// The ladder with the cheapest step down; none if all are at their ends.
std::size_t cheapest(std::span<const SizeLadder> ladders, std::span<const std::size_t> steps) {
  std::size_t best = ladders.size();
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < ladders.size(); ++i) {
    if (steps[i] + 1 >= ladders[i].size()) continue;
    const double found = price(ladders[i][steps[i]], ladders[i][steps[i] + 1]);
    if (best == ladders.size() || found < least) best = i, least = found;
  }
  return best;
}

/// The ladder with the dearest step that fits back in; none if none fits.
std::size_t dearest(std::span<const SizeLadder> ladders, std::span<const std::size_t> steps, double room) {
  std::size_t best = ladders.size();
  double most = 0;
  for (std::size_t i = 0; i < ladders.size(); ++i) {
    if (ladders[i].empty() || steps[i] == 0) continue;
    const LadderStep &now = ladders[i][steps[i]], &up = ladders[i][steps[i] - 1];
    if (up.bytes - now.bytes > room || !(price(up, now) > most)) continue;
    best = i;
    most = price(up, now);
  }
  return best;
}

}  // namespace

SizeLadder lower_hull(std::vector<LadderStep> steps) {
  std::ranges::stable_sort(steps, [](const LadderStep& a, const LadderStep& b) {
    return a.loss != b.loss ? a.loss < b.loss : a.bytes < b.bytes;
  });
  SizeLadder hull;
  for (const LadderStep& step : steps) {
    if (!hull.empty() && step.bytes >= hull.back().bytes) continue;
    while (hull.size() > 1 && price(hull.back(), step) <= price(hull[hull.size() - 2], hull.back()))
      hull.pop_back();
    hull.push_back(step);
  }
  return hull;
}

std::vector<std::size_t> choose_steps(std::span<const SizeLadder> ladders, double bytes) {
  std::vector<std::size_t> steps(ladders.size(), 0);
  while (sum_of_bytes(ladders, steps) > bytes) {
    const std::size_t next = cheapest(ladders, steps);
    if (next == ladders.size()) return steps;
    ++steps[next];
  }
  for (;;) {
    const std::size_t next = dearest(ladders, steps, bytes - sum_of_bytes(ladders, steps));
    if (next == ladders.size()) return steps;
    --steps[next];
  }
}

}  // namespace fovea
