#pragma once

#include <cstdint>
#include <vector>

#include "fovea/base/math.h"
#include "fovea/model/field.h"
#include "fovea/model/model.h"
#include "fovea/surface/pose.h"

namespace fovea {

/// Parts of the scene that somebody looks at closely, from wherever.
struct AttentionRegions {
  std::vector<Sphere> spheres;
  std::vector<Box> boxes;
  bool empty() const { return spheres.empty() && boxes.empty(); }
};

/// Whether a triangle reaches into one of the regions; touching their borders counts. O(#regions).
bool reaches_into(const AttentionRegions& regions, Vec3d a, Vec3d b, Vec3d c);

/// Lets no more than `factor` of the error at the vertices of all triangles that reach into a region, as any
/// instance shows them in this pose. `shares` [#meshes][#V] are those of `allowed_shares`, or 1: what is less
/// stays. Returns how many triangles do. So a triangle of a level (lod/cut.h) that stands for something in a
/// region keeps to that. O(#F · #regions).
std::uint64_t attend_regions(const Model& model, const Pose& pose, const AttentionRegions& regions,
                             float factor, std::vector<VertexField>& shares);

}  // namespace fovea
