#include "fovea/texture/face_regions.h"

#include <algorithm>
#include <cstddef>
#include <utility>
#include <vector>

namespace fovea {

namespace {

/// An edge of a triangle: its ends, the smaller above, and which of the triangles has it.
using Side = std::pair<std::uint64_t, std::uint32_t>;

std::vector<Side> sorted_sides(const TriMesh& mesh, std::span<const std::uint32_t> faces) {
  std::vector<Side> sides;
  sides.reserve(3 * faces.size());
  for (std::uint32_t i = 0; i < faces.size(); ++i) {
    const auto& triangle = mesh.triangles[faces[i]];
    for (std::size_t k = 0; k < 3; ++k) {
      const auto [low, high] = std::minmax(triangle[k].value, triangle[(k + 1) % 3].value);
      sides.push_back({std::uint64_t{low} << 32 | high, i});
    }
  }
  std::sort(sides.begin(), sides.end());
  return sides;
}

}  // namespace

Segmentation segment_faces(const TriMesh& mesh, std::span<const std::uint32_t> faces,
                           std::span<const Vec3f> colors, const SegmentOptions& options,
                           const Context& context) {
  const std::vector<Side> sides = sorted_sides(mesh, faces);
  std::vector<WeightedEdge> edges;
  for (std::size_t i = 1; i < sides.size(); ++i) {
    if (sides[i - 1].first != sides[i].first) continue;
    const std::uint32_t a = sides[i - 1].second, b = sides[i].second;
    edges.push_back({a, b, length(colors[a] - colors[b])});
  }
  return segment_graph(faces.size(), edges, options, context);
}

}  // namespace fovea
