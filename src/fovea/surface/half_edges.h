#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "fovea/model/ids.h"

// Shared inside Fovea, not installed.

namespace fovea {

inline std::size_t next_corner(std::size_t c) { return c % 3 == 2 ? c - 2 : c + 1; }

/// The edge from a corner's vertex to that of the next corner of its triangle.
struct HalfEdge {
  std::uint64_t ends = 0;  ///< Smaller vertex above, larger below: the same for both directions.
  std::uint32_t corner = 0;
  bool forward = true;  ///< From the smaller to the larger vertex.
  friend bool operator<(const HalfEdge& a, const HalfEdge& b) {
    return std::pair(a.ends, a.corner) < std::pair(b.ends, b.corner);
  }
  std::uint32_t triangle() const { return corner / 3; }
  /// Corners of the triangle at the smaller and the larger end.
  std::size_t low_corner() const { return forward ? corner : next_corner(corner); }
  std::size_t high_corner() const { return forward ? next_corner(corner) : corner; }
};

/// The half-edges of triangles, those of an edge together. Corners are numbered through the list.
/// O(#triangles log #triangles).
std::vector<HalfEdge> sorted_half_edges(std::span<const std::array<VertexId, 3>> triangles);

/// Calls `f` with the half-edges of each edge.
template <class F>
void for_each_edge(std::span<const HalfEdge> sorted, F&& f) {
  for (std::size_t begin = 0, end = 0; begin < sorted.size(); begin = end) {
    while (end < sorted.size() && sorted[end].ends == sorted[begin].ends) ++end;
    f(sorted.subspan(begin, end - begin));
  }
}

}  // namespace fovea
