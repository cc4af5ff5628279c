#pragma once

#include <vector>

#include "fovea/base/math.h"
#include "fovea/simplify/quadric.h"

/// Slow, literal versions of the formulas behind the collapse engine.
namespace fovea::oracle {

/// A triangle with a weight and one scalar per corner.
struct Sample {
  Vec3d p[3];
  double s[3];
  double weight;
};

/// Squared distance of p to the triangle's plane.
double plane_distance_squared(const Sample& t, Vec3d p);
/// The linear function through the corners' scalars, constant along the normal, at p; found by
/// barycentric coordinates of the projection of p.
double linear_at(const Sample& t, Vec3d p);
/// Σ w (linear_at(p) − s)².
double attribute_error(const std::vector<Sample>& triangles, Vec3d p, double s);
/// The least of `attribute_error` over s, by golden-section search.
double least_attribute_error(const std::vector<Sample>& triangles, Vec3d p);

}  // namespace fovea::oracle
