#include "fovea/render/view.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace fovea {

namespace {

constexpr double kPi = std::numbers::pi;

/// All (±x, ±y, ±z), the first sign changing slowest; a zero has one sign.
void add_signs(std::vector<Vec3d>& out, Vec3d v) {
  const auto signs = [](double x) { return x == 0 ? std::vector<double>{0.0} : std::vector<double>{x, -x}; };
  for (const double x : signs(v.x)) {
    for (const double y : signs(v.y)) {
      for (const double z : signs(v.z)) out.push_back({x, y, z});
    }
  }
}

/// `add_signs` of the three cyclic permutations of v.
void add_cyclic(std::vector<Vec3d>& out, Vec3d v) {
  add_signs(out, v);
  add_signs(out, {v.z, v.x, v.y});
  add_signs(out, {v.y, v.z, v.x});
}

std::vector<Vec3d> fibonacci_sphere(std::int64_t count) {
  std::vector<Vec3d> points;
  const double golden_angle = kPi * (3 - std::sqrt(5.0));
  for (std::int64_t i = 0; i < count; ++i) {
    const double y = 1 - (2 * static_cast<double>(i) + 1) / static_cast<double>(count);
    const double r = std::sqrt(std::max(0.0, 1 - y * y)), angle = golden_angle * static_cast<double>(i);
    points.push_back({r * std::sin(angle), y, r * std::cos(angle)});
  }
  return points;
}

/// Starts in front (+z) and turns to the right (+x).
std::vector<Vec3d> orbit(std::int64_t count, double elevation_deg) {
  std::vector<Vec3d> points;
  const double elevation = elevation_deg * kPi / 180;
  for (std::int64_t i = 0; i < count; ++i) {
    const double angle = 2 * kPi * static_cast<double>(i) / static_cast<double>(count);
    points.push_back(
        {std::cos(elevation) * std::sin(angle), std::sin(elevation), std::cos(elevation) * std::cos(angle)});
  }
  return points;
}

}  // namespace

OptionList describe(ViewOptions& o) {
  return {
      {"views",
       "Where to look from: the vertices of a solid, points spread over a sphere, an orbit around the "
       "upright "
       "axis, or the model's own cameras.",
       choice(o.set, {"tetrahedron", "cube", "octahedron", "dodecahedron", "icosahedron",
                      "rhombicuboctahedron", "fibonacci", "orbit", "cameras"}),
       ""},
      {"view-count", "How many views fibonacci and orbit have, and the path of a camera that is animated.",
       &o.count, "", 1, 4096},
      {"elevation", "How high above the horizon an orbit is.", &o.elevation_deg, "degrees", -89, 89},
      {"fov", "Vertical angle of view; 0 is parallel projection.", &o.fov_deg, "degrees", 0, 120},
      {"margin", "Free border around the model's bounding sphere.", &o.margin, "of its radius", 0, 10}};
}

std::vector<Vec3d> directions(const ViewOptions& options) {
  const double golden = (1 + std::sqrt(5.0)) / 2, silver = 1 + std::sqrt(2.0);
  std::vector<Vec3d> points;
  switch (options.set) {
    case ViewSet::tetrahedron: points = {{1, 1, 1}, {1, -1, -1}, {-1, 1, -1}, {-1, -1, 1}}; break;
    case ViewSet::cube: add_signs(points, {1, 1, 1}); break;
    case ViewSet::octahedron: add_cyclic(points, {1, 0, 0}); break;
    case ViewSet::dodecahedron:
      add_signs(points, {1, 1, 1});
      add_cyclic(points, {0, 1 / golden, golden});
      break;
    case ViewSet::icosahedron: add_cyclic(points, {0, 1, golden}); break;
    case ViewSet::rhombicuboctahedron: add_cyclic(points, {silver, 1, 1}); break;
    case ViewSet::fibonacci: points = fibonacci_sphere(options.count); break;
    case ViewSet::orbit: points = orbit(options.count, options.elevation_deg); break;
    case ViewSet::cameras: break;
  }
  for (Vec3d& p : points) p = normalized(p);
  return points;
}

int picture_width(const View& view, std::int64_t height) {
  return std::max(1, static_cast<int>(std::lround(view.aspect * static_cast<double>(height))));
}

View view_onto(const Sphere& sphere, Vec3d direction, double fov_deg, double margin) {
  // Numbers of a view are rounded, so that the last bits of the C library's sines do not show.
  View view;
  view.back = in_single_precision(direction);
  // Looked at from above or below, the model's front (+z) is at the bottom of the picture or its top.
  const Vec3d upright =
      std::abs(direction.y) > 0.999 ? Vec3d{0, 0, direction.y > 0 ? -1.0 : 1.0} : Vec3d{0, 1, 0};
  view.right = in_single_precision(normalized(cross(upright, direction)));
  view.up = in_single_precision(cross(direction, normalized(cross(upright, direction))));
  const double radius = sphere.radius > 0 ? sphere.radius * (1 + margin) : 1;
  view.perspective = fov_deg > 0;
  const double half = fov_deg * kPi / 360;
  const double distance = view.perspective ? radius / std::sin(half) : 2 * radius;
  view.half_height = in_single_precision(view.perspective ? std::tan(half) : radius);
  view.eye = in_single_precision(sphere.center + direction * distance);
  // In front of the sphere, or of the eye if the sphere reaches behind it.
  view.near = in_single_precision(std::max(distance - 1.01 * radius, 1e-3 * radius));
  return view;
}

View view_from(Vec3d eye, Vec3d target, double fov_deg) {
  const Vec3d away = eye - target;
  View view = view_onto({target, length(away)}, normalized(away), fov_deg, 0);
  view.eye = in_single_precision(eye);
  if (!view.perspective) view.half_height = in_single_precision(0.5 * length(away));
  view.near = in_single_precision(1e-3 * length(away));
  return view;
}

std::vector<View> make_views(const ViewOptions& options, const Sphere& sphere) {
  std::vector<View> views;
  for (const Vec3d& direction : directions(options)) {
    views.push_back(view_onto(sphere, direction, options.fov_deg, options.margin));
    views.back().name = fmt::format("view-{:02}", views.size());
  }
  return views;
}

}  // namespace fovea
