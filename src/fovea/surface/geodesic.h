#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "fovea/base/context.h"
#include "fovea/surface/surface.h"

namespace fovea {

/// A surface prepared for shortest paths over its triangles.
///
/// Triangles need not form a manifold: a path goes on from a triangle into every other one on the same edge.
/// Triangles without area are walked around.
class GeodesicSurface {
 public:
  /// `adjacency` must outlive this. O(#F), partly parallel. 168 bytes per triangle.
  GeodesicSurface(const Surface& surface, const Adjacency& adjacency, const Context& context);

  std::size_t vertex_count() const { return bends_.size(); }

 private:
  friend class GeodesicSearch;

  /// A triangle from one of its edges, in the plane: the edge runs from (0, 0) to (length, 0), the opposite
  /// corner lies at `apex`, above.
  struct HalfEdge {
    std::uint32_t from = 0, to = 0, opposite = 0;  ///< Vertices.
    std::uint32_t twin = kInvalid;  ///< Next half-edge on the same edge, in a circle; itself if alone.
    double length = 0;
    Vec2d apex;
    double angle = 0;  ///< At `from`; 0 in triangles without area.
    double turn = 0;   ///< Of the edge in the fan of triangles around `from`, where paths bend inside of it.
  };
  /// Where a shortest path can bend.
  enum class Bend : std::uint8_t {
    never,     ///< Flat or convex.
    inside,    ///< A saddle with one closed fan of triangles: only into the shadow behind it.
    anywhere,  ///< Borders, edges of many triangles, and what is no plain fan.
  };

  void link_edges();
  void judge(std::uint32_t vertex);

  std::vector<HalfEdge> half_edges_;  // [#F × 3], number 3 f + i from corner i
  std::vector<Bend> bends_;           // [#V]
  std::vector<double> full_turn_;     // [#V], all angles around
  const Adjacency& adjacency_;
};

/// Exact distances over a surface from one vertex, up to a radius.
///
/// Straight lines are unfolded from triangle to triangle in windows, nearest first (Chen and Han 1990 with
/// the queue and the filter of Xin and Wang 2009). At borders a shortest path can bend, there new fans begin;
/// at saddles too, but only into the shadow that straight lines past them leave, which is as wide as the
/// angle around them is more than a full turn. Holds what one search needs at a time: one per thread, used
/// again and again.
class GeodesicSearch {
 public:
  struct Reached {
    std::uint32_t vertex = 0;
    double distance = 0;
  };

  explicit GeodesicSearch(const GeodesicSurface& surface);

  /// The vertices within `radius` of `source`, itself first, in the order in which they were found. Valid
  /// until the next call. Exact up to rounding (about 1e−12 of the radius). Cost grows with the number of
  /// windows: a few for each edge within the radius.
  std::span<const Reached> from(std::uint32_t source, double radius);

 private:
  using HalfEdge = GeodesicSurface::HalfEdge;
  using Bend = GeodesicSurface::Bend;

  /// Straight lines that enter a triangle through a part of its edge, from a point on the other side.
  struct Window {
    std::uint32_t half_edge = 0;
    double begin = 0, end = 0;  ///< Along the edge.
    Vec2d source;               ///< y < 0.
    double before = 0;          ///< Distance to that point.
  };
  struct VertexState {
    double distance = 0;  ///< Where `seen` is the search's turn.
    std::uint32_t seen = 0;
    std::uint32_t number = 0;  ///< In what was reached.
  };
  // What waits, by the least distance that it can give: nearest first but for the width of a bucket, as the
  // order costs work and no exactness.
  static constexpr std::size_t kBuckets = 64;
  struct Bucket {
    std::vector<Window> windows;
    std::vector<std::uint32_t> vertices;  ///< Where paths bend.
  };

  template <class Backward>
  void reach(std::uint32_t vertex, double distance, Backward&& backward);
  void spread(std::uint32_t vertex);
  void reach_neighbors(std::uint32_t corner, double before);
  void shine(std::uint32_t corner, double before, double from_angle, double to_angle);
  void advance(const Window& window);
  void cross_edge(std::uint32_t half_edge, const Window& window);
  void add(Window window);
  bool is_useless(const Window& window) const;
  double distance(std::uint32_t vertex) const;
  Bucket& bucket(double distance) {
    return buckets_[std::min(static_cast<std::size_t>(distance * buckets_per_length_), kBuckets - 1)];
  }

  const GeodesicSurface& surface_;
  double radius_ = 0, buckets_per_length_ = 0;
  std::vector<VertexState> vertices_;  // [#V]
  std::vector<double> backward_;       // [#V], the direction in the fan that its shortest path comes from
  std::uint32_t turn_ = 0;
  std::vector<char> waiting_;  // [#V], to spread
  std::array<Bucket, kBuckets> buckets_;
  std::vector<Reached> reached_;
};

}  // namespace fovea
