#include "oracle/geodesic_oracle.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace fovea::test {

namespace {

constexpr double kNever = std::numeric_limits<double>::infinity();

class Straight {
 public:
  Straight(const Surface& surface, double radius) : surface_(surface), radius_(radius) {}

  std::vector<double> from(std::uint32_t source) {
    found_.assign(surface_.positions.size(), kNever);
    found_[source] = 0;
    for (std::size_t f = 0; f < surface_.triangles.size(); ++f) {
      for (std::size_t k = 0; k < 3; ++k) {
        if (surface_.triangles[f][k] != source) continue;
        const std::uint32_t a = surface_.triangles[f][(k + 1) % 3], b = surface_.triangles[f][(k + 2) % 3];
        // The triangle in the plane, source at the origin, b to the left of a.
        const Vec3d p = surface_.position(source), pa = surface_.position(a) - p,
                    pb = surface_.position(b) - p;
        const double la = length(pa);
        const Vec2d qa{la, 0}, qb{dot(pa, pb) / la, length(cross(pa, pb)) / la};
        note(a, qa);
        note(b, qb);
        cross_edge(f, a, b, qa, qb, qa, qb);
      }
    }
    return found_;
  }

 private:
  void note(std::uint32_t v, Vec2d at) {
    const double d = std::hypot(at.x, at.y);
    if (d <= radius_) found_[v] = std::min(found_[v], d);
  }

  /// Lines from the origin between the directions `right` and `left` leave triangle f through the edge a–b,
  /// which lies at qa (right) and qb (left).
  void cross_edge(std::size_t f, std::uint32_t a, std::uint32_t b, Vec2d qa, Vec2d qb, Vec2d right,
                  Vec2d left) {
    const Vec2d edge = qb - qa;
    const double l = std::hypot(edge.x, edge.y);
    if (std::abs(cross(qa, edge)) / l > radius_) return;  // the whole line is too far
    for (std::size_t g = 0; g < surface_.triangles.size(); ++g) {
      if (g == f) continue;
      const auto& t = surface_.triangles[g];
      if (std::find(t.begin(), t.end(), a) == t.end() || std::find(t.begin(), t.end(), b) == t.end())
        continue;
      const std::uint32_t c =
          *std::find_if(t.begin(), t.end(), [&](std::uint32_t v) { return v != a && v != b; });
      // c beyond the edge, seen from the origin: to the right of the way from a to b.
      const Vec3d p = surface_.position(a), along = (surface_.position(b) - p) / l,
                  side = surface_.position(c) - p;
      const double x = dot(along, side), y = length(cross(along, side));
      const Vec2d unit = edge * (1 / l), out{unit.y, -unit.x};
      const Vec2d qc = qa + unit * x + out * y;
      if (cross(right, qc) >= -1e-12 && cross(qc, left) >= -1e-12) note(c, qc);
      // Right of c lines leave through a–c, left of it through c–b.
      const Vec2d middle_right = cross(qc, left) > 0 ? qc : left,
                  middle_left = cross(right, qc) > 0 ? qc : right;
      if (cross(right, middle_right) > 1e-12) cross_edge(g, a, c, qa, qc, right, middle_right);
      if (cross(middle_left, left) > 1e-12) cross_edge(g, c, b, qc, qb, middle_left, left);
    }
  }

  const Surface& surface_;
  const double radius_;
  std::vector<double> found_;
};

}  // namespace

std::vector<std::vector<double>> all_geodesics(const Surface& surface, double radius) {
  const std::size_t n = surface.positions.size();
  Straight straight(surface, radius);
  std::vector<std::vector<double>> d;
  for (std::uint32_t v = 0; v < n; ++v) d.push_back(straight.from(v));
  // Floyd and Warshall.
  for (std::size_t k = 0; k < n; ++k) {
    for (std::size_t i = 0; i < n; ++i) {
      for (std::size_t j = 0; j < n; ++j) d[i][j] = std::min(d[i][j], d[i][k] + d[k][j]);
    }
  }
  for (auto& row : d) {
    for (double& x : row) x = x <= radius ? x : kNever;
  }
  return d;
}

}  // namespace fovea::test
