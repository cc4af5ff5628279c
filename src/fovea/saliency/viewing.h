#pragma once

#include <cstdint>

#include "fovea/base/context.h"
#include "fovea/model/field.h"
#include "fovea/surface/surface.h"

namespace fovea {

/// Which way is up.
enum class UpAxis { x, y, z, minus_x, minus_y, minus_z };
Vec3d direction(UpAxis up);

/// Where people stand.
struct ViewRing {
  UpAxis up = UpAxis::y;
  std::int64_t count = 12;    ///< Places evenly around, 1 … 360.
  double elevation_deg = 15;  ///< Of the eye above the horizon.
};

/// How much of each vertex people see that stand on a ring around the surface: the mean over the places of
/// the cosine between its normal and the line of sight, 0 where it faces away or something is in front. From
/// pictures of 256² in parallel projection, to about two pixels along edges of what hides. [#V], 0 … 1. Cost:
/// that of a picture and O(#V) for each place.
VertexField visibility(const Surface& surface, const Adjacency& adjacency, const ViewRing& ring,
                       const Context& context);

}  // namespace fovea
