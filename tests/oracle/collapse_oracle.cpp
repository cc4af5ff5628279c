#include "oracle/collapse_oracle.h"

#include <cmath>

namespace fovea::oracle {

double plane_distance_squared(const Sample& t, Vec3d p) {
  const Vec3d n = normalized(cross(t.p[1] - t.p[0], t.p[2] - t.p[0]));
  return std::pow(dot(n, p - t.p[0]), 2);
}

double linear_at(const Sample& t, Vec3d p) {
  const Vec3d n = cross(t.p[1] - t.p[0], t.p[2] - t.p[0]);
  const double area2 = dot(n, n);
  const double b1 = dot(n, cross(p - t.p[0], t.p[2] - t.p[0])) / area2;
  const double b2 = dot(n, cross(t.p[1] - t.p[0], p - t.p[0])) / area2;
  return (1 - b1 - b2) * t.s[0] + b1 * t.s[1] + b2 * t.s[2];
}

double attribute_error(const std::vector<Sample>& triangles, Vec3d p, double s) {
  double sum = 0;
  for (const Sample& t : triangles) sum += t.weight * std::pow(linear_at(t, p) - s, 2);
  return sum;
}

double least_attribute_error(const std::vector<Sample>& triangles, Vec3d p) {
  double low = -1e3, high = 1e3;
  const double golden = (std::sqrt(5.0) - 1) / 2;
  for (int i = 0; i < 200; ++i) {
    const double a = high - golden * (high - low), b = low + golden * (high - low);
    if (attribute_error(triangles, p, a) < attribute_error(triangles, p, b)) {
      high = b;
    } else {
      low = a;
    }
  }
  return attribute_error(triangles, p, (low + high) / 2);
}

}  // namespace fovea::oracle
