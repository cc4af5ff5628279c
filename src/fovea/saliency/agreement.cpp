#include "fovea/saliency/agreement.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numeric>
#include <vector>

#include "fovea/base/error.h"

namespace fovea {

namespace {

using Numbers = std::vector<double>;

/// The elements that have area.
struct Maps {
  Numbers predicted, observed;
  Numbers areas;  // together 1
};

[[noreturn]] void refuse(const std::string& message) { throw Error(ErrorKind::usage, message); }

void check_numbers(std::span<const float> values, const char* what, bool may_be_negative) {
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (!std::isfinite(values[i])) refuse(fmt::format("{} {} is not a finite number", what, i));
    if (!may_be_negative && values[i] < 0) refuse(fmt::format("{} {} is negative", what, i));
  }
}

void check_input(std::span<const float> predicted, std::span<const float> observed,
                 std::span<const float> areas, const AgreementOptions& options) {
  if (predicted.size() != observed.size() || observed.size() != areas.size()) {
    refuse(fmt::format("{} predicted and {} observed values do not fit {} areas", predicted.size(),
                       observed.size(), areas.size()));
  }
  check_numbers(predicted, "predicted value", true);
  check_numbers(observed, "observed value", false);
  check_numbers(areas, "area", false);
  if (!(options.fixated_area > 0 && options.fixated_area <= 1))
    refuse("the share of the area that is fixated is not in (0, 1]");
}

Maps maps_with_area(std::span<const float> predicted, std::span<const float> observed,
                    std::span<const float> areas) {
  Maps maps;
  for (std::size_t i = 0; i < areas.size(); ++i) {
    if (!(areas[i] > 0)) continue;
    maps.predicted.push_back(static_cast<double>(predicted[i]));
    maps.observed.push_back(static_cast<double>(observed[i]));
    maps.areas.push_back(static_cast<double>(areas[i]));
  }
  if (std::none_of(maps.observed.begin(), maps.observed.end(), [](double x) { return x > 0; }))
    refuse("nothing was observed: all values are 0 where there is area");
  const double whole = std::accumulate(maps.areas.begin(), maps.areas.end(), 0.0);
  for (double& a : maps.areas) a /= whole;
  return maps;
}

/// ∫ x, and ∫ x y.
double integral(const Numbers& x, const Numbers& areas) {
  return std::inner_product(x.begin(), x.end(), areas.begin(), 0.0);
}
double integral(const Numbers& x, const Numbers& y, const Numbers& areas) {
  double sum = 0;
  for (std::size_t i = 0; i < x.size(); ++i) sum += areas[i] * x[i] * y[i];
  return sum;
}

/// With mean 0 and standard deviation 1; all 0 if constant.
Numbers standardized(const Numbers& x, const Numbers& areas) {
  Numbers result(x.size(), 0.0);
  const auto [low, high] = std::minmax_element(x.begin(), x.end());
  if (*low == *high) return result;
  const double mean = integral(x, areas);
  for (std::size_t i = 0; i < x.size(); ++i) result[i] = x[i] - mean;
  const double deviation = std::sqrt(integral(result, result, areas));
  for (double& r : result) r = deviation > 0 ? r / deviation : 0;
  return result;
}

/// Calls f(elements) for each distinct value of x, rising.
template <class F>
void for_each_value(const Numbers& x, F&& f) {
  std::vector<std::size_t> order(x.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(),
            [&](std::size_t a, std::size_t b) { return x[a] != x[b] ? x[a] < x[b] : a < b; });
  for (std::size_t begin = 0, end = 0; begin < order.size(); begin = end) {
    while (end < order.size() && x[order[end]] == x[order[begin]]) ++end;
    f(std::span<const std::size_t>(order).subspan(begin, end - begin));
  }
}

double area_of(std::span<const std::size_t> elements, const Numbers& areas) {
  double sum = 0;
  for (const std::size_t i : elements) sum += areas[i];
  return sum;
}

/// The area of smaller values and half of that of equal ones.
Numbers ranks(const Numbers& x, const Numbers& areas) {
  Numbers result(x.size());
  double below = 0;
  for_each_value(x, [&](std::span<const std::size_t> equal) {
    const double area = area_of(equal, areas);
    for (const std::size_t i : equal) result[i] = below + area / 2;
    below += area;
  });
  return result;
}

double correlation(const Numbers& x, const Numbers& y, const Numbers& areas) {
  return std::clamp(integral(standardized(x, areas), standardized(y, areas), areas), -1.0, 1.0);
}

/// 1 where fixated, else 0.
Numbers fixations(const Numbers& observed, const Numbers& areas, double share) {
  Numbers falling(observed.size());  // its negative: the largest come first
  double looked_at = 0;
  for (std::size_t i = 0; i < observed.size(); ++i) {
    falling[i] = -observed[i];
    if (observed[i] > 0) looked_at += areas[i];
  }
  // An area that is meant to be the share exactly is not missed by its last bits.
  const double enough = looked_at * share * (1 - 1e-9);
  Numbers fixated(observed.size(), 0.0);
  double area = 0;
  for_each_value(falling, [&](std::span<const std::size_t> equal) {
    if (area >= enough) return;
    for (const std::size_t i : equal) fixated[i] = 1;
    area += area_of(equal, areas);
  });
  return fixated;
}

/// The area under the curve by ranks (Mann and Whitney): the mean rank of what is fixated, less the rank that
/// it has among itself.
double area_under_curve(const Numbers& predicted, const Numbers& fixated, const Numbers& areas) {
  double inside = 0, outside = 0;
  for (std::size_t i = 0; i < areas.size(); ++i) (fixated[i] > 0 ? inside : outside) += areas[i];
  if (!(outside > 0)) return 0.5;
  const double mean_rank = integral(ranks(predicted, areas), fixated, areas) / inside;
  return std::clamp((mean_rank - inside / 2) / outside, 0.0, 1.0);
}

/// Not negative, with mean 1.
Numbers density(Numbers x, const Numbers& areas) {
  const double low = std::min(0.0, *std::min_element(x.begin(), x.end()));
  for (double& v : x) v -= low;
  const double mean = integral(x, areas);
  for (double& v : x) v = mean > 0 ? v / mean : 1;
  return x;
}

double divergence(const Numbers& p, const Numbers& q, const Numbers& areas) {
  constexpr double kEpsilon = std::numeric_limits<double>::epsilon();
  double sum = 0;
  for (std::size_t i = 0; i < p.size(); ++i)
    sum += areas[i] * p[i] * std::log(kEpsilon + p[i] / (q[i] + kEpsilon));
  return sum;
}

double intersection(const Numbers& p, const Numbers& q, const Numbers& areas) {
  double sum = 0;
  for (std::size_t i = 0; i < p.size(); ++i) sum += areas[i] * std::min(p[i], q[i]);
  return sum;
}

}  // namespace

Agreement agreement(std::span<const float> predicted, std::span<const float> observed,
                    std::span<const float> areas, const AgreementOptions& options) {
  check_input(predicted, observed, areas, options);
  const Maps maps = maps_with_area(predicted, observed, areas);
  const Numbers fixated = fixations(maps.observed, maps.areas, options.fixated_area);
  const Numbers p = density(maps.observed, maps.areas), q = density(maps.predicted, maps.areas);
  Agreement result;
  result.correlation = correlation(maps.predicted, maps.observed, maps.areas);
  result.spearman =
      correlation(ranks(maps.predicted, maps.areas), ranks(maps.observed, maps.areas), maps.areas);
  result.auc = area_under_curve(maps.predicted, fixated, maps.areas);
  result.nss =
      integral(standardized(maps.predicted, maps.areas), fixated, maps.areas) / integral(fixated, maps.areas);
  result.kl = divergence(p, q, maps.areas);
  result.similarity = intersection(p, q, maps.areas);
  return result;
}

}  // namespace fovea
