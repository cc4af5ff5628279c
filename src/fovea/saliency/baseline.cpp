#include "fovea/saliency/baseline.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "fovea/surface/curvature.h"

namespace fovea {

namespace {

/// Vertices as masses, by their area.
struct Masses {
  const Surface& surface;
  VertexField areas;
  Vec3d center;

  Masses(const Surface& s, const Context& context)
      : surface(s), areas(vertex_areas(s, Adjacency(s, context), context)) {
    double whole = 0;
    Vec3d sum;
    for (std::uint32_t v = 0; v < areas.size(); ++v) {
      sum += area(v) * s.position(v);
      whole += area(v);
    }
    if (whole > 0) center = sum / whole;
  }

  double area(std::uint32_t v) const { return static_cast<double>(areas.values()[v]); }
  Vec3d from_center(std::uint32_t v) const { return surface.position(v) - center; }
};

/// value(vertex) above its least.
template <class F>
VertexField above_least(const Masses& masses, F&& value) {
  VertexField field(masses.areas.size());
  double least = std::numeric_limits<double>::infinity();
  for (std::uint32_t v = 0; v < field.size(); ++v) {
    if (masses.area(v) > 0) least = std::min(least, value(v));
  }
  for (std::uint32_t v = 0; v < field.size(); ++v) {
    if (masses.area(v) > 0) field.values()[v] = static_cast<float>(value(v) - least);
  }
  return field;
}

/// A symmetric matrix by its columns.
using Columns = std::array<Vec3d, 3>;

Columns second_moments(const Masses& masses) {
  Columns M;
  for (std::uint32_t v = 0; v < masses.areas.size(); ++v) {
    const Vec3d p = masses.from_center(v), weighted = masses.area(v) * p;
    M[0] += weighted * p.x;
    M[1] += weighted * p.y;
    M[2] += weighted * p.z;
  }
  return M;
}

/// The direction of the largest eigenvalue: squared again and again, the matrix keeps no other. Of several
/// that are equal one of them; zero for a matrix of zeros.
Vec3d main_direction(Columns M) {
  constexpr int kSquarings = 40;
  for (int i = 0; i < kSquarings; ++i) {
    const double trace = M[0].x + M[1].y + M[2].z;
    if (!(trace > 0)) return {};
    for (Vec3d& column : M) column = column / trace;
    const Columns A = M;
    for (std::size_t k = 0; k < 3; ++k) M[k] = A[0] * A[k].x + A[1] * A[k].y + A[2] * A[k].z;
  }
  return normalized(*std::max_element(
      M.begin(), M.end(), [](Vec3d a, Vec3d b) { return length_squared(a) < length_squared(b); }));
}

double third_moment(const Masses& masses, Vec3d direction) {
  double sum = 0;
  for (std::uint32_t v = 0; v < masses.areas.size(); ++v) {
    const double x = dot(masses.from_center(v), direction);
    sum += masses.area(v) * x * x * x;
  }
  return sum;
}

VertexField along(const Masses& masses, Vec3d direction) {
  return above_least(masses, [&](std::uint32_t v) { return dot(masses.from_center(v), direction); });
}

}  // namespace

VertexField near_center(const Surface& surface, const Context& context) {
  const Masses masses(surface, context);
  return above_least(masses, [&](std::uint32_t v) { return -length(masses.from_center(v)); });
}

VertexField far_from_center(const Surface& surface, const Context& context) {
  const Masses masses(surface, context);
  return above_least(masses, [&](std::uint32_t v) { return length(masses.from_center(v)); });
}

VertexField along_main_axis(const Surface& surface, const Context& context) {
  const Masses masses(surface, context);
  const Vec3d axis = main_direction(second_moments(masses));
  return along(masses, third_moment(masses, axis) < 0 ? -axis : axis);
}

VertexField along(const Surface& surface, Vec3d direction, const Context& context) {
  return along(Masses(surface, context), normalized(direction));
}

}  // namespace fovea
