#include "fovea/judge/surface_distance.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "fovea/base/parallel.h"
#include "fovea/base/random.h"

namespace fovea {

namespace {

constexpr std::size_t kGrain = 1024;

std::vector<double> distances(const std::vector<Vec3d>& points, const ClosestPoint& surface,
                              const Context& context) {
  std::vector<double> result(points.size());
  parallel_for_or_throw(context, points.size(), kGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) result[i] = surface.nearest(points[i]).distance;
  });
  return result;
}

Deviation deviation(const Surface& from, const ClosestPoint& to, std::int64_t samples,
                    const Context& context) {
  Deviation result;
  const std::vector<double> spread = distances(sample_surface(from, samples, context.seed), to, context);
  double sum = 0, squares = 0;
  for (const double d : spread) {
    sum += d;
    squares += d * d;
    result.max = std::max(result.max, d);
  }
  if (!spread.empty()) {
    result.mean = sum / static_cast<double>(spread.size());
    result.rms = std::sqrt(squares / static_cast<double>(spread.size()));
  }
  std::vector<bool> used(from.positions.size());
  for (const auto& t : from.triangles) {
    for (const std::uint32_t v : t) used[v] = true;
  }
  std::vector<Vec3d> vertices;
  for (std::size_t v = 0; v < used.size(); ++v) {
    if (used[v]) vertices.emplace_back(from.positions[v]);
  }
  for (const double d : distances(vertices, to, context)) result.max = std::max(result.max, d);
  return result;
}

}  // namespace

std::vector<SurfaceSample> surface_samples(const Surface& surface, std::int64_t count, std::uint64_t seed) {
  std::vector<double> area_before{0};
  const auto at = [&](std::uint32_t v) { return Vec3d(surface.positions[v]); };
  for (const auto& t : surface.triangles) {
    area_before.push_back(area_before.back() + triangle_area(at(t[0]), at(t[1]), at(t[2])));
  }
  std::vector<SurfaceSample> samples;
  if (!(area_before.back() > 0)) return samples;
  Random random(seed);
  std::size_t triangle = 0;
  for (std::int64_t i = 0; i < count; ++i) {
    const double place =
        (static_cast<double>(i) + random.uniform()) / static_cast<double>(count) * area_before.back();
    while (triangle + 1 < surface.triangles.size() && area_before[triangle + 1] <= place) ++triangle;
    // Uniform in the triangle (Turk 1990).
    const double r = std::sqrt(random.uniform()), s = random.uniform();
    samples.push_back({static_cast<std::uint32_t>(triangle), {1 - r, r * (1 - s), r * s}});
  }
  return samples;
}

std::vector<Vec3d> sample_surface(const Surface& surface, std::int64_t count, std::uint64_t seed) {
  std::vector<Vec3d> points;
  for (const SurfaceSample& sample : surface_samples(surface, count, seed))
    points.push_back(sample.on(surface));
  return points;
}

SurfaceDistance surface_distance(const Surface& reference, const Surface& test, std::int64_t samples,
                                 const Context& context) {
  SurfaceDistance result;
  if (reference.triangles.empty() || test.triangles.empty()) {
    if (reference.triangles.empty() && test.triangles.empty()) return result;
    constexpr double kInfinite = std::numeric_limits<double>::infinity();
    result.forward = result.backward = {kInfinite, kInfinite, kInfinite};
    return result;
  }
  const ClosestPoint to_reference(reference), to_test(test);
  result.forward = deviation(reference, to_test, samples, context);
  result.backward = deviation(test, to_reference, samples, context);
  return result;
}

}  // namespace fovea
