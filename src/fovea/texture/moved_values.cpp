#include "fovea/texture/moved_values.h"

#include <algorithm>
#include <cmath>

#include "fovea/surface/disjoint_sets.h"

namespace fovea {

namespace {

/// Of a triangle's area in the texture: what it has to keep, but for what others need.
constexpr double kLeastArea = 0.02;
/// What those that turn over get, and how often all are looked at for such.
constexpr double kRestored = 0.25;
constexpr int kMostPasses = 100;

/// Twice the area, with a sign.
double area(const AtlasFace& face, const std::vector<Vec2d>& at) {
  return cross(at[face.value[1]] - at[face.value[0]], at[face.value[2]] - at[face.value[0]]);
}
double area(const AtlasFace& face) { return cross(face.uv[1] - face.uv[0], face.uv[2] - face.uv[0]); }

double length_of(Vec2d a) { return std::hypot(a.x, a.y); }

/// The corner across from the longest side.
std::size_t apex(const AtlasFace& face) {
  std::size_t best = 0;
  double longest = -1;
  for (std::size_t k = 0; k < 3; ++k) {
    const double side = length_of(face.uv[(k + 2) % 3] - face.uv[(k + 1) % 3]);
    if (side > longest) longest = side, best = k;
  }
  return best;
}

/// Along one axis: values that share a coordinate in a triangle without area go on to share it.
class Ties {
 public:
  Ties(std::span<const AtlasFace> faces, std::size_t values, double Vec2d::*axis)
      : axis_(axis), sets_(values), sums_(values), counts_(values) {
    for (const AtlasFace& face : faces) {
      if (area(face) != 0) continue;
      for (std::size_t k = 0; k < 3; ++k) {
        const std::size_t next = (k + 1) % 3;
        if (face.uv[k].*axis == face.uv[next].*axis) sets_.unite(face.value[k], face.value[next]);
      }
    }
  }

  /// All of a set get the mean.
  void apply(std::vector<Vec2d>& at) {
    std::ranges::fill(sums_, 0.0);
    std::ranges::fill(counts_, 0.0);
    for (std::size_t i = 0; i < at.size(); ++i) {
      const std::size_t set = sets_.find(i);
      sums_[set] += at[i].*axis_;
      counts_[set] += 1;
    }
    for (std::size_t i = 0; i < at.size(); ++i) {
      const std::size_t set = sets_.find(i);
      if (counts_[set] > 1) at[i].*axis_ = sums_[set] / counts_[set];
    }
  }

 private:
  double Vec2d::*axis_;
  DisjointSets sets_;
  std::vector<double> sums_, counts_;  // [#values], of sets
};

/// Moves the corners of a triangle apart, which had twice the area `before` and has `after`.
bool restore(const AtlasFace& face, double before, double after, std::vector<Vec2d>& at) {
  const std::size_t k = apex(face), i = (k + 1) % 3, j = (k + 2) % 3;
  const Vec2d side = at[face.value[j]] - at[face.value[i]];
  const double length = length_of(side), old_length = length_of(face.uv[j] - face.uv[i]);
  if (!(length > 0)) return false;
  const double wanted = before * (length / old_length) * (length / old_length) * kRestored;
  const Vec2d up = Vec2d{-side.y, side.x} * (1 / length);
  const Vec2d move = up * ((wanted - after) / length / 2);
  at[face.value[k]] = at[face.value[k]] + move;
  at[face.value[i]] = at[face.value[i]] - move;
  at[face.value[j]] = at[face.value[j]] - move;
  return true;
}

}  // namespace

std::optional<std::vector<Vec2d>> moved_values(std::span<const AtlasFace> faces, const InverseWarp& warp) {
  std::size_t count = 0;
  for (const AtlasFace& face : faces)
    for (const std::uint32_t value : face.value) count = std::max<std::size_t>(count, value + std::size_t{1});
  std::vector<Vec2d> at(count);
  for (const AtlasFace& face : faces)
    for (std::size_t k = 0; k < 3; ++k) at[face.value[k]] = warp.target(face.uv[k]);
  Ties ties_x(faces, count, &Vec2d::x), ties_y(faces, count, &Vec2d::y);
  for (int pass = 0; pass < kMostPasses; ++pass) {
    ties_x.apply(at);
    ties_y.apply(at);
    bool done = true;
    for (const AtlasFace& face : faces) {
      const double before = area(face), after = area(face, at);
      if (before == 0 || after / before >= kLeastArea) continue;
      done = false;
      if (!restore(face, before, after, at)) return std::nullopt;
    }
    if (done) return at;
  }
  return std::nullopt;
}

}  // namespace fovea
