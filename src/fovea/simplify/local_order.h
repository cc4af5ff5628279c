#pragma once

#include <cstdint>
#include <vector>

#include "fovea/model/tri_mesh.h"

namespace fovea {

/// The vertices and triangles of a mesh in an order in which what is near on the surface is near in memory.
struct LocalOrder {
  std::vector<VertexId> vertices;  ///< [#V], each once.
  std::vector<FaceId> faces;       ///< [#F], each once.
};

/// The mesh's own order where most corners are near the one before, as in files made for drawing. Else, as
/// in many scans and exports, vertices along a Z-order curve through their box, and triangles by their first
/// vertex on it. O(#V + #F).
LocalOrder local_order(const TriMesh& mesh);

}  // namespace fovea
