#pragma once

#include <vector>

#include "fovea/base/math.h"
#include "fovea/model/model.h"
#include "fovea/surface/pose.h"

namespace fovea::test {

/// Root-mean-square distance of two shapes at its least over rigid motions: turns one of them about x, y and
/// z, each time by the best angle, until nothing gets better; the best of several beginnings.
double rigid_distance(const std::vector<Vec3d>& a, const std::vector<Vec3d>& b);

/// All vertices of all instances as a pose shows them.
std::vector<Vec3d> shown_points(const Model& model, const Pose& pose);

/// Of every shape to every other.
std::vector<std::vector<double>> all_distances(const std::vector<std::vector<Vec3d>>& poses);

/// Farthest-point sampling by its words, from the pose with the least sum of squared distances on: numbers of
/// poses in their order, while any is farther than `least` from all chosen.
std::vector<std::size_t> farthest_points(const std::vector<std::vector<double>>& distances, std::size_t count,
                                         double least);

}  // namespace fovea::test
