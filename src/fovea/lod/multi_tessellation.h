#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "fovea/base/context.h"
#include "fovea/model/model.h"
#include "fovea/simplify/record.h"

namespace fovea {

/// The steps of a simplification as a partial order (Multi-Tessellation: De Floriani, Magillo and Puppo
/// 1998).
///
/// A step replaces the triangles around an edge by those around a vertex. It needs the steps before it that
/// made one of the triangles it replaces, or removed one at its ends and left none there that would tell of
/// it, and no others. Any set of steps that holds all that its members need gives a mesh without cracks, in
/// which each triangle is as it was at some time of the simplification: so some places can be coarse and
/// others fine (lod/cut.h).
///
/// Vertices are numbered through over all meshes of the model, see `first_vertex`.
struct MultiTessellation {
  CollapseRecord record;  ///< As it was: steps in the order in which they were taken.

  /// The steps that step s needs: `needs` from needs_end[s − 1] to needs_end[s], each once, ascending.
  std::vector<std::uint32_t> needs_end;
  std::vector<std::uint32_t> needs;
  /// The vertices of the triangles that step s makes, likewise: what it keeps, then its neighbours. If it
  /// makes none, those of the triangles that it removes.
  std::vector<std::uint32_t> corners_end;
  std::vector<std::uint32_t> corners;
  /// How far the triangles that a step makes and the part of the original that they stand for are from each
  /// other, in scene units; at least that of all steps it needs. [#steps]
  std::vector<float> error;

  std::vector<std::uint32_t> first_vertex;  ///< [#meshes + 1]
  std::uint64_t triangles = 0;              ///< Of the original.

  std::size_t step_count() const { return record.steps.size(); }
  std::uint32_t vertex(std::uint32_t mesh, VertexId v) const { return first_vertex[mesh] + v.value; }
  std::span<const std::uint32_t> needs_of(std::size_t s) const { return run(needs, needs_end, s); }
  std::span<const std::uint32_t> corners_of(std::size_t s) const { return run(corners, corners_end, s); }
  /// How many triangles step s removes.
  std::uint32_t removed_by(std::size_t s) const {
    return record.steps[s].faces_end - (s > 0 ? record.steps[s - 1].faces_end : 0);
  }
  std::size_t bytes() const;

 private:
  static std::span<const std::uint32_t> run(const std::vector<std::uint32_t>& list,
                                            const std::vector<std::uint32_t>& end, std::size_t s) {
    const std::size_t begin = s > 0 ? end[s - 1] : 0;
    return {list.data() + begin, end[s] - begin};
  }
};

/// Of the record with which `original` was simplified.
///
/// Errors are measured both ways, for the rest pose. From the original: its vertices and the middles of its
/// edges (of long ones more points) are kept with the triangle that stands for them, and look for the nearest
/// of the new ones when a step replaces that. To the original: three points of each new edge, the middle of
/// each new triangle, and the vertex between them look for the nearest point of the whole mesh. A triangle
/// that faces away from that counts with half of its height, or half of the way to what faces like it. A
/// quarter is added for what lies between the points. What vanishes altogether counts with its diameter.
/// Lengths are those of the largest instance of a mesh.
///
/// O(#F log #F), some 20 µs for each triangle, partly parallel. Throws Error(usage) if the record is of
/// another model, Error(cancelled).
MultiTessellation make_multi_tessellation(const Model& original, CollapseRecord record, Context& context);

/// Of a record whose errors [#steps] are known. O(#F). Throws as above, and Error(usage) for another number
/// of errors.
MultiTessellation make_multi_tessellation(const Model& original, CollapseRecord record,
                                          std::vector<float> error, Context& context);

}  // namespace fovea
