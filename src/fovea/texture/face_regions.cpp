#include "fovea/texture/face_regions.h"

#include <array>
#include <cstddef>
#include <vector>

#include "fovea/surface/half_edges.h"

namespace fovea {

Segmentation segment_faces(const TriMesh& mesh, std::span<const std::uint32_t> faces,
                           std::span<const Vec3f> colors, const SegmentOptions& options,
                           const Context& context) {
  std::vector<std::array<VertexId, 3>> triangles;
  triangles.reserve(faces.size());
  for (const std::uint32_t face : faces) triangles.push_back(mesh.triangles[face]);
  std::vector<WeightedEdge> edges;
  for_each_edge(sorted_half_edges(triangles), [&](std::span<const HalfEdge> around) {
    for (std::size_t i = 1; i < around.size(); ++i) {
      const std::uint32_t a = around[i - 1].triangle(), b = around[i].triangle();
      edges.push_back({a, b, length(colors[a] - colors[b])});
    }
  });
  return segment_graph(faces.size(), edges, options, context);
}

}  // namespace fovea
