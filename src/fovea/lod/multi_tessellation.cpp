#include "fovea/lod/multi_tessellation.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "fovea/base/error.h"
#include "fovea/base/parallel.h"
#include "fovea/lod/step_order.h"
#include "fovea/surface/closest_point.h"
#include "fovea/surface/facing_point.h"
#include "fovea/surface/half_edges.h"

namespace fovea {

namespace {

/// What errors are raised by, for what lies between the points that are looked at: measured densely they were
/// at most 1.2 times as large (docs/levels.md).
constexpr double kMargin = 1.25;
/// Faces whose normals are farther apart than this face away from each other: the cosine of 120°.
constexpr double kAway = -0.5;
/// Steps whose points look for the original together, in parallel.
constexpr std::size_t kBlock = 1 << 14;

/// Measures how far each step is off.
class ErrorMeter {
 public:
  ErrorMeter(const Model& original, MultiTessellation& levels, const Context& context)
      : original_(original), levels_(levels), context_(context), order_(original, levels) {
    choose_points();
    for (const Mesh& mesh : original.meshes) surfaces_.push_back(surface_of(mesh.surface));
    for (const Surface& surface : surfaces_) {
      nearest_.emplace_back(surface);
      facing_.emplace_back(surface, std::vector<std::uint32_t>(surface.triangles.size()));
    }
    scales_ = largest_scales(original);
  }

  void run(Context& context);

 private:
  void choose_points();
  void take(std::size_t s);
  double keep_points();
  double old_extent() const;
  void add_samples(std::size_t s);
  void measure_samples();
  void finish_errors();

  const Model& original_;
  MultiTessellation& levels_;
  const Context& context_;
  StepOrder order_;
  std::vector<double> scales_;  // [#meshes]
  std::vector<Surface> surfaces_;
  std::vector<ClosestPoint> nearest_;
  std::vector<FacingPoint> facing_;

  // Points of the original, its vertices and the middles of its edges, and those that each face stands for.
  std::vector<Vec3d> points_at_;                         // [#points]
  std::vector<std::uint32_t> first_point_, next_point_;  // [#F], [#points], lists

  // Of the present step:
  std::vector<Vec3d> old_corners_;
  std::vector<std::uint32_t> points_;

  /// Where a new face is.
  struct Place {
    Place(std::uint32_t face_, Vec3d a_, Vec3d b_, Vec3d c_)
        : face(face_), a(a_), b(b_), c(c_), low(min(min(a, b), c)), high(max(max(a, b), c)) {}
    /// No point of the face is nearer to p than this, squared.
    double least_squared(Vec3d p) const { return length_squared(max(max(low - p, p - high), Vec3d())); }
    std::uint32_t face;
    Vec3d a, b, c, low, high;
  };
  std::vector<Place> places_;

  /// A point of a new triangle; of its middle the normal and the height over the longest side, too.
  struct Sample {
    Vec3d point;
    std::uint32_t mesh = 0, step = 0;
    Vec3d normal;
    double height = 0;
  };
  std::vector<Sample> samples_;
  double distance_of(const Sample& sample) const;
};

/// Every vertex and the middle of every edge, each with one of its faces; of edges that are longer than the
/// others several points, as far from each other as others are long.
void ErrorMeter::choose_points() {
  constexpr double kMost = 8;
  first_point_.assign(order_.faces().size(), kInvalid);
  const auto add = [&](Vec3d p, std::uint32_t face) {
    next_point_.push_back(std::exchange(first_point_[face], static_cast<std::uint32_t>(points_at_.size())));
    points_at_.push_back(p);
  };
  for (std::uint32_t v = 0; v < order_.vertex_count(); ++v) {
    if (order_.face_at(v) != kInvalid) add(order_.position(v), order_.face_at(v));
  }
  for (std::size_t m = 0; m < original_.meshes.size(); ++m) {
    const std::vector<HalfEdge> half_edges = sorted_half_edges(original_.meshes[m].surface.triangles);
    const auto ends = [&](const HalfEdge& e) {
      const std::array<std::uint32_t, 3>& face = order_.faces()[order_.first_face(m) + e.triangle()];
      return std::pair(order_.position(face[e.low_corner() % 3]), order_.position(face[e.high_corner() % 3]));
    };
    double mean = 0;  // of the length of edges
    for (const HalfEdge& e : half_edges)
      mean += length(ends(e).second - ends(e).first) / static_cast<double>(half_edges.size());
    for_each_edge(half_edges, [&](std::span<const HalfEdge> edge) {
      const auto [low, high] = ends(edge.front());
      const double count = mean > 0 ? std::clamp(std::floor(length(high - low) / mean), 1.0, kMost) : 1;
      for (double i = 1; i <= count; ++i)
        add(low + (high - low) * (i / (count + 1)), order_.first_face(m) + edge.front().triangle());
    });
  }
}

void ErrorMeter::run(Context& context) {
  const std::size_t count = levels_.step_count();
  levels_.error.assign(count, 0.0f);
  for (std::size_t first = 0; first < count; first += kBlock) {
    context.advance_or_throw("levels", static_cast<double>(first) / static_cast<double>(count));
    const std::size_t end = std::min(first + kBlock, count);
    for (std::size_t s = first; s < end; ++s) take(s);
    measure_samples();
  }
  finish_errors();
}

void ErrorMeter::take(std::size_t s) {
  order_.begin(s);
  old_corners_.clear();
  for (const std::uint32_t f : order_.old_faces()) {
    for (const std::uint32_t v : order_.faces()[f]) old_corners_.push_back(order_.position(v));
  }
  order_.finish();
  levels_.error[s] = static_cast<float>(order_.new_faces().empty() ? old_extent() : keep_points());
  if (order_.kept() != kInvalid) add_samples(s);
}

/// Gives the points that the old faces stood for to the nearest of the new ones. Returns the largest
/// distance.
double ErrorMeter::keep_points() {
  points_.clear();
  for (const std::uint32_t f : order_.old_faces()) {
    for (std::uint32_t i = std::exchange(first_point_[f], kInvalid); i != kInvalid; i = next_point_[i])
      points_.push_back(i);
  }
  places_.clear();
  for (const std::uint32_t f : order_.new_faces()) {
    const auto& [i, j, k] = order_.faces()[f];
    places_.emplace_back(f, order_.position(i), order_.position(j), order_.position(k));
  }
  double largest = 0;
  for (const std::uint32_t i : points_) {
    const Vec3d p = points_at_[i];
    double least = std::numeric_limits<double>::infinity();
    std::uint32_t best = order_.new_faces().front();
    for (const Place& place : places_) {
      if (place.least_squared(p) >= least) continue;
      const double d = length_squared(p - closest_on_triangle(p, place.a, place.b, place.c).point);
      if (d >= least) continue;
      least = d;
      best = place.face;
    }
    next_point_[i] = std::exchange(first_point_[best], i);
    largest = std::max(largest, least);
  }
  return std::sqrt(largest);
}

/// Diagonal of the box around what was there.
double ErrorMeter::old_extent() const {
  Box box;
  for (const Vec3d p : old_corners_) box.add(p);
  return box.diagonal();
}

/// Notes the points of new triangles that look for the original.
void ErrorMeter::add_samples(std::size_t s) {
  const std::uint32_t mesh = levels_.record.steps[s].mesh, b = order_.kept();
  const auto add = [&](Vec3d p) -> Sample& {
    return samples_.emplace_back(Sample{p, mesh, static_cast<std::uint32_t>(s), {}});
  };
  const Vec3d at_b = order_.position(b);
  add(at_b);
  for (const std::uint32_t v : levels_.corners_of(s)) {
    if (v == b) continue;
    for (const double t : {0.25, 0.5, 0.75}) add(at_b * (1 - t) + order_.position(v) * t);
  }
  for (const std::uint32_t f : order_.new_faces()) {
    const auto& [i, j, k] = order_.faces()[f];
    const Vec3d p = order_.position(i), q = order_.position(j), r = order_.position(k);
    const Vec3d n = cross(q - p, r - p);
    Sample& middle = add((p + q + r) / 3.0);
    middle.normal = normalized(n);
    const double longest = std::max({length(q - p), length(r - q), length(p - r)});
    middle.height = longest > 0 ? length(n) / longest : 0;
  }
}

/// From the original. A triangle that faces away from that is off by half of its height at least, as if its
/// tip had gone from one side to the other, or by half of the way to what faces like it: so no error hides
/// that a triangle is upside down.
double ErrorMeter::distance_of(const Sample& sample) const {
  const ClosestPoint::Hit hit = nearest_[sample.mesh].nearest(sample.point);
  if (sample.height <= 2 * hit.distance) return hit.distance;
  const Surface& surface = surfaces_[sample.mesh];
  const auto& [a, b, c] = surface.triangles[hit.triangle];
  const Vec3d at_a = surface.position(a);
  const Vec3d normal = normalized(cross(surface.position(b) - at_a, surface.position(c) - at_a));
  if (dot(normal, sample.normal) >= kAway) return hit.distance;
  const auto facing = facing_[sample.mesh].nearest({sample.point, sample.normal, sample.height, 0});
  return std::max(hit.distance, (facing ? facing->distance : sample.height) / 2);
}

void ErrorMeter::measure_samples() {
  std::vector<float> distance(samples_.size());
  parallel_for_or_throw(context_, samples_.size(), 1 << 10, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) distance[i] = static_cast<float>(distance_of(samples_[i]));
  });
  for (std::size_t i = 0; i < samples_.size(); ++i) {
    float& error = levels_.error[samples_[i].step];
    error = std::max(error, distance[i]);
  }
  samples_.clear();
}

/// To scene units, and none less than those that it needs.
void ErrorMeter::finish_errors() {
  for (std::size_t s = 0; s < levels_.error.size(); ++s) {
    const double scale = scales_[levels_.record.steps[s].mesh];
    float& error = levels_.error[s];
    error = static_cast<float>(error * kMargin * (scale > 0 ? scale : 1));
    for (const std::uint32_t needed : levels_.needs_of(s)) error = std::max(error, levels_.error[needed]);
  }
}

}  // namespace

std::size_t MultiTessellation::bytes() const {
  const auto size = [](const auto& list) { return list.capacity() * sizeof(list[0]); };
  return size(record.steps) + size(record.removed_faces) + size(record.joins) + size(record.writes) +
         size(record.floats) + size(needs_end) + size(needs) + size(corners_end) + size(corners) +
         size(error);
}

MultiTessellation make_multi_tessellation(const Model& original, CollapseRecord record, Context& context) {
  MultiTessellation levels;
  levels.record = std::move(record);
  ErrorMeter(original, levels, context).run(context);
  return levels;
}

MultiTessellation make_multi_tessellation(const Model& original, CollapseRecord record,
                                          std::vector<float> error, Context& context) {
  if (error.size() != record.steps.size())
    throw Error(ErrorKind::usage, "there must be one error for each step", "error");
  MultiTessellation levels;
  levels.record = std::move(record);
  levels.error = std::move(error);
  StepOrder order(original, levels);
  for (std::size_t s = 0; s < levels.step_count(); ++s) {
    if (s % kBlock == 0)
      context.advance_or_throw("levels", static_cast<double>(s) / static_cast<double>(levels.step_count()));
    order.begin(s);
    order.finish();
  }
  return levels;
}

}  // namespace fovea
