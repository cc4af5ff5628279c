#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "fovea/base/context.h"
#include "fovea/surface/closest_point.h"

namespace fovea {

/// How far the points of one surface are from another, in the surfaces' units.
struct Deviation {
  double mean = 0, rms = 0;  ///< Over the area.
  double max = 0;            ///< Over samples and vertices.
};

/// Distances between two surfaces, both ways.
struct SurfaceDistance {
  Deviation forward;   ///< From the reference to the test: what was lost.
  Deviation backward;  ///< From the test to the reference: what was added.
  double mean() const { return 0.5 * (forward.mean + backward.mean); }
  /// Symmetric Hausdorff distance, from below: at most as much too small as samples are apart.
  double hausdorff() const { return forward.max > backward.max ? forward.max : backward.max; }
};

/// Measures with `samples` points on each surface, spread by area (one in each of as many equal shares, the
/// seed is the context's), and all its vertices for the maximum. Infinite if exactly one surface is empty, 0
/// if both are. The same for any number of threads. About O(#samples log #F).
/// Throws Error(cancelled).
SurfaceDistance surface_distance(const Surface& reference, const Surface& test, std::int64_t samples,
                                 const Context& context);

/// A point of a triangle of a surface.
struct SurfaceSample {
  std::uint32_t triangle = 0;
  std::array<double, 3> weights{1, 0, 0};  ///< Of its corners, of sum 1.

  Vec3d on(const Surface& surface) const {
    const auto& t = surface.triangles[triangle];
    return surface.position(t[0]) * weights[0] + surface.position(t[1]) * weights[1] +
           surface.position(t[2]) * weights[2];
  }
};
/// Samples of a surface, spread by area; fewer than `count` only if it has no area.
std::vector<SurfaceSample> surface_samples(const Surface& surface, std::int64_t count, std::uint64_t seed);
/// The same as points.
std::vector<Vec3d> sample_surface(const Surface& surface, std::int64_t count, std::uint64_t seed);

}  // namespace fovea
