#pragma once

#include <cstdint>
#include <vector>

#include "fovea/model/field.h"
#include "fovea/surface/surface.h"

namespace fovea {

/// The vertices and triangles of a surface in an order in which what is near on the surface is near in
/// memory.
struct LocalOrder {
  std::vector<VertexId> vertices;  ///< [#V], each once.
  std::vector<FaceId> faces;       ///< [#F], each once.
};

/// The surface's own order where most corners are near the one before, as in files made for drawing. Else, as
/// in many scans and exports, vertices along a Z-order curve through their box, and triangles by their first
/// vertex on it. O(#V + #F).
LocalOrder local_order(const Surface& surface);

/// The surface with its vertices and triangles in that order. O(#V + #F).
Surface reordered(const Surface& surface, const LocalOrder& order);
/// A field of the surface as one of the reordered surface.
VertexField in_order(const VertexField& field, const LocalOrder& order);
/// A field of the reordered surface as one of the surface itself.
VertexField in_own_order(const VertexField& field, const LocalOrder& order);

}  // namespace fovea
