#include "oracle/pose_oracle.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace fovea::test {

namespace {

double coordinate(Vec3d p, int axis) { return axis == 0 ? p.x : axis == 1 ? p.y : p.z; }

Vec3d turned(Vec3d p, int axis, double angle_rad) {
  const double c = std::cos(angle_rad), s = std::sin(angle_rad);
  if (axis == 0) return {p.x, c * p.y - s * p.z, s * p.y + c * p.z};
  if (axis == 1) return {s * p.z + c * p.x, p.y, c * p.z - s * p.x};
  return {c * p.x - s * p.y, s * p.x + c * p.y, p.z};
}

std::vector<Vec3d> centered(std::vector<Vec3d> points) {
  Vec3d sum;
  for (const Vec3d& p : points) sum += p;
  for (Vec3d& p : points) p = p - sum / static_cast<double>(points.size());
  return points;
}

double distance(const std::vector<Vec3d>& a, const std::vector<Vec3d>& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += length_squared(a[i] - b[i]);
  return std::sqrt(sum / static_cast<double>(a.size()));
}

/// The angle by which to turn b about an axis to bring it nearest to a.
double best_angle_rad(const std::vector<Vec3d>& a, const std::vector<Vec3d>& b, int axis) {
  const int u = (axis + 1) % 3, v = (axis + 2) % 3;
  double along = 0, across = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    along += coordinate(a[i], u) * coordinate(b[i], u) + coordinate(a[i], v) * coordinate(b[i], v);
    across += coordinate(a[i], v) * coordinate(b[i], u) - coordinate(a[i], u) * coordinate(b[i], v);
  }
  return std::atan2(across, along);
}

}  // namespace

double rigid_distance(const std::vector<Vec3d>& a, const std::vector<Vec3d>& b) {
  const std::vector<Vec3d> fixed = centered(a);
  double least = std::numeric_limits<double>::infinity();
  for (int begin = 0; begin < 4; ++begin) {
    std::vector<Vec3d> moved = centered(b);
    for (Vec3d& p : moved) p = turned(turned(p, 0, begin * 1.3), 1, begin * 2.1);
    for (double largest = 1; largest > 1e-9;) {
      largest = 0;
      for (int axis = 0; axis < 3; ++axis) {
        const double angle = best_angle_rad(fixed, moved, axis);
        for (Vec3d& p : moved) p = turned(p, axis, angle);
        largest = std::max(largest, std::abs(angle));
      }
    }
    least = std::min(least, distance(fixed, moved));
  }
  return least;
}

std::vector<Vec3d> shown_points(const Model& model, const Pose& pose) {
  std::vector<Vec3d> points;
  for (const Instance& instance : instances(model, pose)) {
    for (const Vec3f& p : posed_surface(model, pose, instance).positions) points.emplace_back(p);
  }
  return points;
}

std::vector<std::vector<double>> all_distances(const std::vector<std::vector<Vec3d>>& poses) {
  std::vector<std::vector<double>> distances(poses.size(), std::vector<double>(poses.size()));
  for (std::size_t a = 0; a < poses.size(); ++a) {
    for (std::size_t b = 0; b < a; ++b)
      distances[a][b] = distances[b][a] = rigid_distance(poses[a], poses[b]);
  }
  return distances;
}

std::vector<std::size_t> farthest_points(const std::vector<std::vector<double>>& distances, std::size_t count,
                                         double least) {
  std::size_t typical = 0;
  double typical_sum = std::numeric_limits<double>::infinity();
  for (std::size_t p = 0; p < distances.size(); ++p) {
    double sum = 0;
    for (const double d : distances[p]) sum += d * d;
    if (sum < typical_sum) {
      typical = p;
      typical_sum = sum;
    }
  }
  std::vector<std::size_t> chosen = {typical};
  while (chosen.size() < count) {
    std::size_t farthest = 0;
    double most = 0;
    for (std::size_t p = 0; p < distances.size(); ++p) {
      double nearest = std::numeric_limits<double>::infinity();
      for (const std::size_t c : chosen) nearest = std::min(nearest, distances[p][c]);
      if (nearest > most) {
        farthest = p;
        most = nearest;
      }
    }
    if (most <= least) break;
    chosen.push_back(farthest);
  }
  return chosen;
}

}  // namespace fovea::test
