#include "fovea/surface/statistics.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numeric>

namespace fovea {

std::vector<float> percentiles(std::span<const float> values, std::span<const float> weights,
                               std::span<const double> shares) {
  std::vector<std::uint32_t> order;
  double total = 0;
  for (std::uint32_t i = 0; i < values.size(); ++i) {
    if (!(weights[i] > 0)) continue;
    order.push_back(i);
    total += static_cast<double>(weights[i]);
  }
  std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
    return values[a] != values[b] ? values[a] < values[b] : a < b;
  });
  std::vector<float> results;
  for (const double share : shares) {
    double below = 0;
    std::size_t i = 0;
    while (i + 1 < order.size() && (below += static_cast<double>(weights[order[i]])) <= share * total) ++i;
    results.push_back(order.empty() ? 0.0f : values[order[i]]);
  }
  return results;
}

Statistics statistics(std::span<const float> values, std::span<const float> weights) {
  Statistics s;
  double total = 0;
  bool first = true;
  for (std::size_t i = 0; i < values.size(); ++i) {
    const auto w = static_cast<double>(weights[i]), x = static_cast<double>(values[i]);
    if (!(w > 0)) continue;
    s.least = first ? x : std::min(s.least, x);
    s.greatest = first ? x : std::max(s.greatest, x);
    first = false;
    s.mean += w * x;
    total += w;
  }
  if (first) return s;
  s.mean /= total;
  for (std::size_t i = 0; i < values.size(); ++i) {
    const double d = static_cast<double>(values[i]) - s.mean;
    if (weights[i] > 0) s.deviation += static_cast<double>(weights[i]) * d * d;
  }
  s.deviation = std::sqrt(s.deviation / total);
  const double shares[] = {0.25, 0.5, 0.75};
  const std::vector<float> quartiles = percentiles(values, weights, shares);
  s.quarter = static_cast<double>(quartiles[0]);
  s.median = static_cast<double>(quartiles[1]);
  s.three_quarters = static_cast<double>(quartiles[2]);
  return s;
}

}  // namespace fovea
