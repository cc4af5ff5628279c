#include "fovea/surface/half_edges.h"

#include <algorithm>

namespace fovea {

std::vector<HalfEdge> sorted_half_edges(std::span<const std::array<VertexId, 3>> triangles) {
  std::vector<HalfEdge> edges(3 * triangles.size());
  for (std::size_t c = 0; c < edges.size(); ++c) {
    const std::uint64_t from = triangles[c / 3][c % 3].value;
    const std::size_t next = next_corner(c);
    const std::uint64_t to = triangles[next / 3][next % 3].value;
    edges[c] = {std::min(from, to) << 32 | std::max(from, to), static_cast<std::uint32_t>(c), from < to};
  }
  std::sort(edges.begin(), edges.end());
  return edges;
}

}  // namespace fovea
