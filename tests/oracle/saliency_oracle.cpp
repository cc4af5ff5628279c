#include "oracle/saliency_oracle.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numeric>
#include <set>
#include <vector>

namespace fovea::test {

namespace {

/// Twice the area, along the normal.
Vec3d area_vector(const Surface& surface, const std::array<std::uint32_t, 3>& t) {
  const Vec3d p = surface.position(t[0]);
  return cross(surface.position(t[1]) - p, surface.position(t[2]) - p);
}

/// A third of the area of the triangles at each vertex.
std::vector<double> areas_of(const Surface& surface) {
  std::vector<double> areas(surface.positions.size(), 0);
  for (const auto& t : surface.triangles) {
    for (const std::uint32_t v : t) areas[v] += length(area_vector(surface, t)) / 6;
  }
  return areas;
}

using Matrix = std::vector<std::vector<double>>;

/// The eigenvectors of a symmetric matrix as columns, by Jacobi's rotations; they turn `a` into the diagonal
/// of its eigenvalues.
Matrix eigenvectors(Matrix& a) {
  const std::size_t n = a.size();
  Matrix vectors(n, std::vector<double>(n, 0));
  for (std::size_t i = 0; i < n; ++i) vectors[i][i] = 1;
  for (double rest = 1; rest > 1e-18;) {
    rest = 0;
    double all = 0;
    for (std::size_t i = 0; i < n; ++i) {
      for (std::size_t j = 0; j < n; ++j) {
        all += a[i][j] * a[i][j];
        if (i != j) rest += a[i][j] * a[i][j];
      }
    }
    rest /= all;
    for (std::size_t p = 0; p < n; ++p) {
      for (std::size_t q = p + 1; q < n; ++q) {
        const double angle = 0.5 * std::atan2(2 * a[p][q], a[q][q] - a[p][p]);
        const double c = std::cos(angle), s = std::sin(angle);
        const auto turn = [&](double& x, double& y) {
          const double before = x;
          x = c * before - s * y;
          y = s * before + c * y;
        };
        for (std::size_t k = 0; k < n; ++k) turn(a[k][p], a[k][q]);
        for (std::size_t k = 0; k < n; ++k) turn(a[p][k], a[q][k]);
        for (std::size_t k = 0; k < n; ++k) turn(vectors[k][p], vectors[k][q]);
      }
    }
  }
  return vectors;
}

double disc_response(double eigenvalue, double sigma, double cutoff) {
  constexpr int kSteps = 1000;
  double sum = 0, weights = 0;
  for (int i = 0; i < kSteps; ++i) {
    const double r = cutoff * sigma * (i + 0.5) / kSteps, w = r * std::exp(-r * r / (2 * sigma * sigma));
    sum += w * std::cyl_bessel_j(0.0, std::sqrt(std::max(eigenvalue, 0.0)) * r);
    weights += w;
  }
  return sum / weights;
}

void add_to(VertexField& sum, const VertexField& field, double weight = 1) {
  for (std::size_t v = 0; v < sum.size(); ++v)
    sum.values()[v] += static_cast<float>(weight) * field.values()[v];
}

}  // namespace

VertexField taubin_curvature(const Surface& surface) {
  VertexField result(surface.positions.size());
  for (std::uint32_t v = 0; v < result.size(); ++v) {
    const Vec3d p = surface.position(v);
    Vec3d normal;
    std::map<std::uint32_t, double> edges;  // to each neighbour, the area of its triangles
    double all = 0;
    for (const auto& t : surface.triangles) {
      for (int i = 0; i < 3; ++i) {
        if (t[i] != v) continue;
        const std::uint32_t a = t[(i + 1) % 3], b = t[(i + 2) % 3];
        const Vec3d pa = surface.position(a) - p, pb = surface.position(b) - p;
        const double sine = length(cross(pa, pb)) / (length(pa) * length(pb));
        if (!(sine > 0)) continue;
        normal = normal + normalized(cross(pa, pb)) * (sine / (length(pa) * length(pb)));
        for (const std::uint32_t w : {a, b}) {
          edges[w] += length(cross(pa, pb)) / 2;
          all += length(cross(pa, pb)) / 2;
        }
      }
    }
    if (!(length(normal) > 0)) continue;
    normal = normalized(normal);
    double mean = 0;
    for (const auto& [w, area] : edges) {
      const Vec3d edge = surface.position(w) - p;
      mean += area / all * 2 * dot(normal, edge) / length_squared(edge);
    }
    result.values()[v] = static_cast<float>(mean);
  }
  return result;
}

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

VertexField window_average(const VertexField& field, const Surface& surface, double radius, double fall,
                           const VertexField& weights) {
  const auto weight_of = [&](std::uint32_t v) {
    return weights.empty() ? 1 : static_cast<double>(weights.values()[v]);
  };
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
    const auto add = [&](Vec3d at, double value, double weight) {
      weight *= std::exp(-length_squared(at - p) / (2 * radius * radius));
      sum += weight * value;
      total += weight;
    };
    for (std::uint32_t x = 0; x < count; ++x) {
      const bool inside = length(surface.position(x) - p) <= radius;
      if (inside || ring[v].contains(x))
        add(surface.position(x), static_cast<double>(field.values()[x]), weight_of(x));
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
      double value = 0, weight = 0, shares = 0;
      for (const std::uint32_t y : around) {
        const double d = length(surface.position(y) - crossing) / mean_edge, share = std::exp(-fall * d * d);
        point = point + surface.position(y) * share;
        value += share * weight_of(y) * static_cast<double>(field.values()[y]);
        weight += share * weight_of(y);
        shares += share;
      }
      add(point / shares, value / weight, weight / shares);
    }
    result.values()[v] = static_cast<float>(sum / total);
  }
  return result;
}

VertexField spectral_average(const VertexField& field, const Surface& surface, double sigma, double cutoff) {
  const std::size_t n = field.size();
  const std::vector<double> areas = areas_of(surface);
  // M^−½ L M^−½, which is symmetric.
  Matrix laplacian(n, std::vector<double>(n, 0));
  for (const auto& t : surface.triangles) {
    for (int i = 0; i < 3; ++i) {
      const std::uint32_t a = t[(i + 1) % 3], b = t[(i + 2) % 3];
      const Vec3d p = surface.position(t[i]), pa = surface.position(a) - p, pb = surface.position(b) - p;
      const double weight = dot(pa, pb) / length(cross(pa, pb)) / 2;  // half the cotangent
      laplacian[a][a] += weight / areas[a];
      laplacian[b][b] += weight / areas[b];
      laplacian[a][b] -= weight / std::sqrt(areas[a] * areas[b]);
      laplacian[b][a] -= weight / std::sqrt(areas[a] * areas[b]);
    }
  }
  const Matrix vectors = eigenvectors(laplacian);
  std::vector<double> sums(n, 0);
  for (std::size_t k = 0; k < n; ++k) {
    double part = 0;
    for (std::size_t v = 0; v < n; ++v)
      part += vectors[v][k] * std::sqrt(areas[v]) * static_cast<double>(field.values()[v]);
    part *= disc_response(laplacian[k][k], sigma, cutoff);
    for (std::size_t v = 0; v < n; ++v) sums[v] += part * vectors[v][k] / std::sqrt(areas[v]);
  }
  VertexField result(n);
  for (std::size_t v = 0; v < n; ++v) result.values()[v] = static_cast<float>(sums[v]);
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

VertexField textured_saliency(const TexturedSignals& signals, const Surface& surface, double texture,
                              double entropy) {
  const std::vector<double> areas = areas_of(surface);
  const double triangle =
      std::accumulate(areas.begin(), areas.end(), 0.0) / static_cast<double>(surface.triangles.size());
  const double unit = std::sqrt(4 * triangle / (3 * std::sqrt(3.0)));
  const double falls[] = {1, 1.2, 1.5, 2, 2};
  const auto contrasts = [&](const VertexField& signal, const VertexField& weights) {
    std::vector<VertexField> averages, result;
    for (int l = 0; l < 5; ++l)
      averages.push_back(window_average(signal, surface, std::ldexp(unit, l + 1), falls[l], weights));
    for (std::size_t l = 0; l < 4; ++l) {
      result.emplace_back(signal.size());
      for (std::size_t v = 0; v < signal.size(); ++v)
        result[l].values()[v] = std::abs(averages[l].values()[v] - averages[l + 1].values()[v]);
    }
    return result;
  };
  VertexField g(signals.curvature.size()), t(g.size()), s(g.size());
  for (const VertexField& contrast : contrasts(signals.curvature, {})) add_to(g, promoted(contrast, surface));
  const auto add_texture = [&](const VertexField& signal, double weight) {
    VertexField sum(signal.size());
    for (const VertexField& contrast : contrasts(signal, signals.texels)) add_to(sum, contrast);
    add_to(t, promoted(sum, surface), weight);
  };
  add_texture(signals.intensity, 1 - entropy);
  add_texture(signals.opponency, 1 - entropy);
  add_texture(signals.entropy, entropy);
  add_to(s, promoted(t, surface), texture);
  add_to(s, promoted(g, surface), 1 - texture);
  const float low = *std::min_element(s.values().begin(), s.values().end());
  const float high = *std::max_element(s.values().begin(), s.values().end());
  for (float& x : s.values()) x = (x - low) / (high - low);
  return s;
}

std::vector<double> salient_weights(const VertexField& saliency, const Surface& surface,
                                    const SalientOptions& options) {
  const std::vector<double> area = areas_of(surface);
  const double whole = std::accumulate(area.begin(), area.end(), 0.0);
  double threshold = 1;
  if (options.weighting == SaliencyWeighting::munaretti) {
    threshold =
        0.7 * static_cast<double>(*std::max_element(saliency.values().begin(), saliency.values().end()));
  } else {
    // The 30th percentile: the least value with more than that share of the area at or below it.
    for (const float candidate : saliency.values()) {
      double below = 0;
      for (std::size_t v = 0; v < area.size(); ++v) below += saliency.values()[v] <= candidate ? area[v] : 0;
      if (below > 0.3 * whole) threshold = std::min(threshold, static_cast<double>(candidate));
    }
  }
  std::vector<double> omega;
  for (const float s : saliency.values()) {
    const double x = std::max(static_cast<double>(s), 0.001);
    const double amplifier = options.weighting == SaliencyWeighting::yang ? 20 : 100;
    omega.push_back(static_cast<double>(s) >= threshold ? amplifier * x : x);
  }
  const double highest = *std::max_element(omega.begin(), omega.end());
  double sum = 0;
  for (std::size_t v = 0; v < omega.size(); ++v) {
    if (options.weighting == SaliencyWeighting::yang) omega[v] = 1 + std::pow(omega[v] / highest, 3);
    omega[v] = std::pow(omega[v], options.strength);
    sum += area[v] * omega[v];
  }
  for (double& w : omega) w *= whole / sum;
  return omega;
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
