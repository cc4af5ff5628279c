#pragma once

#include <vector>

#include "fovea/model/model.h"
#include "fovea/surface/surface.h"

namespace fovea {

// Poses that come as files of their own have the same vertices and triangles, in the same order. Reading
// welds vertices by position, so two that meet in one pose only are one vertex there and two elsewhere, and
// triangles between them are gone there. Poses are therefore compared by the vertices of their files
// (TriMesh::source_vertex), and the welding of the first counts.

/// For each vertex of `first` the one of `other` that holds the same vertex of their files: the earliest, if
/// `first` welded several. A mesh that came from no file is its own source. [#V of first].
///
/// Throws Error(unsupported) with the first difference if the files have not the same number of vertices or
/// not the same triangles in the same order. Triangles are compared up to what either welding merged; what
/// both merged cannot be compared any more. O(#V + #F).
std::vector<VertexId> corresponding_vertices(const TriMesh& first, const TriMesh& other);

/// The surfaces of a model in one pose with the vertices and triangles of the first pose's meshes, each as
/// the model's first instance shows it at rest, or in its own space where nothing shows it. [#meshes].
/// `surfaces_in(first, first)` are those of the first pose itself.
///
/// Throws Error(unsupported) as `corresponding_vertices`, with the mesh's number, or if there are more or
/// fewer meshes.
std::vector<Surface> surfaces_in(const Model& first, const Model& pose);

}  // namespace fovea
