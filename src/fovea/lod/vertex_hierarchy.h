#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "fovea/base/context.h"
#include "fovea/base/math.h"
#include "fovea/lod/multi_tessellation.h"
#include "fovea/model/model.h"

namespace fovea {

/// The vertices of all levels of a mesh as graphics cards want them: a position and one value of each layer.
/// None of them ever changes.
struct LevelVertices {
  std::vector<Vec3f> positions;                     ///< [#vertices]
  std::vector<std::vector<Vec3f>> position_morphs;  ///< [#targets][#vertices]
  /// Values and morphs [#vertices × width] without `corner_value`. 0 where a part lacks the layer.
  std::vector<AttributeLayer> layers;
};

/// Triangles of a mesh that are drawn together, as they have one material.
struct LevelPart {
  std::uint32_t mesh = 0, part = 0;
  std::uint32_t first_face = 0, end_face = 0;  ///< In `VertexHierarchy::corners`.
};

/// What becomes of each vertex from level to level: a forest in which steps of a simplification replace
/// vertices by others, their parents (progressive meshes: Hoppe 1996; vertex hierarchies: Xia and Varshney
/// 1996).
///
/// The level of a cut (cut.h) is read by following the corners of the original's triangles to the first
/// vertex that no taken step replaces (contraction.h).
struct VertexHierarchy {
  std::vector<LevelVertices> vertices;  ///< [#meshes]
  std::vector<LevelPart> parts;         ///< With triangles, mesh by mesh.

  // Nodes are numbered through over all meshes, those that are replaced first before others, so that a
  // parent's number is above that of its children.
  std::vector<std::uint32_t> vertex;  ///< [#nodes], in `vertices` of its mesh.
  std::vector<std::uint32_t> parent;  ///< [#nodes], kInvalid for those of the coarsest level.
  std::vector<std::uint32_t> step;    ///< [#nodes], that replaces it by its parent; kInvalid likewise.
  std::size_t step_count = 0;         ///< Of the levels.
  std::uint32_t depth = 0;            ///< Most replacements of a vertex, one after the other.

  // Triangles of the original, part by part.
  std::vector<std::array<std::uint32_t, 3>> corners;  ///< [#F], nodes.
  std::vector<std::uint32_t> removed_by;              ///< [#F], the step; kInvalid for the coarsest level's.

  std::size_t node_count() const { return vertex.size(); }
  std::size_t face_count() const { return corners.size(); }
};

/// Of a model and its levels, which may move vertices. O(#F · #layers). Throws Error(usage) if the levels are
/// of another model, Error(cancelled).
VertexHierarchy make_vertex_hierarchy(const Model& original, const MultiTessellation& levels,
                                      Context& context);

}  // namespace fovea
