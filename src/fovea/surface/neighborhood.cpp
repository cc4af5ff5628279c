#include "fovea/surface/neighborhood.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "fovea/base/error.h"
#include "fovea/base/parallel.h"
#include "fovea/surface/curvature.h"
#include "fovea/surface/geodesic.h"
#include "fovea/surface/spectral_filter.h"
#include "fovea/surface/sphere_sums.h"

namespace fovea {

namespace {

/// Vertices whose neighbourhoods one thread finds together: few, as some meshes are a hundred times as dense
/// in places, and not fewer, as a geodesic search has arrays of the size of the mesh.
constexpr std::size_t kSearchGrain = 1 << 9;
/// More weight to the area than this many times the mean, or less than one part in it, the filter does not
/// tell apart.
constexpr double kMostDensity = 100;
constexpr float kLeastDensity = 0.01f;

/// exp(−x / 2) for x up to a limit, by a table: to 10⁻⁷.
class Gaussian {
 public:
  explicit Gaussian(double limit) : steps_per_unit_(kSteps / limit), values_(kSteps + 2) {
    for (std::size_t i = 0; i < values_.size(); ++i)
      values_[i] = std::exp(-0.5 * static_cast<double>(i) / steps_per_unit_);
  }
  double operator()(double x) const {
    const double at = x * steps_per_unit_;
    const auto i = static_cast<std::size_t>(at);
    return values_[i] + (at - static_cast<double>(i)) * (values_[i + 1] - values_[i]);
  }

 private:
  static constexpr std::size_t kSteps = 1 << 12;
  double steps_per_unit_;
  std::vector<double> values_;
};

/// What vertices count for: a few sets, and which of them each field is averaged by.
struct Weights {
  std::vector<VertexField> sets;
  std::vector<std::size_t> set_of;  ///< [#fields]
};

/// Two numbers that are worked on as one.
using Double2 [[gnu::vector_size(16)]] = double;

/// The fields at a vertex or between vertices, each times its weight, then the weights, then perhaps a 0.
/// [(#fields + #sets) / 2, rounded up]
using Sample = std::span<const Double2>;
std::size_t width(const Weights& weights) { return (weights.set_of.size() + weights.sets.size() + 1) / 2; }
double number(Sample sample, std::size_t i) { return sample[i / 2][i % 2]; }

/// The averages at one vertex, of neighbours that come one by one.
class Averager {
 public:
  Averager(std::span<const double> sigmas, double cutoff, const Weights& weights)
      : cutoff2_(cutoff * cutoff),
        weights_(weights),
        width_(width(weights)),
        gaussian_(cutoff2_),
        sums_(sigmas.size() * width_) {
    for (const double sigma : sigmas) precisions_.push_back(1 / (sigma * sigma));
  }
  void start() { std::fill(sums_.begin(), sums_.end(), Double2{}); }
  /// To all scales that reach as far.
  void add(double distance2, Sample sample) {
    for (std::size_t i = precisions_.size(); i > 0; --i) {
      const double x = distance2 * precisions_[i - 1];
      if (x > cutoff2_) return;  // nor the smaller ones
      add(i - 1, gaussian_(x), sample);
    }
  }
  /// To one scale, however far.
  void add_beyond(std::size_t scale, double distance2, Sample sample) {
    add(scale, std::exp(-0.5 * distance2 * precisions_[scale]), sample);
  }
  /// What has been added up elsewhere, [#scales][#fields + #sets].
  void add(const std::vector<double>& sums) {
    const std::size_t numbers = sums.size() / precisions_.size();
    for (std::size_t i = 0; i < sums.size(); ++i) {
      const std::size_t n = i % numbers;
      sums_[i / numbers * width_ + n / 2][n % 2] += sums[i];
    }
  }
  double average(std::size_t field, std::size_t scale) const {
    const Sample sums(sums_.data() + scale * width_, width_);
    return number(sums, field) / number(sums, weights_.set_of.size() + weights_.set_of[field]);
  }

 private:
  void add(std::size_t scale, double weight, Sample sample) {
    Double2* const sums = sums_.data() + scale * width_;
    for (std::size_t i = 0; i < width_; ++i) sums[i] += weight * sample[i];
  }

  double cutoff2_;
  const Weights& weights_;
  std::size_t width_;
  Gaussian gaussian_;
  std::vector<double> precisions_;  // [#scales], 1 / σ²
  std::vector<Double2> sums_;       // [#scales][width]
};

/// The samples at the vertices.
class Samples {
 public:
  Samples(std::span<const VertexField> fields, const Weights& weights)
      : width_(fovea::width(weights)), numbers_(fields.size() + weights.sets.size()) {
    const std::size_t count = weights.sets[0].size();
    values_.resize(count * width_, Double2{});
    // What counts for nothing still counts where there is nothing else.
    const auto weight = [&](std::size_t set, std::size_t v) {
      return static_cast<double>(std::max(weights.sets[set].values()[v], std::numeric_limits<float>::min()));
    };
    for (std::size_t v = 0; v < count; ++v) {
      Double2* const sample = values_.data() + v * width_;
      for (std::size_t f = 0; f < fields.size(); ++f)
        sample[f / 2][f % 2] = weight(weights.set_of[f], v) * static_cast<double>(fields[f].values()[v]);
      for (std::size_t set = 0, i = fields.size(); set < weights.sets.size(); ++set, ++i)
        sample[i / 2][i % 2] = weight(set, v);
    }
  }
  Sample operator[](std::size_t v) const { return {values_.data() + v * width_, width_}; }
  std::size_t width() const { return width_; }
  /// One by one, [#fields + #sets][#V].
  std::vector<std::vector<float>> columns() const {
    std::vector<std::vector<float>> columns(numbers_);
    for (std::size_t n = 0; n < numbers_; ++n) {
      for (std::size_t i = 0; i < values_.size(); i += width_)
        columns[n].push_back(static_cast<float>(number({values_.data() + i, width_}, n)));
    }
    return columns;
  }

 private:
  std::size_t width_, numbers_;
  std::vector<Double2> values_;  // [#V][width]
};

/// What the local filter window has beyond the sphere: the neighbours outside, and where the edges to them
/// cross the sphere.
class WindowRim {
 public:
  WindowRim(const Surface& surface, const Adjacency& adjacency, const Samples& samples,
            std::span<const double> sigmas, double cutoff)
      : surface_(surface), adjacency_(adjacency), samples_(samples), mean_(samples.width()) {
    for (const double sigma : sigmas) radii_.push_back(cutoff * sigma);
    double sum = 0, count = 0;
    for (std::uint32_t v = 0; v < adjacency.vertex_count(); ++v) {
      for (const std::uint32_t w : adjacency.neighbors(v)) {
        sum += length(surface.position(w) - surface.position(v));
        ++count;
      }
    }
    mean_edge_ = sum > 0 ? sum / count : 1;
  }

  void add(std::uint32_t v, Averager& averager) {
    const Vec3d p = surface_.position(v);
    for (const std::uint32_t w : adjacency_.neighbors(v)) {
      const double d2 = length_squared(surface_.position(w) - p);
      for (std::size_t scale = 0; scale < radii_.size() && d2 > radii_[scale] * radii_[scale]; ++scale) {
        averager.add_beyond(scale, d2, samples_[w]);
        add_crossing(v, w, scale, averager);
      }
    }
  }

 private:
  static constexpr std::array<double, 4> kFalls{1, 1.2, 1.5, 2};

  void add_crossing(std::uint32_t v, std::uint32_t w, std::size_t scale, Averager& averager) {
    const Vec3d p = surface_.position(v), q = surface_.position(w);
    const Vec3d straight = p + (q - p) * (radii_[scale] / length(q - p));
    std::fill(mean_.begin(), mean_.end(), Double2{});
    double sum = 0;
    Vec3d point;
    const auto add = [&](std::uint32_t x) {
      const Vec3d at = surface_.position(x);
      const double share = std::exp(-kFalls[std::min(scale, kFalls.size() - 1)] *
                                    length_squared(at - straight) / (mean_edge_ * mean_edge_));
      const Sample sample = samples_[x];
      sum += share;
      point = point + at * share;
      for (std::size_t i = 0; i < mean_.size(); ++i) mean_[i] += share * sample[i];
    };
    add(v);
    add(w);
    for (const std::uint32_t c : adjacency_.corners(v)) {
      const auto& t = surface_.triangles[c / 3];
      const std::uint32_t a = t[(c + 1) % 3], b = t[(c + 2) % 3];
      if (a == w) add(b);
      if (b == w) add(a);
    }
    if (!(sum > 0)) return;  // all are many edges away
    for (Double2& x : mean_) x /= sum;
    averager.add_beyond(scale, length_squared(point / sum - p), mean_);
  }

  const Surface& surface_;
  const Adjacency& adjacency_;
  const Samples& samples_;
  std::vector<double> radii_;
  double mean_edge_ = 1;
  std::vector<Double2> mean_;  // the sample at the crossing at hand
};

/// What vertices count for over what the filter counts them for, in units of its mean and within bounds.
VertexField relative_weights(const VertexField& areas, const VertexField& weights) {
  double area = 0, weight = 0;
  for (std::size_t v = 0; v < areas.size(); ++v) {
    if (!(areas.values()[v] > 0)) continue;
    area += static_cast<double>(areas.values()[v]);
    weight += static_cast<double>(weights.values()[v]);
  }
  VertexField densities(areas.size(), 1.0f);
  if (!(weight > 0)) return densities;  // nothing counts more than another
  for (std::size_t v = 0; v < areas.size(); ++v) {
    if (!(areas.values()[v] > 0)) continue;
    const double density = static_cast<double>(weights.values()[v]) / static_cast<double>(areas.values()[v]);
    densities.values()[v] =
        static_cast<float>(std::clamp(density * area / weight, 1 / kMostDensity, kMostDensity));
  }
  return densities;
}

/// Least and greatest value where there is area.
std::pair<float, float> range(const VertexField& field, const VertexField& areas) {
  float low = std::numeric_limits<float>::infinity(), high = -low;
  for (std::size_t v = 0; v < field.size(); ++v) {
    if (!(areas.values()[v] > 0)) continue;
    low = std::min(low, field.values()[v]);
    high = std::max(high, field.values()[v]);
  }
  return {low, high};
}

/// An empty set of weights is the area that the filter counts by itself.
std::vector<std::vector<VertexField>> filtered(const Surface& surface, const Adjacency& adjacency,
                                               std::span<const VertexField> fields,
                                               std::span<const double> sigmas, double cutoff,
                                               const Weights& weights, const Context& context) {
  std::vector<Response> responses;
  for (const double sigma : sigmas) responses.push_back(gaussian_response(sigma, cutoff));
  const SpectralFilter filter(surface, adjacency, context);
  const VertexField& areas = filter.areas();
  std::vector<VertexField> dense(fields.begin(), fields.end());
  std::vector<std::size_t> density_of(weights.sets.size(), 0);  // 0: none
  for (std::size_t set = 0; set < weights.sets.size(); ++set) {
    if (weights.sets[set].empty()) continue;
    const VertexField density = relative_weights(areas, weights.sets[set]);
    for (std::size_t f = 0; f < fields.size(); ++f) {
      if (weights.set_of[f] != set) continue;
      for (std::size_t v = 0; v < areas.size(); ++v) dense[f].values()[v] *= density.values()[v];
    }
    density_of[set] = dense.size();
    dense.push_back(density);
  }
  std::vector<std::vector<VertexField>> results = filter.run(dense, responses, context);
  for (std::size_t f = 0; f < fields.size(); ++f) {
    const std::size_t density = density_of[weights.set_of[f]];
    const auto [low, high] = range(fields[f], areas);
    for (std::size_t i = 0; i < sigmas.size(); ++i) {
      for (std::size_t v = 0; v < areas.size(); ++v) {
        if (!(areas.values()[v] > 0)) continue;
        float& x = results[f][i].values()[v];
        if (density > 0) x /= std::max(results[density][i].values()[v], kLeastDensity);
        x = std::clamp(x, low, high);
      }
    }
  }
  results.resize(fields.size());
  return results;
}

/// What vertices count for if nothing else is given; empty if that is the area that the filter counts.
VertexField own_weights(const Surface& surface, const Adjacency& adjacency, const Neighborhood& neighborhood,
                        const Context& context) {
  if (neighborhood.weight == VertexWeight::one) return VertexField(surface.positions.size(), 1.0f);
  if (neighborhood.distance == DistanceKind::diffusion) return {};
  return vertex_areas(surface, adjacency, context);
}

/// Those given for each field, or `own`; equal ones once.
Weights merged(std::size_t fields, std::span<const VertexField> given, const VertexField& own) {
  Weights weights;
  for (std::size_t f = 0; f < fields; ++f) {
    const VertexField& wanted = f < given.size() && !given[f].empty() ? given[f] : own;
    const auto known = std::find(weights.sets.begin(), weights.sets.end(), wanted);
    weights.set_of.push_back(static_cast<std::size_t>(known - weights.sets.begin()));
    if (known == weights.sets.end()) weights.sets.push_back(wanted);
  }
  return weights;
}

}  // namespace

std::vector<std::vector<VertexField>> gaussian_averages(const Surface& surface, const Adjacency& adjacency,
                                                        std::span<const VertexField> fields,
                                                        std::span<const double> sigmas,
                                                        const Neighborhood& neighborhood,
                                                        const Context& context,
                                                        std::span<const VertexField> weights) {
  const double cutoff = neighborhood.cutoff;
  const bool rising = std::is_sorted(sigmas.begin(), sigmas.end());
  if (sigmas.empty() || !rising || !(sigmas.front() > 0) || !(cutoff > 0))
    throw Error(ErrorKind::usage, "widths of averages must rise from above 0");
  const Weights counted =
      merged(fields.size(), weights, own_weights(surface, adjacency, neighborhood, context));
  if (neighborhood.distance == DistanceKind::diffusion)
    return filtered(surface, adjacency, fields, sigmas, cutoff, counted, context);
  const double radius = cutoff * sigmas.back();
  const std::size_t count = surface.positions.size();
  std::vector<std::vector<VertexField>> results(fields.size(),
                                                std::vector<VertexField>(sigmas.size(), VertexField(count)));
  if (count == 0 || fields.empty()) return results;
  const Samples samples(fields, counted);
  const auto run = [&](auto&& make_search) {
    parallel_for_or_throw(context, count, kSearchGrain, [&](std::size_t begin, std::size_t end) {
      auto search = make_search();
      Averager averager(sigmas, cutoff, counted);
      for (std::size_t v = begin; v < end; ++v) {
        const auto vertex = static_cast<std::uint32_t>(v);
        const bool alone = adjacency.corners(vertex).empty();
        averager.start();
        if (!alone) search(vertex, averager);
        for (std::size_t f = 0; f < fields.size(); ++f) {
          for (std::size_t i = 0; i < sigmas.size(); ++i)
            results[f][i].values()[v] =
                alone ? fields[f].values()[v] : static_cast<float>(averager.average(f, i));
        }
      }
    });
  };
  if (neighborhood.distance == DistanceKind::geodesic) {
    const GeodesicSurface prepared(surface, adjacency, context);
    run([&] {
      return [&, search = GeodesicSearch(prepared)](std::uint32_t v, Averager& averager) mutable {
        for (const auto& [w, distance] : search.from(v, radius))
          averager.add(distance * distance, samples[w]);
      };
    });
    return results;
  }
  const SphereSums spheres(surface, adjacency, samples.columns(), sigmas, cutoff);
  const auto add_sphere = [&, sums = std::vector<double>()](std::uint32_t v, Averager& averager) mutable {
    spheres.around(v, sums);
    averager.add(sums);
  };
  if (neighborhood.distance == DistanceKind::euclidean) {
    run([&] { return add_sphere; });
  } else {
    const WindowRim window(surface, adjacency, samples, sigmas, cutoff);
    run([&] {
      return [sphere = add_sphere, rim = window](std::uint32_t v, Averager& averager) mutable {
        sphere(v, averager);
        rim.add(v, averager);
      };
    });
  }
  return results;
}

}  // namespace fovea
