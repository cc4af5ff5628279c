#include "fovea/surface/geodesic.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "fovea/base/parallel.h"

namespace fovea {

namespace {

constexpr std::size_t kHalfEdgeGrain = 1 << 12;
/// Angles around a vertex that are more than a full turn by no more than this are flat but for rounding.
constexpr double kFlat = 1e-9;
/// Windows narrower than this part of their edge carry nothing that rounding has not made.
constexpr double kNarrow = 1e-12;

double norm(Vec2d v) { return std::sqrt(v.x * v.x + v.y * v.y); }

}  // namespace

// --- The surface --------------------------------------------------------------------------------------

GeodesicSurface::GeodesicSurface(const Surface& surface, const Adjacency& adjacency, const Context& context)
    : half_edges_(3 * surface.triangles.size()),
      bends_(surface.positions.size(), Bend::never),
      full_turn_(surface.positions.size(), 0),
      adjacency_(adjacency) {
  parallel_for(context, surface.triangles.size(), kHalfEdgeGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t f = begin; f < end; ++f) {
      const auto& t = surface.triangles[f];
      for (std::size_t k = 0; k < 3; ++k) {
        HalfEdge& h = half_edges_[3 * f + k];
        h.from = t[k], h.to = t[(k + 1) % 3], h.opposite = t[(k + 2) % 3];
        const Vec3d p = surface.position(h.from), edge = surface.position(h.to) - p,
                    side = surface.position(h.opposite) - p;
        h.length = length(edge);
        const double area = length(cross(edge, side));
        if (!(area > 0)) continue;
        h.apex = {dot(edge, side) / h.length, area / h.length};
        h.angle = std::atan2(h.apex.y, h.apex.x);
      }
    }
  });
  link_edges();
  // Fans of different vertices have different half-edges.
  parallel_for(context, bends_.size(), kHalfEdgeGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t v = begin; v < end; ++v) judge(static_cast<std::uint32_t>(v));
  });
}

/// Puts the half-edges of each edge in a circle.
void GeodesicSurface::link_edges() {
  const auto ends = [&](std::uint32_t h) { return std::minmax(half_edges_[h].from, half_edges_[h].to); };
  std::vector<std::uint32_t> here;
  for (std::uint32_t v = 0; v < bends_.size(); ++v) {
    // Those of which v is the lower end: at each corner the edge to the next corner and that from the one
    // before.
    here.clear();
    for (const std::uint32_t c : adjacency_.corners(v)) {
      for (const std::uint32_t h : {c, c - c % 3 + (c + 2) % 3}) {
        if (ends(h).first == v) here.push_back(h);
      }
    }
    std::sort(here.begin(), here.end(), [&](std::uint32_t a, std::uint32_t b) {
      return std::pair(ends(a).second, a) < std::pair(ends(b).second, b);
    });
    for (std::size_t begin = 0, end = 0; begin < here.size(); begin = end) {
      while (end < here.size() && ends(here[end]) == ends(here[begin])) ++end;
      for (std::size_t i = begin; i < end; ++i) half_edges_[here[i]].twin = here[i + 1 < end ? i + 1 : begin];
    }
  }
}

/// Finds out whether paths bend at a vertex, and orders its fan if it has one.
void GeodesicSurface::judge(std::uint32_t vertex) {
  const std::span<const std::uint32_t> corners = adjacency_.corners(vertex);
  if (corners.empty()) return;
  double turn = 0;
  std::uint32_t c = corners[0];
  for (std::size_t i = 0; i < corners.size(); ++i) {
    HalfEdge& h = half_edges_[c];
    if (!(h.angle > 0)) break;
    h.turn = turn;
    turn += h.angle;
    // Across the edge that comes in.
    const std::uint32_t in = c - c % 3 + (c + 2) % 3, next = half_edges_[in].twin;
    const bool is_plain = next != in && half_edges_[next].twin == in && half_edges_[next].from == vertex;
    if (!is_plain || (next == corners[0]) != (i + 1 == corners.size())) break;
    c = next;
    if (i + 1 < corners.size()) continue;
    full_turn_[vertex] = turn;
    bends_[vertex] = turn > 2 * std::numbers::pi * (1 + kFlat) ? Bend::inside : Bend::never;
    return;
  }
  bends_[vertex] = Bend::anywhere;
}

// --- Searching ----------------------------------------------------------------------------------------

GeodesicSearch::GeodesicSearch(const GeodesicSurface& surface)
    : surface_(surface),
      vertices_(surface.vertex_count()),
      backward_(surface.vertex_count(), 0),
      waiting_(surface.vertex_count(), 0) {}

[[gnu::always_inline]] inline double GeodesicSearch::distance(std::uint32_t vertex) const {
  const VertexState& state = vertices_[vertex];
  return state.seen == turn_ ? state.distance : std::numeric_limits<double>::infinity();
}

std::span<const GeodesicSearch::Reached> GeodesicSearch::from(std::uint32_t source, double radius) {
  if (++turn_ == 0) {  // after 2³² searches numbers come again
    for (VertexState& state : vertices_) state.seen = 0;
    turn_ = 1;
  }
  radius_ = radius;
  buckets_per_length_ = radius > 0 ? kBuckets / radius : 0;
  reached_.clear();
  vertices_[source] = {0, turn_, 0};
  reached_.push_back({source, 0});
  for (const std::uint32_t c : surface_.adjacency_.corners(source)) {
    reach_neighbors(c, 0);
    shine(c, 0, 0, surface_.half_edges_[c].angle);
  }
  for (Bucket& now : buckets_) {
    while (!now.windows.empty() || !now.vertices.empty()) {
      if (!now.vertices.empty()) {
        const std::uint32_t vertex = now.vertices.back();
        now.vertices.pop_back();
        if (std::exchange(waiting_[vertex], 0) != 0) spread(vertex);
      } else {
        const Window window = now.windows.back();
        now.windows.pop_back();
        if (!is_useless(window)) advance(window);
      }
    }
  }
  return reached_;
}

template <class Backward>
void GeodesicSearch::reach(std::uint32_t vertex, double distance, Backward&& backward) {
  if (distance > radius_) return;
  VertexState& state = vertices_[vertex];
  if (state.seen != turn_) {
    state.seen = turn_;
    state.number = static_cast<std::uint32_t>(reached_.size());
    reached_.push_back({vertex, distance});
  } else if (distance < state.distance) {
    reached_[state.number].distance = distance;
  } else {
    return;
  }
  state.distance = distance;
  if (surface_.bends_[vertex] == Bend::never) return;
  backward_[vertex] = backward();
  waiting_[vertex] = 1;
  bucket(distance).vertices.push_back(vertex);
}

/// Begins straight lines at a vertex where paths bend.
void GeodesicSearch::spread(std::uint32_t vertex) {
  const double before = vertices_[vertex].distance;
  if (surface_.bends_[vertex] == Bend::anywhere) {
    for (const std::uint32_t c : surface_.adjacency_.corners(vertex)) {
      reach_neighbors(c, before);
      shine(c, before, 0, surface_.half_edges_[c].angle);
    }
    return;
  }
  // The shadow: half a turn and more from where the path comes from, on either side.
  const double full = surface_.full_turn_[vertex], slack = kFlat * full;
  const double begin = std::fmod(backward_[vertex] + std::numbers::pi, full) - slack,
               end = begin + full - 2 * std::numbers::pi + 2 * slack;
  for (const std::uint32_t c : surface_.adjacency_.corners(vertex)) {
    reach_neighbors(c, before);
    const HalfEdge& h = surface_.half_edges_[c];
    for (const double turn : {h.turn - full, h.turn, h.turn + full}) {
      const double from = std::max(begin - turn, 0.0), to = std::min(end - turn, h.angle);
      if (from < to) shine(c, before, from, to);
    }
  }
}

/// The two other vertices of a triangle, along its edges from a corner.
void GeodesicSearch::reach_neighbors(std::uint32_t corner, double before) {
  const std::uint32_t first = corner - corner % 3;
  const HalfEdge &out = surface_.half_edges_[corner], &next = surface_.half_edges_[first + (corner + 1) % 3],
                 &in = surface_.half_edges_[first + (corner + 2) % 3];
  reach(out.to, before + out.length, [&] { return next.turn + next.angle; });
  reach(in.from, before + in.length, [&] { return in.turn; });
}

/// Straight lines from a corner into its triangle, between two angles from its first edge.
void GeodesicSearch::shine(std::uint32_t corner, double before, double from_angle, double to_angle) {
  const HalfEdge& h = surface_.half_edges_[corner];
  if (!(h.angle > 0)) return;
  const std::uint32_t number = corner - corner % 3 + (corner + 1) % 3;
  const HalfEdge& across = surface_.half_edges_[number];
  // By the law of sines in the triangle of the corner, the edge's start and the ray's end.
  const auto along = [&](double angle) {
    return h.length * std::sin(angle) / std::sin(std::numbers::pi - angle - across.angle);
  };
  const double begin = from_angle > 0 ? along(from_angle) : 0,
               end = to_angle < h.angle ? along(to_angle) : across.length;
  cross_edge(number, {number, begin, end, across.apex, before});
}

// What follows is done for every window, and inline a fifth faster.

/// A window that leaves a triangle through half-edge h, in the triangle's own frame of h (source above): it
/// enters all other triangles there.
void GeodesicSearch::cross_edge(std::uint32_t half_edge, const Window& window) {
  const HalfEdge& h = surface_.half_edges_[half_edge];
  for (std::uint32_t t = h.twin; t != half_edge; t = surface_.half_edges_[t].twin) {
    const HalfEdge& other = surface_.half_edges_[t];
    if (!(other.angle > 0)) continue;
    Window entered{t, window.begin, window.end, {window.source.x, -window.source.y}, window.before};
    if (other.from != h.from) {  // the other way round, as on any oriented surface
      entered.begin = h.length - window.end;
      entered.end = h.length - window.begin;
      entered.source.x = h.length - window.source.x;
    }
    add(entered);
  }
}

[[gnu::always_inline]] inline void GeodesicSearch::add(Window window) {
  const HalfEdge& h = surface_.half_edges_[window.half_edge];
  window.begin = std::max(window.begin, 0.0);
  window.end = std::min(window.end, h.length);
  if (window.end - window.begin <= kNarrow * h.length) return;
  const double nearest = std::clamp(window.source.x, window.begin, window.end) - window.source.x;
  // Squares are compared where they can be: most windows end here.
  const double least2 = nearest * nearest + window.source.y * window.source.y, left = radius_ - window.before;
  if (least2 > left * left || is_useless(window)) return;
  bucket(window.before + std::sqrt(least2)).windows.push_back(window);
}

/// Whether every line of the window comes later than a path over an end of the edge (Xin and Wang 2009,
/// theorem 3.2): if so at the far end of the window, then everywhere in it and beyond.
[[gnu::always_inline]] inline bool GeodesicSearch::is_useless(const Window& w) const {
  const HalfEdge& h = surface_.half_edges_[w.half_edge];
  // Whether a path of this length comes before the line to x along the edge.
  const auto beats = [&](double path, double x) {
    const double left = path - w.before, across = x - w.source.x;
    return left < 0 || left * left < across * across + w.source.y * w.source.y;
  };
  return beats(distance(h.from) + w.end, w.end) || beats(distance(h.to) + h.length - w.begin, w.begin);
}

/// Carries a window through its triangle, onto the other two edges.
void GeodesicSearch::advance(const Window& w) {
  const HalfEdge& h = surface_.half_edges_[w.half_edge];
  const Vec2d apex = h.apex, s = w.source;
  // Where the line to the opposite corner crosses the edge.
  const double at = s.x + (apex.x - s.x) * (-s.y / (apex.y - s.y));
  const double slack = kNarrow * h.length;
  const std::uint32_t first = w.half_edge - w.half_edge % 3;
  const std::uint32_t next = first + (w.half_edge + 1) % 3, previous = first + (w.half_edge + 2) % 3;
  if (at >= w.begin - slack && at <= w.end + slack) {
    const Vec2d back = s - apex, edge = apex * -1.0;
    reach(h.opposite, w.before + norm(back), [&] {
      return surface_.half_edges_[previous].turn +
             std::atan2(cross(edge, back), edge.x * back.x + edge.y * back.y);
    });
  }
  // How far along a line from p the line of the window through x on its edge crosses it.
  const auto hit = [&](Vec2d p, Vec2d along, double x) {
    const Vec2d ray{x - s.x, -s.y};
    const double turn = cross(ray, along);
    return turn != 0 ? cross(ray, s - p) / turn : 0;
  };
  // Onto a half-edge from p, between u0 and u1.
  const auto leave = [&](std::uint32_t number, Vec2d p, Vec2d along, double u0, double u1) {
    const Vec2d from_p = s - p;
    cross_edge(number,
               {number, u0, u1, {from_p.x * along.x + from_p.y * along.y, cross(along, from_p)}, w.before});
  };
  if (at < w.end) {
    const double l = surface_.half_edges_[next].length;
    const Vec2d p{h.length, 0}, along = (apex - p) * (1 / l);
    const double u0 = hit(p, along, w.end), u1 = at > w.begin ? l : hit(p, along, w.begin);
    leave(next, p, along, u0, u1);
  }
  if (at > w.begin) {
    const Vec2d along = apex * (-1 / surface_.half_edges_[previous].length);
    const double u0 = at < w.end ? 0 : hit(apex, along, w.end), u1 = hit(apex, along, w.begin);
    leave(previous, apex, along, u0, u1);
  }
}

}  // namespace fovea
