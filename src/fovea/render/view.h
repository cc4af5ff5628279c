#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "fovea/base/math.h"
#include "fovea/base/options.h"

namespace fovea {

/// Where a picture is taken from, in world space: an eye that looks along −back.
struct View {
  std::string name;
  Vec3d eye;
  Vec3d right{1, 0, 0}, up{0, 1, 0}, back{0, 0, 1};  ///< Orthonormal, right-handed.
  bool perspective = true;
  double half_height = 1;  ///< Of what is seen: at distance 1 in perspective, anywhere else in parallel.
  double near = 0;         ///< Nothing closer to the eye's plane is seen.
  double aspect = 1;       ///< Width over height of what is seen, where a picture is not given both.

  /// World to eye: x to the right, y up, z the distance in front of the eye.
  Vec3d to_eye(Vec3d p) const {
    const Vec3d d = p - eye;
    return {dot(right, d), dot(up, d), -dot(back, d)};
  }
};

/// Pixels across a picture of a view, from the pixels along its height.
int picture_width(const View& view, std::int64_t height);

/// Directions to look from.
enum class ViewSet {
  tetrahedron,          ///< The vertices of the solid: 4,
  cube,                 ///< 8,
  octahedron,           ///< 6,
  dodecahedron,         ///< 20,
  icosahedron,          ///< 12,
  rhombicuboctahedron,  ///< 24: permutations of (±1, ±1, ±(1 + √2)), the protocol of Yang et al. 2016.
  fibonacci,            ///< `count` points spread evenly over the sphere on a spiral.
  orbit,                ///< `count` points around the upright axis at `elevation_deg`.
  cameras,              ///< The model's own, `count` places along the path of one that an animation moves.
};

struct ViewOptions {
  ViewSet set = ViewSet::rhombicuboctahedron;
  std::int64_t count = 24;    ///< Of `fibonacci` and `orbit`, and of a camera's path.
  double elevation_deg = 15;  ///< Of `orbit`, above the horizon.
  double fov_deg = 30;        ///< Vertical angle of view; 0 for parallel projection.
  double margin = 0;          ///< Free border around the sphere, of its radius.
};
OptionList describe(ViewOptions& options);

/// Unit vectors from the centre to the eyes of a set, in a fixed order; +y is up. Empty for `cameras`.
std::vector<Vec3d> directions(const ViewOptions& options);

/// A view from each direction onto the sphere, which just fits the height of the picture.
std::vector<View> make_views(const ViewOptions& options, const Sphere& sphere);

/// An upright view along `-direction` (unit) onto the sphere.
View view_onto(const Sphere& sphere, Vec3d direction, double fov_deg, double margin);

/// An upright view from a point onto another; they must differ. Parallel (fov_deg 0) it is as high as the
/// points are apart.
View view_from(Vec3d eye, Vec3d target, double fov_deg);

}  // namespace fovea
