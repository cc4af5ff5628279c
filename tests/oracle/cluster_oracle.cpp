#include "oracle/cluster_oracle.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "fovea/model/ids.h"

namespace fovea::test {

namespace {

constexpr double kFloor = 0.3, kLeastShare = 0.01;
constexpr double kInfinite = std::numeric_limits<double>::infinity();

/// A surface looked at triangle by triangle.
struct Plain {
  Plain(const Surface& s, std::span<const float> saliency) : surface(s) {
    for (const auto& t : s.triangles) {
      const Vec3d a = s.position(t[0]), b = s.position(t[1]), c = s.position(t[2]);
      centers.push_back((a + b + c) / 3.0);
      normals.push_back(normalized(cross(b - a, c - a)));
      areas.push_back(triangle_area(a, b, c));
      double sum = 0;
      for (const std::uint32_t v : t) sum += static_cast<double>(saliency[v]) / 3;
      salient.push_back(sum);
    }
  }
  bool touch(std::size_t f, std::size_t g) const {
    int common = 0;
    for (const std::uint32_t v : surface.triangles[f])
      common += static_cast<int>(std::count(surface.triangles[g].begin(), surface.triangles[g].end(), v));
    return f != g && common == 2;
  }
  double distance(std::size_t f, std::size_t g) const { return length(centers[f] - centers[g]); }

  const Surface& surface;
  std::vector<Vec3d> centers, normals;
  std::vector<double> areas, salient;
};

struct Way {
  double cost = kInfinite;
  std::size_t face = 0;
  std::uint32_t cluster = 0;
};

double step_cost(const Plain& plain, const std::vector<std::uint32_t>& of_face, std::uint32_t c, double start,
                 std::size_t from, std::size_t to) {
  double area = 0, sum = 0;
  Vec3d normal;
  for (std::size_t f = 0; f < of_face.size(); ++f) {
    if (of_face[f] != c) continue;
    area += plain.areas[f];
    sum += plain.areas[f] * plain.salient[f];
    normal += plain.areas[f] * plain.normals[f];
  }
  return (kFloor + 1 - dot(normalized(normal), plain.normals[to])) *
         (kFloor + std::abs(sum / area - plain.salient[to])) *
         (kFloor + std::abs(start - plain.salient[to])) *
         (kFloor + std::abs(plain.salient[from] - plain.salient[to])) * plain.distance(from, to);
}

bool has(const Surface& surface, std::size_t face, std::uint32_t vertex) {
  const auto& t = surface.triangles[face];
  return std::find(t.begin(), t.end(), vertex) != t.end();
}

}  // namespace

std::vector<std::uint32_t> literal_growth(const Surface& surface, std::span<const float> saliency,
                                          std::span<const std::uint32_t> seeds) {
  const Plain plain(surface, saliency);
  const std::size_t count = surface.triangles.size();
  std::vector<std::uint32_t> of_face(count, kInvalid);
  std::vector<Way> ways;
  const auto look_around = [&](std::size_t face, std::uint32_t c, double cost) {
    const auto start = static_cast<double>(saliency[seeds[c]]);
    for (std::size_t to = 0; to < count; ++to) {
      if (of_face[to] == kInvalid && plain.touch(face, to))
        ways.push_back({cost + step_cost(plain, of_face, c, start, face, to), to, c});
    }
  };
  for (std::uint32_t c = 0; c < seeds.size(); ++c) {
    for (std::size_t f = 0; f < count; ++f) {
      if (has(surface, f, seeds[c])) of_face[f] = c;
    }
    for (std::size_t f = 0; f < count; ++f) {
      if (of_face[f] == c) look_around(f, c, 0);
    }
  }
  while (true) {
    Way next;
    for (const Way& way : ways) {
      if (of_face[way.face] == kInvalid && way.cost < next.cost) next = way;
    }
    if (next.cost == kInfinite) return of_face;
    of_face[next.face] = next.cluster;
    look_around(next.face, next.cluster, next.cost);
  }
}

std::vector<std::uint32_t> literal_inner_seeds(const Surface& surface, std::span<const float> saliency,
                                               const std::vector<std::uint32_t>& of_face,
                                               std::uint32_t count) {
  const Plain plain(surface, saliency);
  std::vector<std::uint32_t> seeds;
  for (std::uint32_t c = 0; c < count; ++c) {
    double peak = 0;
    std::vector<std::size_t> faces;
    for (std::size_t f = 0; f < of_face.size(); ++f) {
      if (of_face[f] != c) continue;
      faces.push_back(f);
      peak = std::max(peak, plain.salient[f]);
    }
    std::vector<double> distance(of_face.size(), kInfinite);
    for (const std::size_t f : faces) {
      for (std::size_t g = 0; g < of_face.size(); ++g) {
        if (of_face[g] != c && plain.touch(f, g)) distance[f] = 0;
      }
    }
    for (bool changed = true; changed;) {
      changed = false;
      for (const std::size_t f : faces) {
        for (const std::size_t g : faces) {
          if (!plain.touch(f, g)) continue;
          const double way =
              distance[f] + plain.distance(f, g) * std::max(plain.salient[g] / peak, kLeastShare);
          if (way < distance[g] - 1e-12) distance[g] = way, changed = true;
        }
      }
    }
    const std::size_t last = *std::max_element(
        faces.begin(), faces.end(), [&](std::size_t a, std::size_t b) { return distance[a] < distance[b]; });
    const auto& t = surface.triangles[last];
    seeds.push_back(*std::max_element(
        t.begin(), t.end(), [&](std::uint32_t a, std::uint32_t b) { return saliency[a] < saliency[b]; }));
  }
  return seeds;
}

}  // namespace fovea::test
