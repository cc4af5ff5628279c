#include "fovea/sample/curve.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace fovea::sample {

namespace {

constexpr int kStepsPerUnit = 64;  // Fine enough that chords stand for the curve.

double distance(Vec2d a, Vec2d b) { return std::hypot(a.x - b.x, a.y - b.y); }

Vec2d between(Vec2d a, Vec2d b, double ta, double tb, double t) {
  return tb > ta ? a * ((tb - t) / (tb - ta)) + b * ((t - ta) / (tb - ta)) : a;
}

}  // namespace

Curve::Curve(std::vector<Vec2d> points) : points_(std::move(points)) {}

Vec2d Curve::at(double t) const {
  const auto last = static_cast<double>(points_.size() - 1);
  const double start = std::clamp(std::floor(t), 0.0, std::max(0.0, last - 1));
  const auto i = static_cast<std::size_t>(start);
  if (t - start <= 0 || points_.size() < 2) return points_[i];
  if (t - start >= 1) return points_[i + 1];
  const Vec2d p1 = points_[i], p2 = points_[i + 1];
  const Vec2d p0 = i > 0 ? points_[i - 1] : p1 * 2.0 - p2;
  const Vec2d p3 = i + 2 < points_.size() ? points_[i + 2] : p2 * 2.0 - p1;
  const double t0 = 0, t1 = t0 + std::sqrt(distance(p0, p1)), t2 = t1 + std::sqrt(distance(p1, p2)),
               t3 = t2 + std::sqrt(distance(p2, p3));
  const double x = t1 + (t - start) * (t2 - t1);
  const Vec2d a1 = between(p0, p1, t0, t1, x), a2 = between(p1, p2, t1, t2, x),
              a3 = between(p2, p3, t2, t3, x);
  return between(between(a1, a2, t0, t2, x), between(a2, a3, t1, t3, x), t1, t2, x);
}

double Curve::length(double from, double to) const {
  const int steps = std::max(1, static_cast<int>(std::ceil((to - from) * kStepsPerUnit)));
  double sum = 0;
  for (int i = 0; i < steps; ++i) {
    sum += distance(at(from + (to - from) * i / steps), at(from + (to - from) * (i + 1) / steps));
  }
  return sum;
}

std::vector<Vec2d> Curve::even(double from, double to, int count) const {
  const int steps = std::max(count, static_cast<int>(std::ceil((to - from) * kStepsPerUnit)));
  const auto parameter = [&](double step) { return from + (to - from) * step / steps; };
  std::vector<double> travelled(static_cast<std::size_t>(steps) + 1, 0.0);
  for (int i = 1; i <= steps; ++i) {
    const auto k = static_cast<std::size_t>(i);
    travelled[k] = travelled[k - 1] + distance(at(parameter(i - 1)), at(parameter(i)));
  }
  std::vector<Vec2d> result{at(from)};
  for (int i = 1; i < count; ++i) {
    const double wanted = travelled.back() * i / count;
    const auto after = std::lower_bound(travelled.begin() + 1, travelled.end() - 1, wanted);
    const double low = *(after - 1), high = *after;
    const double part = high > low ? (wanted - low) / (high - low) : 0;
    result.push_back(at(parameter(static_cast<double>(after - 1 - travelled.begin()) + part)));
  }
  result.push_back(at(to));
  return result;
}

}  // namespace fovea::sample
