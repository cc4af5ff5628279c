#include "fovea/io/triangulate.h"

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

bool Triangulator::is_convex() const {
  const std::size_t n = points_.size();
  for (std::size_t i = 0; i < n; ++i) {
    if (turn(points_[i], points_[(i + 1) % n], points_[(i + 2) % n]) < 0) return false;
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
}

void Triangulator::cut_ears() {
  left_.clear();
  for (std::uint32_t i = 0; i < points_.size(); ++i) left_.push_back(i);
  std::size_t at = 0, tries = 0;
  while (left_.size() > 3) {
    const std::size_t n = left_.size();
    at %= n;
    // Nothing is an ear of a polygon that crosses itself: cut anywhere rather than give up.
    if (!is_ear(at) && tries < n) {
      ++at;
      ++tries;
      continue;
    }
    triangles_.push_back({left_[(at + n - 1) % n], left_[at], left_[(at + 1) % n]});
    left_.erase(left_.begin() + static_cast<std::ptrdiff_t>(at));
    tries = 0;
  }
  triangles_.push_back({left_[0], left_[1], left_[2]});
}

bool Triangulator::is_ear(std::size_t at) const {
  const std::size_t n = left_.size();
  const Vec2d a = points_[left_[(at + n - 1) % n]], b = points_[left_[at]], c = points_[left_[(at + 1) % n]];
  if (turn(a, b, c) <= 0) return false;
  for (std::size_t i = 0; i < n; ++i) {
    const Vec2d p = points_[left_[i]];
    if (p == a || p == b || p == c) continue;
    if (turn(a, b, p) >= 0 && turn(b, c, p) >= 0 && turn(c, a, p) >= 0) return false;
  }
  return true;
}

}  // namespace fovea
