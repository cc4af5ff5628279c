#include "oracle/saliency_oracle.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <vector>

namespace fovea::test {

VertexField gaussian_average(const VertexField& field, double sigma, double cutoff, const Distance& distance,
                             const VertexField& weights) {
  VertexField result(field.size());
  for (std::uint32_t v = 0; v < field.size(); ++v) {
    double sum = 0, total = 0;
    for (std::uint32_t x = 0; x < field.size(); ++x) {
      const double d = distance(v, x);
      if (d > cutoff * sigma) continue;
      double weight = std::exp(-d * d / (2 * sigma * sigma));
      if (!weights.empty()) weight *= static_cast<double>(weights.values()[x]);
      sum += weight * static_cast<double>(field.values()[x]);
      total += weight;
    }
    result.values()[v] = static_cast<float>(sum / total);
  }
  return result;
}

VertexField window_average(const VertexField& field, const Surface& surface, double radius, double fall) {
  const auto count = static_cast<std::uint32_t>(field.size());
  std::vector<std::set<std::uint32_t>> ring(count);
  for (const auto& t : surface.triangles) {
    for (int i = 0; i < 3; ++i) {
      ring[t[i]].insert(t[(i + 1) % 3]);
      ring[t[i]].insert(t[(i + 2) % 3]);
    }
  }
  double edges = 0, edge_count = 0;
  for (std::uint32_t v = 0; v < count; ++v) {
    for (const std::uint32_t w : ring[v]) {
      edges += length(surface.position(v) - surface.position(w));
      ++edge_count;
    }
  }
  const double mean_edge = edges / edge_count;
  VertexField result(count);
  for (std::uint32_t v = 0; v < count; ++v) {
    const Vec3d p = surface.position(v);
    double sum = 0, total = 0;
    const auto add = [&](Vec3d at, double value) {
      const double weight = std::exp(-length_squared(at - p) / (2 * radius * radius));
      sum += weight * value;
      total += weight;
    };
    for (std::uint32_t x = 0; x < count; ++x) {
      const bool inside = length(surface.position(x) - p) <= radius;
      if (inside || ring[v].contains(x)) add(surface.position(x), static_cast<double>(field.values()[x]));
      if (inside || !ring[v].contains(x)) continue;
      const Vec3d q = surface.position(x), crossing = p + normalized(q - p) * radius;
      std::vector<std::uint32_t> around{v, x};
      for (const auto& t : surface.triangles) {
        for (int i = 0; i < 3; ++i) {
          const std::uint32_t a = t[(i + 1) % 3], b = t[(i + 2) % 3];
          if ((a == v && b == x) || (a == x && b == v)) around.push_back(t[i]);
        }
      }
      Vec3d point{0, 0, 0};
      double value = 0, shares = 0;
      for (const std::uint32_t y : around) {
        const double d = length(surface.position(y) - crossing) / mean_edge, share = std::exp(-fall * d * d);
        point = point + surface.position(y) * share;
        value += share * static_cast<double>(field.values()[y]);
        shares += share;
      }
      add(point / shares, value / shares);
    }
    result.values()[v] = static_cast<float>(sum / total);
  }
  return result;
}

VertexField promoted(const VertexField& field, const Surface& surface) {
  const float low = *std::min_element(field.values().begin(), field.values().end());
  const float high = *std::max_element(field.values().begin(), field.values().end());
  VertexField result(field.size());
  if (high == low) return result;
  for (std::uint32_t v = 0; v < field.size(); ++v)
    result.values()[v] = (field.values()[v] - low) / (high - low);
  std::vector<bool> is_peak(field.size(), false);
  for (const auto& t : surface.triangles) {
    for (const std::uint32_t v : t) is_peak[v] = true;
  }
  for (const auto& t : surface.triangles) {
    for (const std::uint32_t v : t) {
      for (const std::uint32_t w : t) {
        if (w != v && result.values()[w] >= result.values()[v]) is_peak[v] = false;
      }
    }
  }
  double sum = 0;
  int count = 0;
  bool skipped = false;
  for (std::uint32_t v = 0; v < field.size(); ++v) {
    if (result.values()[v] == 1 && !skipped) {
      skipped = true;  // the global maximum, once
    } else if (is_peak[v]) {
      sum += static_cast<double>(result.values()[v]);
      ++count;
    }
  }
  const double mean = count > 0 ? sum / count : 0;
  for (float& x : result.values()) x *= static_cast<float>((1 - mean) * (1 - mean));
  return result;
}

VertexField lee_saliency(const VertexField& curvature, const Surface& surface, double unit, double cutoff,
                         const Distance& distance) {
  VertexField result(curvature.size());
  for (int i = 2; i <= 6; ++i) {
    const VertexField fine = gaussian_average(curvature, i * unit, cutoff, distance),
                      coarse = gaussian_average(curvature, 2 * i * unit, cutoff, distance);
    VertexField level(curvature.size());
    for (std::uint32_t v = 0; v < curvature.size(); ++v)
      level.values()[v] = std::abs(fine.values()[v] - coarse.values()[v]);
    level = promoted(level, surface);
    for (std::uint32_t v = 0; v < curvature.size(); ++v) result.values()[v] += level.values()[v];
  }
  return result;
}

VertexField multi_pose_saliency(const std::vector<VertexField>& poses) {
  VertexField result(poses[0].size());
  for (std::uint32_t v = 0; v < result.size(); ++v) {
    double base = poses[0].values()[v];
    for (const VertexField& pose : poses) base = std::min(base, static_cast<double>(pose.values()[v]));
    double differences = 0;
    for (const VertexField& pose : poses) differences += static_cast<double>(pose.values()[v]) - base;
    result.values()[v] = static_cast<float>(base + differences);
  }
  return result;
}

}  // namespace fovea::test
