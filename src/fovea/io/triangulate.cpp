#include "fovea/io/triangulate.h"

#include <algorithm>

namespace fovea {

namespace {

double turn(Vec2d a, Vec2d b, Vec2d c) { return cross(b - a, c - a); }

}  // namespace

std::span<const std::array<std::uint32_t, 3>> Triangulator::run(std::span<const Vec3f> polygon) {
  triangles_.clear();
  const std::size_t count = polygon.size();
  if (count < 3) return {};
  if (count == 3 || !project(polygon) || is_convex()) {
    fan(count);
  } else if (count == 4) {
    cut_quad();
  } else if (count > kMaxEars) {
    fan(count);
  } else {
    cut_ears();
  }
  return triangles_;
}

void Triangulator::fan(std::size_t count) {
  for (std::uint32_t i = 1; i + 1 < count; ++i) triangles_.push_back({0, i, i + 1});
}

/// False if the polygon has no area to speak of, so that no plane is meant.
bool Triangulator::project(std::span<const Vec3f> polygon) {
  Vec3d normal;
  const Vec3d origin(polygon[0]);
  for (std::size_t i = 1; i + 1 < polygon.size(); ++i) {
    normal += cross(Vec3d(polygon[i]) - origin, Vec3d(polygon[i + 1]) - origin);
  }
  normal = normalized(normal);
  if (!(length_squared(normal) > 0.5)) return false;
  const Vec3d axis = std::abs(normal.x) < 0.6 ? Vec3d{1, 0, 0} : Vec3d{0, 1, 0};
  const Vec3d x = normalized(cross(axis, normal)), y = cross(normal, x);
  points_.clear();
  for (const Vec3f& p : polygon) {
    const Vec3d d = Vec3d(p) - origin;
    points_.push_back({dot(d, x), dot(d, y)});
  }
  return true;
}

/// A corner that is there twice would hide a turn: it counts once.
bool Triangulator::is_convex() {
  distinct_.clear();
  for (const Vec2d& p : points_) {
    if (distinct_.empty() || p != distinct_.back()) distinct_.push_back(p);
  }
  const std::size_t n = distinct_.size();
  for (std::size_t i = 0; i < n; ++i) {
    if (turn(distinct_[i], distinct_[(i + 1) % n], distinct_[(i + 2) % n]) < 0) return false;
  }
  return true;
}

/// The diagonal of a concave quad starts at its dent.
void Triangulator::cut_quad() {
  for (std::uint32_t i = 0; i < 4; ++i) {
    if (turn(points_[(i + 3) % 4], points_[i], points_[(i + 1) % 4]) < 0) {
      triangles_.push_back({i, (i + 1) % 4, (i + 2) % 4});
      triangles_.push_back({i, (i + 2) % 4, (i + 3) % 4});
      return;
    }
  }
  fan(4);
}

void Triangulator::cut_ears() {
  left_.clear();
  for (std::uint32_t i = 0; i < points_.size(); ++i) left_.push_back(i);
  std::size_t at = 0;
  while (left_.size() > 3) {
    const std::size_t n = left_.size();
    at = find_ear(at % n);
    triangles_.push_back({left_[(at + n - 1) % n], left_[at], left_[(at + 1) % n]});
    left_.erase(left_.begin() + static_cast<std::ptrdiff_t>(at));
  }
  triangles_.push_back({left_[0], left_[1], left_[2]});
}

/// The next corner that can be cut off without harm; else one that touches others at its rim or is
/// flat; else, of a polygon that crosses itself, any.
std::size_t Triangulator::find_ear(std::size_t from) const {
  const std::size_t n = left_.size();
  for (const bool strict : {true, false}) {
    for (std::size_t i = 0; i < n; ++i) {
      if (is_ear((from + i) % n, strict)) return (from + i) % n;
    }
  }
  return from;
}

bool Triangulator::is_ear(std::size_t at, bool strict) const {
  const std::size_t n = left_.size();
  const Vec2d a = points_[left_[(at + n - 1) % n]], b = points_[left_[at]], c = points_[left_[(at + 1) % n]];
  const double area = turn(a, b, c);
  if (area < 0 || (strict && area == 0)) return false;
  for (std::size_t i = 0; i < n; ++i) {
    const Vec2d p = points_[left_[i]];
    if (p == a || p == b || p == c) continue;
    const double nearest = std::min({turn(a, b, p), turn(b, c, p), turn(c, a, p)});
    if (nearest > 0 || (strict && nearest == 0)) return false;
  }
  return true;
}

}  // namespace fovea
