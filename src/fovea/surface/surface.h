#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "fovea/base/context.h"
#include "fovea/base/math.h"
#include "fovea/model/tri_mesh.h"

namespace fovea {

/// Triangles over points, in one space: the shape of a mesh, of a pose or of a whole scene, without anything
/// else. Triangles that share a point are connected.
struct Surface {
  std::vector<Vec3f> positions;                         ///< [#V]
  std::vector<std::array<std::uint32_t, 3>> triangles;  ///< [#F], into `positions`.

  Vec3d position(std::uint32_t v) const { return Vec3d(positions[v]); }
};

/// The triangles of a mesh in its own space. O(#V + #F).
Surface surface_of(const TriMesh& mesh);
/// Appends the triangles of a mesh with its vertices at `positions` [#V]; `turned`: with their winding
/// reversed. O(#V + #F).
void append(Surface& surface, const TriMesh& mesh, std::span<const Vec3f> positions, bool turned = false);

/// Diagonal of the box around the points that triangles use; 0 without triangles. O(#F).
double diagonal(const Surface& surface);

/// The power of two by which points are to be multiplied for the diagonal to lie between 1 and 2, so that
/// squares of lengths are numbers whatever the unit; it costs no precision. 1 without a diagonal. O(#F).
///
/// Throws Error(unsupported) if a triangle has a corner that is not finite.
double unit_scale(const Surface& surface);
/// Multiplies the points; those beyond what floats hold, which no triangle has, stay at its end. O(#V).
void scale(Surface& surface, double factor);

/// What meets at each vertex of a surface: its corners (3 · triangle + 0, 1 or 2) and its neighbours along
/// edges, both in rising order.
class Adjacency {
 public:
  /// O(#V + #F), parallel.
  Adjacency(const Surface& surface, const Context& context);

  std::size_t vertex_count() const { return first_corner_.size() - 1; }
  std::span<const std::uint32_t> corners(std::uint32_t v) const { return list(first_corner_, corners_, v); }
  std::span<const std::uint32_t> neighbors(std::uint32_t v) const {
    return list(first_neighbor_, neighbors_, v);
  }

 private:
  static std::span<const std::uint32_t> list(const std::vector<std::uint32_t>& first,
                                             const std::vector<std::uint32_t>& items, std::uint32_t v) {
    return {items.data() + first[v], items.data() + first[v + 1]};
  }

  std::vector<std::uint32_t> first_corner_, corners_;      // [#V + 1], [#F × 3]
  std::vector<std::uint32_t> first_neighbor_, neighbors_;  // [#V + 1], [2 #E]
};

}  // namespace fovea
