#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include <span>
#include <vector>

#include "fovea/base/math.h"
#include "fovea/model/ids.h"
#include "fovea/simplify/quadric.h"

namespace fovea {

/// A triangle of the engine.
struct CollapseFace {
  std::array<std::uint32_t, 3> vertex;  ///< kInvalid first if the face is gone.
  std::array<std::uint32_t, 3> edge;    ///< Edge from this corner's vertex to the next corner's.
};

/// A vertex of the engine: all that the price of an edge needs of its end, one cache line.
struct alignas(64) CollapseVertex {
  Vec3f position;                    ///< In units of the scene's diagonal, around the mesh's centre.
  std::uint32_t ring_begin = 0;      ///< Where its ring begins in CollapseMesh::corners.
  std::uint32_t ring_size : 28 = 0;  ///< Corners in its ring; 0 without triangles.
  std::uint32_t spare : 2 = 0;       ///< How often the room of its ring can be halved and still hold it.
  std::uint32_t locked : 1 = 0;      ///< Must stay where it is.
  std::uint32_t refused : 1 = 0;     ///< An edge at it was refused since something changed around it.
  VertexQuadric quadric;

  /// Corners that its ring has room for: a power of two.
  std::uint32_t room() const { return std::bit_ceil(std::uint32_t{ring_size}) << spare; }
};

/// An edge of the engine, with the half-edges of its triangles (a half-edge is the corner that it starts
/// from); gone when none is left. Where more than two triangles meet they are only counted.
struct alignas(16) CollapseEdge {
  std::array<std::uint32_t, 2> ends;
  std::array<std::uint32_t, 2> half_edges = {kInvalid, kInvalid};  ///< Or their number and kCounted.

  static constexpr std::uint32_t kCounted = kInvalid - 1;
  bool is_listed() const { return half_edges[1] != kCounted; }
  std::uint32_t face_count() const {
    return is_listed() ? (half_edges[0] != kInvalid) + (half_edges[1] != kInvalid) : half_edges[0];
  }
  void add(std::uint32_t half_edge) {
    if (!is_listed()) {
      ++half_edges[0];
    } else if (half_edges[0] == kInvalid) {
      half_edges[0] = half_edge;
    } else if (half_edges[1] == kInvalid) {
      half_edges[1] = half_edge;
    } else {
      half_edges = {3, kCounted};
    }
  }
  void remove(std::uint32_t half_edge) {
    if (!is_listed()) {
      --half_edges[0];
    } else {
      half_edges = {half_edges[0] == half_edge ? half_edges[1] : half_edges[0], kInvalid};
    }
  }
};

/// What the triangle at a corner has on its other two corners.
struct CornerView {
  std::uint32_t next, previous;        ///< Vertices.
  std::uint32_t to_next, to_previous;  ///< Edges from the corner's vertex to these.
};

/// The triangles on an edge a–b, as pairs of their corners at a and at b; of more than a few, some.
struct EdgeCorners {
  static constexpr std::size_t kMost = 8;
  std::array<std::array<std::uint32_t, 2>, kMost> pairs;
  std::size_t count = 0;
};

/// Triangles that can lose edges: the connectivity of the collapse engine.
///
/// Nothing is assumed of the surface; an edge is a pair of vertices with any number of triangles. The
/// corners at a vertex form its ring (a list in no geometric order, contiguous so that all its triangles
/// can be fetched at once); corner i of triangle f is 3 f + i.
///
///            next(c)                    ring of v: its corners
///              /\                       edge of c: v – w
///   v at c ---/--\                      edge of previous(c): u – v
struct CollapseMesh {
  std::vector<CollapseFace> faces;       ///< [#F]
  std::vector<CollapseVertex> vertices;  ///< [#V]
  std::vector<CollapseEdge> edges;       ///< [#E]
  std::vector<std::uint32_t> corners;    ///< The rings, with gaps.
  std::size_t live_faces = 0;

  /// Builds rings and edges from `vertex` of all faces, which are distinct. O(#F).
  void link();

  // Calculated rather than chosen: compilers make branches of choices, and nothing foretells these. The two
  // constants are lists of two-bit numbers, for the corners 0, 1 and 2: 1 2 0 and 2 0 1.
  static std::uint32_t after(std::uint32_t k) { return 0b00'10'01 >> 2 * k & 3; }
  static std::uint32_t before(std::uint32_t k) { return 0b01'00'10 >> 2 * k & 3; }
  static std::uint32_t next(std::uint32_t c) { return c - c % 3 + after(c % 3); }
  static std::uint32_t previous(std::uint32_t c) { return c - c % 3 + before(c % 3); }
  std::uint32_t vertex(std::uint32_t c) const { return faces[c / 3].vertex[c % 3]; }
  std::uint32_t edge(std::uint32_t c) const { return faces[c / 3].edge[c % 3]; }
  std::uint32_t& edge(std::uint32_t c) { return faces[c / 3].edge[c % 3]; }
  CornerView view(std::uint32_t c) const {
    const CollapseFace& face = faces[c / 3];
    const std::uint32_t k = c % 3, n = after(k), p = before(k);
    return {face.vertex[n], face.vertex[p], face.edge[k], face.edge[p]};
  }
  Vec3d position(std::uint32_t v) const { return Vec3d(vertices[v].position); }
  /// The error over the position of a vertex; what attributes can make up for is not taken off.
  Quadric quadric(std::uint32_t v) const { return vertices[v].quadric.around_origin(position(v)); }
  void set_quadric(std::uint32_t v, const Quadric& q) { vertices[v].quadric = {q, position(v)}; }
  bool face_alive(std::uint32_t f) const { return faces[f].vertex[0] != kInvalid; }
  bool edge_alive(std::uint32_t e) const { return edges[e].face_count() > 0; }

  /// The corners at v. Valid until a ring changes.
  std::span<const std::uint32_t> ring(std::uint32_t v) const {
    return {corners.data() + vertices[v].ring_begin, vertices[v].ring_size};
  }
  /// Calls f(corner) for the corners at v.
  template <class F>
  void for_ring(std::uint32_t v, F&& f) const {
    for (const std::uint32_t c : ring(v)) f(c);
  }

  /// The triangles on edge e, of which a is one end. O(1); O(valence) where more than two meet.
  EdgeCorners edge_corners(std::uint32_t e, std::uint32_t a) const;

  /// Takes corner c out of the ring of its vertex.
  void unlink_corner(std::uint32_t c);
  /// Gives the corners at a to b; a has none from then on.
  void join_rings(std::uint32_t a, std::uint32_t b);
  /// Marks a face as removed; its corners must be out of the rings already.
  void kill_face(std::uint32_t f) {
    faces[f].vertex[0] = kInvalid;
    --live_faces;
  }

 private:
  void link_rings();
  void link_edges();
  /// Where there is room for so many corners, a power of two.
  std::uint32_t take_room(std::uint32_t room);
  void give_room(std::uint32_t begin, std::uint32_t room);

  std::vector<std::uint32_t> free_room_;  // [log2 of room], first of a list linked through `corners`
};

/// Connected components through shared vertices, as lists of faces.
struct FaceComponents {
  std::vector<std::uint32_t> first;  ///< [#components + 1], into `faces`.
  std::vector<std::uint32_t> faces;  ///< [#F], sorted by component, then by face.
  std::size_t count() const { return first.size() - 1; }
};
FaceComponents find_components(const CollapseMesh& mesh);

}  // namespace fovea
