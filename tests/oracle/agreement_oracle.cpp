#include "oracle/agreement_oracle.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <vector>

namespace fovea::test {

namespace {

using Values = std::vector<double>;
using Test = std::function<bool(std::size_t)>;

/// All elements by their area.
class Areas {
 public:
  explicit Areas(std::span<const float> areas) : areas_(areas.begin(), areas.end()) {}

  double where(const Test& test) const {
    double sum = 0;
    for (std::size_t i = 0; i < areas_.size(); ++i) {
      if (test(i)) sum += areas_[i];
    }
    return sum;
  }
  double mean(const std::function<double(std::size_t)>& value) const {
    double sum = 0;
    for (std::size_t i = 0; i < areas_.size(); ++i) sum += areas_[i] * value(i);
    return sum / where([](std::size_t) { return true; });
  }
  double variance(const Values& x) const {
    const double m = mean([&](std::size_t i) { return x[i]; });
    return mean([&](std::size_t i) { return (x[i] - m) * (x[i] - m); });
  }
  double pearson(const Values& x, const Values& y) const {
    const double mx = mean([&](std::size_t i) { return x[i]; }),
                 my = mean([&](std::size_t i) { return y[i]; });
    const double covariance = mean([&](std::size_t i) { return (x[i] - mx) * (y[i] - my); });
    return covariance / std::sqrt(variance(x) * variance(y));
  }
  Values ranks(const Values& x) const {
    Values result;
    for (const double v : x) {
      result.push_back(where([&](std::size_t j) { return x[j] < v; }) +
                       where([&](std::size_t j) { return x[j] == v; }) / 2);
    }
    return result;
  }
  double operator[](std::size_t i) const { return areas_[i]; }

 private:
  Values areas_;
};

double auc_by_pairs(const Values& predicted, const std::vector<bool>& fixated, const Areas& areas) {
  double won = 0, all = 0;
  for (std::size_t i = 0; i < predicted.size(); ++i) {
    for (std::size_t j = 0; j < predicted.size(); ++j) {
      if (!fixated[i] || fixated[j]) continue;
      all += areas[i] * areas[j];
      if (predicted[i] > predicted[j]) won += areas[i] * areas[j];
      if (predicted[i] == predicted[j]) won += areas[i] * areas[j] / 2;
    }
  }
  return won / all;
}

}  // namespace

Agreement agreement_by_pairs(std::span<const float> predicted, std::span<const float> observed,
                             std::span<const float> areas_in, double fixated_area) {
  const Values x(predicted.begin(), predicted.end()), y(observed.begin(), observed.end());
  const Areas areas(areas_in);
  std::vector<bool> fixated;
  for (const double v : y) {
    const double larger = areas.where([&](std::size_t j) { return y[j] > v; });
    fixated.push_back(v > 0 && larger < fixated_area * areas.where([&](std::size_t j) { return y[j] > 0; }));
  }
  Agreement result;
  result.correlation = areas.pearson(x, y);
  result.spearman = areas.pearson(areas.ranks(x), areas.ranks(y));
  result.auc = auc_by_pairs(x, fixated, areas);
  const double mean_x = areas.mean([&](std::size_t i) { return x[i]; }),
               deviation = std::sqrt(areas.variance(x));
  const double inside = areas.mean([&](std::size_t i) { return fixated[i] ? 1 : 0; });
  result.nss =
      areas.mean([&](std::size_t i) { return fixated[i] ? (x[i] - mean_x) / deviation : 0; }) / inside;

  const double low = std::min(0.0, *std::min_element(x.begin(), x.end()));
  const double sum_x = areas.mean([&](std::size_t i) { return x[i] - low; }),
               sum_y = areas.mean([&](std::size_t i) { return y[i]; });
  constexpr double kEpsilon = 0x1p-52;
  result.kl = areas.mean([&](std::size_t i) {
    const double p = y[i] / sum_y, q = (x[i] - low) / sum_x;
    return p * std::log(kEpsilon + p / (q + kEpsilon));
  });
  result.similarity = areas.mean([&](std::size_t i) { return std::min(y[i] / sum_y, (x[i] - low) / sum_x); });
  return result;
}

}  // namespace fovea::test
