#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "fovea/model/ids.h"

namespace fovea {

/// Triangles that can lose edges: the connectivity of the collapse engine.
///
/// Nothing is assumed of the surface; an edge is a pair of vertices with any number of triangles. The
/// corners at a vertex form a ring (a circular list, in no geometric order); corner i of triangle f is
/// 3 f + i, and the edge of a corner is the one from its vertex to the next corner's.
///
///            next(c)                    ring of v: its corners, linked by `corner_next`
///              /\                       corner_edge[c]: edge v – w
///   v at c ---/--\                      corner_edge[previous(c)]: edge u – v
struct CollapseMesh {
  std::vector<std::array<std::uint32_t, 3>> face_vertex;  ///< [#F]; a removed face has kInvalid first.
  std::vector<std::uint32_t> corner_next;                 ///< [#F × 3]
  std::vector<std::uint32_t> corner_edge;                 ///< [#F × 3]
  std::vector<std::uint32_t> vertex_corner;               ///< [#V], any corner of it, or kInvalid.
  std::vector<std::array<std::uint32_t, 2>> edge_vertex;  ///< [#E]; a removed edge has kInvalid first.
  std::size_t live_faces = 0;

  CollapseMesh() = default;
  /// Builds rings and edges. O(#F).
  CollapseMesh(std::vector<std::array<std::uint32_t, 3>> faces, std::size_t vertex_count);

  static std::uint32_t next(std::uint32_t c) { return c % 3 == 2 ? c - 2 : c + 1; }
  static std::uint32_t previous(std::uint32_t c) { return c % 3 == 0 ? c + 2 : c - 1; }
  std::uint32_t vertex(std::uint32_t c) const { return face_vertex[c / 3][c % 3]; }
  bool face_alive(std::uint32_t f) const { return face_vertex[f][0] != kInvalid; }
  bool edge_alive(std::uint32_t e) const { return edge_vertex[e][0] != kInvalid; }

  /// Calls f(corner) for the corners at v.
  template <class F>
  void for_ring(std::uint32_t v, F&& f) const {
    const std::uint32_t first = vertex_corner[v];
    if (first == kInvalid) return;
    std::uint32_t c = first;
    do {
      const std::uint32_t following = corner_next[c];
      f(c);
      c = following;
    } while (c != first);
  }

  /// Takes corner c out of the ring of its vertex.
  void unlink_corner(std::uint32_t c);
  /// Marks a face as removed; its corners must be out of the rings already.
  void kill_face(std::uint32_t f) {
    face_vertex[f][0] = kInvalid;
    --live_faces;
  }
  void kill_edge(std::uint32_t e) { edge_vertex[e][0] = kInvalid; }
};

/// Faces on each edge [#E], saturated at 3.
std::vector<std::uint8_t> count_edge_faces(const CollapseMesh& mesh);

/// Connected components through shared vertices, as lists of faces.
struct FaceComponents {
  std::vector<std::uint32_t> first;  ///< [#components + 1], into `faces`.
  std::vector<std::uint32_t> faces;  ///< [#F], sorted by component, then by face.
  std::size_t count() const { return first.size() - 1; }
};
FaceComponents find_components(const CollapseMesh& mesh);

}  // namespace fovea
