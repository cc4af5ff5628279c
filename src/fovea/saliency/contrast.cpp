#include "fovea/saliency/contrast.h"

#include <algorithm>
#include <cmath>

namespace fovea {

std::vector<std::vector<VertexField>> center_surround(const Surface& surface, const Adjacency& adjacency,
                                                      std::span<const VertexField> signals,
                                                      std::span<const ScalePair> pairs,
                                                      const Neighborhood& neighborhood,
                                                      const Context& context,
                                                      std::span<const VertexField> weights) {
  std::vector<double> widths;
  for (const ScalePair& pair : pairs) widths.insert(widths.end(), {pair.center, pair.surround});
  std::sort(widths.begin(), widths.end());
  widths.erase(std::unique(widths.begin(), widths.end()), widths.end());
  const auto averages =
      gaussian_averages(surface, adjacency, signals, widths, neighborhood, context, weights);
  const auto number = [&](double width) {
    return static_cast<std::size_t>(std::lower_bound(widths.begin(), widths.end(), width) - widths.begin());
  };
  std::vector<std::vector<VertexField>> contrasts(signals.size());
  for (std::size_t i = 0; i < signals.size(); ++i) {
    for (const ScalePair& pair : pairs) {
      const std::span<const float> center = averages[i][number(pair.center)].values(),
                                   surround = averages[i][number(pair.surround)].values();
      VertexField& contrast = contrasts[i].emplace_back(center.size());
      for (std::size_t v = 0; v < center.size(); ++v)
        contrast.values()[v] = std::abs(center[v] - surround[v]);
    }
  }
  return contrasts;
}

VertexField promote_peaks(const VertexField& field, const Adjacency& adjacency) {
  const std::span<const float> values = field.values();
  VertexField result(field.size());
  if (field.empty()) return result;
  const auto [low, high] = std::minmax_element(values.begin(), values.end());
  const double least = static_cast<double>(*low), range = static_cast<double>(*high) - least;
  if (!(range > 0)) return result;
  const auto highest = static_cast<std::uint32_t>(high - values.begin());
  double sum = 0;
  std::size_t count = 0;
  for (std::uint32_t v = 0; v < values.size(); ++v) {
    const std::span<const std::uint32_t> neighbors = adjacency.neighbors(v);
    if (v == highest || neighbors.empty()) continue;
    if (!std::all_of(neighbors.begin(), neighbors.end(),
                     [&](std::uint32_t w) { return values[v] > values[w]; }))
      continue;
    sum += (static_cast<double>(values[v]) - least) / range;
    ++count;
  }
  const double mean = count > 0 ? sum / static_cast<double>(count) : 0,
               factor = (1 - mean) * (1 - mean) / range;
  for (std::size_t v = 0; v < values.size(); ++v)
    result.values()[v] = static_cast<float>((static_cast<double>(values[v]) - least) * factor);
  return result;
}

}  // namespace fovea
