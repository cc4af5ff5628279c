#pragma once

#include <cstdint>
#include <vector>

#include "fovea/model/field.h"
#include "fovea/model/tri_mesh.h"

namespace fovea {

/// Edges of a mesh by what lies on them. An edge is a pair of vertices that some triangle joins.
struct EdgeCounts {
  std::uint64_t total = 0;
  std::uint64_t boundary = 0;      ///< One triangle.
  std::uint64_t interior = 0;      ///< Two triangles of opposite direction: the manifold case.
  std::uint64_t non_manifold = 0;  ///< Three or more, or two that disagree in orientation.
  std::uint64_t seam = 0;          ///< Interior, but some layer has different values on its two sides.
  std::uint64_t part_border = 0;   ///< Interior, between triangles of two parts.
};

/// O(#F log #F).
EdgeCounts count_edges(const TriMesh& mesh);

/// Connected components through shared vertices: an index per face, numbered by first face.
struct Components {
  Field<FaceId, std::uint32_t> of_face;  ///< [#F]
  std::uint32_t count = 0;
};
Components components(const TriMesh& mesh);

/// Vertices whose triangles form more than one fan (bow ties).
std::uint64_t count_bow_ties(const TriMesh& mesh);

}  // namespace fovea
