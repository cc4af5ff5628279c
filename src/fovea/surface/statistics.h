#pragma once

#include <span>
#include <vector>

namespace fovea {

/// The values below which the given shares (0 … 1) of all weight lie: each the least value of which more than
/// that share is at or below. [#shares]. 0 without weight. O(n log n).
std::vector<float> percentiles(std::span<const float> values, std::span<const float> weights,
                               std::span<const double> shares);

/// How values are spread, each counted by its weight.
struct Statistics {
  double least = 0, greatest = 0;  ///< Of those that count.
  double mean = 0, deviation = 0;
  double quarter = 0, median = 0, three_quarters = 0;
};
Statistics statistics(std::span<const float> values, std::span<const float> weights);

}  // namespace fovea
