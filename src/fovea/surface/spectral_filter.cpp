#include "fovea/surface/spectral_filter.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "fovea/base/float4.h"
#include "fovea/base/parallel.h"
#include "fovea/surface/curvature.h"

namespace fovea {

namespace {

constexpr std::size_t kFilterGrain = 1 << 13;
/// The Laplacian takes no vertex away faster than this over the mean area of a vertex; a regular one does
/// with 3.5.
constexpr double kFastest = 20;
/// Nor faster than this over the square of the diagonal: what has next to no area is not looked at more
/// closely.
constexpr double kMostDetail = 1e9;
/// What the terms that are left out add up to.
constexpr double kPrecision = 1e-6;
/// Of the integral over a disc.
constexpr int kRings = 200;

/// Fields that flow together, one in each lane of a vector register.
constexpr std::size_t kLanes = 4;
float lane(float x, std::size_t) { return x; }
float lane(Float4 x, std::size_t i) { return x[i]; }
void set_lane(float& x, std::size_t, float value) { x = value; }
void set_lane(Float4& x, std::size_t i, float value) { x[i] = value; }

/// Cotangent of the angle at p between a and b, at least 0; 0 in triangles without area.
double cotangent(Vec3d p, Vec3d a, Vec3d b) {
  const double area = length(cross(a - p, b - p));
  return area > 0 ? std::max(dot(a - p, b - p) / area, 0.0) : 0;
}

/// Bessel functions of the first kind at z > 0, of the orders from 0 until they are nothing, by Miller's
/// recurrence downwards: J_k−1 = 2k / z J_k − J_k+1, scaled so that J_0 + 2 Σ J_2k is 1.
std::vector<double> bessel(double z) {
  const auto start = static_cast<std::size_t>(30 + z + 10 * std::cbrt(z));  // beyond they fall fast
  std::vector<double> values(start + 1, 0);
  double above = 0, here = 1e-30, sum = 0;
  for (std::size_t k = start; k > 0; --k) {
    values[k] = here;
    if (k % 2 == 0) sum += 2 * here;
    const double below = 2 * static_cast<double>(k) / z * here - above;
    above = here;
    here = below;
    if (std::abs(here) < 1e200) continue;
    for (std::size_t i = k; i <= start; ++i) values[i] *= 1e-200;
    above *= 1e-200, here *= 1e-200, sum *= 1e-200;
  }
  values[0] = here;
  sum += here;
  for (double& value : values) value /= sum;
  return values;
}

/// The series from what stands for (−1)^k and, but for the first, 2; without its tail.
std::vector<double> finished(std::vector<double> series) {
  for (std::size_t k = 1; k < series.size(); ++k) series[k] *= k % 2 == 0 ? 2 : -2;
  double tail = 0;
  while (series.size() > 1 && tail + std::abs(series.back()) < kPrecision) {
    tail += std::abs(series.back());
    series.pop_back();
  }
  return series;
}

}  // namespace

Response gaussian_response(double sigma, double cutoff) {
  return [=](double greatest) {
    std::vector<double> series{0};
    double weights = 0;
    for (int i = 0; i < kRings; ++i) {
      const double r = cutoff * sigma * (i + 0.5) / kRings,
                   weight = r * std::exp(-r * r / (2 * sigma * sigma));
      const double z = std::sqrt(greatest) * r / 2;
      const std::vector<double> ring = z > 0 ? bessel(z) : std::vector<double>{1};
      series.resize(std::max(series.size(), ring.size()), 0);
      for (std::size_t k = 0; k < ring.size(); ++k) series[k] += weight * ring[k] * ring[k];
      weights += weight;
    }
    for (double& x : series) x /= weights;
    return finished(std::move(series));
  };
}

SpectralFilter::SpectralFilter(const Surface& surface, const Adjacency& adjacency, const Context& context) {
  const std::size_t count = adjacency.vertex_count();
  first_.assign(count + 1, 0);
  for (std::uint32_t v = 0; v < count; ++v)
    first_[v + 1] = first_[v] + static_cast<std::uint32_t>(adjacency.neighbors(v).size());
  column_.resize(first_.back());
  rate_.resize(first_.back());
  leave_.assign(count, 0);
  areas_ = vertex_areas(surface, adjacency, context);
  double total = 0;
  std::size_t used = 0;
  for (const float area : areas_.values()) {
    total += static_cast<double>(area);
    used += area > 0;
  }
  const double d = diagonal(surface);
  const double fastest =
      total > 0 ? std::min(kFastest * static_cast<double>(used) / total, kMostDetail / (d * d)) : 1;
  parallel_for(context, count, kFilterGrain, [&](std::size_t begin, std::size_t end) {
    std::vector<double> weights;
    for (std::size_t i = begin; i < end; ++i) {
      const auto v = static_cast<std::uint32_t>(i);
      const std::span<const std::uint32_t> neighbors = adjacency.neighbors(v);
      weights.assign(neighbors.size(), 0);
      const auto add = [&](std::uint32_t w, double weight) {
        weights[static_cast<std::size_t>(std::lower_bound(neighbors.begin(), neighbors.end(), w) -
                                         neighbors.begin())] += weight / 2;
      };
      const Vec3d p = surface.position(v);
      for (const std::uint32_t c : adjacency.corners(v)) {
        const auto& t = surface.triangles[c / 3];
        const std::uint32_t a = t[(c + 1) % 3], b = t[(c + 2) % 3];
        const Vec3d pa = surface.position(a), pb = surface.position(b);
        add(a, cotangent(pb, p, pa));
        add(b, cotangent(pa, p, pb));
      }
      double sum = 0;
      for (const double weight : weights) sum += weight;
      const double area = std::max(static_cast<double>(areas_.values()[i]), sum / fastest);
      areas_.values()[i] = static_cast<float>(area);
      if (!(area > 0)) weights.assign(weights.size(), 0);
      sum = 0;
      for (std::size_t k = 0; k < neighbors.size(); ++k) {
        column_[first_[i] + k] = neighbors[k];
        rate_[first_[i] + k] = static_cast<float>(weights[k] / std::max(area, 1e-300));
        sum += static_cast<double>(rate_[first_[i] + k]);
      }
      leave_[i] = static_cast<float>(sum);
    }
  });
  // Gershgorin: a row's diagonal and the sum beside it.
  for (const float x : leave_) greatest_ = std::max(greatest_, 2 * static_cast<double>(x));
}

std::vector<std::vector<VertexField>> SpectralFilter::run(std::span<const VertexField> fields,
                                                          std::span<const Response> responses,
                                                          const Context& context) const {
  std::vector<std::vector<double>> series;
  for (const Response& response : responses) series.push_back(response(greatest_));
  std::vector<std::vector<VertexField>> results(
      fields.size(), std::vector<VertexField>(series.size(), VertexField(leave_.size())));
  const std::span<std::vector<VertexField>> all = results;
  if (fields.size() == 1) {
    run_together<float>(fields, series, all, context);
    return results;
  }
  for (std::size_t i = 0; i < fields.size(); i += kLanes) {
    const std::size_t count = std::min(kLanes, fields.size() - i);
    run_together<Float4>(fields.subspan(i, count), series, all.subspan(i, count), context);
  }
  return results;
}

/// All responses are sums of the same T_k(X) f, with X = 2 A / greatest − 1 and A the matrix of rates.
template <class Number>
void SpectralFilter::run_together(std::span<const VertexField> fields,
                                  std::span<const std::vector<double>> series,
                                  std::span<std::vector<VertexField>> results, const Context& context) const {
  const std::size_t count = leave_.size(), response_count = series.size();
  // The longest series first, so that those still going stand together.
  std::vector<std::size_t> order(response_count);
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return series[a].size() > series[b].size(); });
  std::vector<Number> before(count), now(count), sums(count * response_count);
  for (std::size_t v = 0; v < count; ++v) {
    for (std::size_t f = 0; f < fields.size(); ++f) set_lane(now[v], f, fields[f].values()[v]);
    for (std::size_t i = 0; i < response_count; ++i)
      sums[v * response_count + i] = static_cast<float>(series[order[i]][0]) * now[v];
  }
  before = now;
  const auto scale = static_cast<float>(2 / greatest_);
  std::vector<float> coefficients;
  const std::size_t terms = series.empty() ? 0 : series[order[0]].size();
  for (std::size_t k = 1; k < terms; ++k) {
    coefficients.clear();
    for (const std::size_t i : order) {
      if (k < series[i].size()) coefficients.push_back(static_cast<float>(series[i][k]));
    }
    // T_1 = X f, T_k+1 = 2 X T_k − T_k−1; the new one takes the place of the oldest.
    const float factor = k == 1 ? 1.0f : 2.0f, subtract = k == 1 ? 0.0f : 1.0f;
    parallel_for_or_throw(context, count, kFilterGrain, [&](std::size_t begin, std::size_t end) {
      for (std::size_t v = begin; v < end; ++v) {
        Number flow = leave_[v] * now[v];
        for (std::uint32_t i = first_[v]; i < first_[v + 1]; ++i) flow -= rate_[i] * now[column_[i]];
        const Number next = factor * (scale * flow - now[v]) - subtract * before[v];
        before[v] = next;
        Number* sum = sums.data() + v * response_count;
        for (const float coefficient : coefficients) *sum++ += coefficient * next;
      }
    });
    std::swap(before, now);
  }
  for (std::size_t f = 0; f < fields.size(); ++f) {
    for (std::size_t i = 0; i < response_count; ++i) {
      const std::span<float> result = results[f][order[i]].values();
      for (std::size_t v = 0; v < count; ++v)  // what nothing reaches stays to the bit
        result[v] = leave_[v] > 0 ? lane(sums[v * response_count + i], f) : fields[f].values()[v];
    }
  }
}

}  // namespace fovea
