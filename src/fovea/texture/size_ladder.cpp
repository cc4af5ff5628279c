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
  return steps;
}

void fill_room(std::span<const std::vector<LadderStep>> ways, double bytes,
               std::vector<std::size_t>& chosen) {
  double room = bytes - sum_of_bytes(ways, chosen);
  for (;;) {
    std::size_t best = ways.size(), best_way = 0;
    double most = 0;
    for (std::size_t i = 0; i < ways.size(); ++i) {
      if (ways[i].empty()) continue;
      const LadderStep& now = ways[i][chosen[i]];
      for (std::size_t w = 0; w < ways[i].size(); ++w) {
        if (ways[i][w].bytes - now.bytes > room || !(now.loss - ways[i][w].loss > most)) continue;
        most = now.loss - ways[i][w].loss;
        best = i;
        best_way = w;
      }
    }
    if (best == ways.size()) return;
    room -= ways[best][best_way].bytes - ways[best][chosen[best]].bytes;
    chosen[best] = best_way;
  }
}

}  // namespace fovea
