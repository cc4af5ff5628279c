#pragma once

#include <cstdint>
#include <vector>

#include "fovea/model/field.h"
#include "fovea/model/model.h"
#include "fovea/surface/pose.h"
#include "fovea/surface/surface.h"

namespace fovea {

/// All meshes of a model as one surface in world space, so that sizes compare: each once, where and as large
/// as it is shown largest. Meshes that nothing shows have their vertices in it and no triangles. Vertices and
/// triangles follow each other mesh by mesh, in the order of the mesh.
struct SceneSurface {
  Surface surface;
  std::vector<std::uint32_t> first_vertex;    ///< [#meshes + 1]
  std::vector<std::uint32_t> first_triangle;  ///< [#meshes + 1]
};

/// O(#V · joints per vertex + #F). Throws Error(limit) beyond 2³² − 1 corners.
SceneSurface scene_surface(const Model& model, const Pose& pose);

/// A field of the scene as one for each mesh.
std::vector<VertexField> split(const SceneSurface& scene, const VertexField& field);
/// And back.
VertexField joined(const std::vector<VertexField>& fields);

}  // namespace fovea
