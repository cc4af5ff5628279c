#include "fovea/lod/multi_tessellation.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include "fovea/base/error.h"
#include "fovea/base/parallel.h"
#include "fovea/surface/closest_point.h"
#include "fovea/surface/half_edges.h"

namespace fovea {

namespace {

/// What errors are raised by, for what lies between the points that are looked at: measured densely they were
/// at most 1.2 times as large (docs/levels.md).
constexpr double kMargin = 1.25;
/// Steps whose points look for the original together, in parallel.
constexpr std::size_t kBlock = 1 << 14;

/// Throws if a step is not one of this model, or its runs do not go on from those before.
void check_step(const Model& original, const CollapseRecord& record, std::size_t s) {
  const CollapseStep& step = record.steps[s];
  const CollapseStep before = s > 0 ? record.steps[s - 1] : CollapseStep();
  bool good = step.mesh < original.meshes.size() && step.faces_end >= before.faces_end &&
              step.joins_end >= before.joins_end && step.writes_end >= before.writes_end &&
              step.faces_end <= record.removed_faces.size() && step.joins_end <= record.joins.size() &&
              step.writes_end <= record.writes.size();
  if (good) {
    const TriMesh& mesh = original.meshes[step.mesh].surface;
    const auto has_value = [&](std::uint32_t layer, std::uint32_t value) {
      return layer < mesh.layers.size() && value < mesh.layers[layer].size();
    };
    if (step.kind == StepKind::collapse) {
      good = step.removed.value < mesh.vertex_count() && step.kept.value < mesh.vertex_count() &&
             step.removed != step.kept;
    }
    for (std::size_t i = before.faces_end; i < step.faces_end; ++i)
      good = good && record.removed_faces[i].value < mesh.face_count();
    for (std::size_t i = before.joins_end; i < step.joins_end; ++i) {
      const ValueJoin& join = record.joins[i];
      good = good && has_value(join.layer, join.removed.value) && has_value(join.layer, join.kept.value);
    }
    for (std::size_t i = before.writes_end; i < step.writes_end; ++i) {
      const ValueWrite& write = record.writes[i];
      good = good && (write.layer == kInvalid ? write.value < mesh.vertex_count()
                                              : has_value(write.layer, write.value));
    }
  }
  if (!good) throw Error(ErrorKind::usage, "the record is of another model", fmt::format("step {}", s));
}

/// Goes through the steps once and notes what each needs, makes, and is off by.
class Builder {
 public:
  Builder(const Model& original, MultiTessellation& levels, const Context& context)
      : original_(original), levels_(levels), context_(context) {
    number_elements();
    link_corners();
    find_homes();
    choose_points();
    for (const Mesh& mesh : original.meshes) surfaces_.push_back(surface_of(mesh.surface));
    for (const Surface& surface : surfaces_) nearest_.emplace_back(surface);
    scales_ = largest_scales(original);
  }

  void run(Context& context);

 private:
  static constexpr std::uint32_t kNever = kInvalid;

  void number_elements();
  void link_corners();
  void find_homes();
  void choose_points();
  void take(std::size_t s);
  bool changes_kept(std::size_t s, std::uint32_t b);
  std::uint32_t vertex_now(std::uint32_t v);
  void add_old_faces(std::uint32_t v);
  void add_old_face(std::uint32_t f);
  void remove_face(std::uint32_t f, std::size_t s);
  void merge(const CollapseStep& step, std::uint32_t a, std::uint32_t b);
  void note_needs(const CollapseStep& step);
  void note_corners(std::uint32_t b);
  double keep_points();
  double old_extent() const;
  void add_samples(std::size_t s, std::uint32_t mesh, std::uint32_t b);
  void measure_samples();
  void finish_errors();
  Vec3d position(std::uint32_t v) const { return Vec3d(positions_[v]); }

  /// Calls f(corner) for each corner at v of a face that is left, and forgets the others.
  template <class F>
  void for_corners(std::uint32_t v, F&& f) {
    std::uint32_t* link = &first_corner_[v];
    last_corner_[v] = kInvalid;
    while (*link != kInvalid) {
      const std::uint32_t c = *link;
      if (!alive_[c / 3]) {
        *link = next_corner_[c];
        continue;
      }
      f(c);
      last_corner_[v] = c;
      link = &next_corner_[c];
    }
  }

  const Model& original_;
  MultiTessellation& levels_;
  const Context& context_;
  std::vector<double> scales_;  // [#meshes]
  std::vector<Surface> surfaces_;
  std::vector<ClosestPoint> nearest_;
  std::vector<std::uint32_t> first_face_;  // [#meshes + 1]

  // Of all meshes, as the steps have left them:
  std::vector<Vec3f> positions_;                                         // [#V], in the space of their mesh
  std::vector<std::array<std::uint32_t, 3>> faces_;                      // [#F]
  std::vector<char> alive_;                                              // [#F]
  std::vector<std::uint32_t> first_corner_, last_corner_, next_corner_;  // [#V], [#V], [#F × 3]
  std::vector<std::uint32_t> merged_into_;                               // [#V], itself if it is left
  std::vector<std::vector<std::vector<std::uint32_t>>>
      home_;                                // [#meshes][#layers][#values], its original vertex
  std::vector<std::uint32_t> made_by_;      // [#F], the step that made the face as it is
  std::vector<std::uint32_t> stripped_by_;  // [#V], the last step that removed a face there
  // Points of the original, its vertices and the middles of its edges, and those that each face stands for.
  std::vector<Vec3d> points_at_;                         // [#points]
  std::vector<std::uint32_t> first_point_, next_point_;  // [#F], [#points], lists

  // Of the present step:
  std::vector<std::uint32_t> old_faces_, new_faces_;
  std::vector<std::uint32_t> face_mark_, vertex_mark_;
  std::uint32_t mark_ = 0;
  std::vector<Vec3d> old_corners_;
  std::vector<std::uint32_t> needs_, points_;

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

  /// A point of a new triangle.
  struct Sample {
    Vec3d point;
    std::uint32_t mesh = 0, step = 0;
  };
  std::vector<Sample> samples_;
};

void Builder::number_elements() {
  levels_.first_vertex = {0};
  first_face_ = {0};
  std::uint64_t corners = 0;
  for (const Mesh& mesh : original_.meshes) {
    corners += 3 * mesh.surface.face_count();
    if (corners >= kInvalid)
      throw Error(ErrorKind::limit, "the model has too many triangles for a record of levels");
    levels_.first_vertex.push_back(levels_.first_vertex.back() +
                                   static_cast<std::uint32_t>(mesh.surface.vertex_count()));
    first_face_.push_back(first_face_.back() + static_cast<std::uint32_t>(mesh.surface.face_count()));
  }
  levels_.triangles = first_face_.back();
}

void Builder::link_corners() {
  const std::size_t vertices = levels_.first_vertex.back(), faces = first_face_.back();
  positions_.reserve(vertices);
  faces_.reserve(faces);
  for (std::size_t m = 0; m < original_.meshes.size(); ++m) {
    const TriMesh& mesh = original_.meshes[m].surface;
    positions_.insert(positions_.end(), mesh.positions.begin(), mesh.positions.end());
    for (const auto& t : mesh.triangles) {
      faces_.push_back({levels_.first_vertex[m] + t[0].value, levels_.first_vertex[m] + t[1].value,
                        levels_.first_vertex[m] + t[2].value});
    }
  }
  alive_.assign(faces, 1);
  first_corner_.assign(vertices, kInvalid);
  last_corner_.assign(vertices, kInvalid);
  next_corner_.assign(3 * faces, kInvalid);
  merged_into_.resize(vertices);
  std::iota(merged_into_.begin(), merged_into_.end(), 0u);
  made_by_.assign(faces, kNever);
  stripped_by_.assign(vertices, kNever);
  face_mark_.assign(faces, 0);
  vertex_mark_.assign(vertices, 0);
  for (std::uint32_t c = 0; c < 3 * faces; ++c) {
    const std::uint32_t v = faces_[c / 3][c % 3];
    if (first_corner_[v] == kInvalid) {
      first_corner_[v] = c;
    } else {
      next_corner_[last_corner_[v]] = c;
    }
    last_corner_[v] = c;
  }
}

/// Notes the vertex of each attribute value.
void Builder::find_homes() {
  for (std::size_t m = 0; m < original_.meshes.size(); ++m) {
    auto& homes = home_.emplace_back();
    for (const AttributeLayer& layer : original_.meshes[m].surface.layers) {
      auto& home = homes.emplace_back(layer.size(), kInvalid);
      for (std::size_t c = 0; c < layer.corner_value.size(); ++c) {
        const ValueId value = layer.corner_value[c];
        if (value.valid()) home[value.index()] = faces_[first_face_[m] + c / 3][c % 3];
      }
    }
  }
}

/// Every vertex and the middle of every edge, each with one of its faces.
void Builder::choose_points() {
  first_point_.assign(faces_.size(), kInvalid);
  const auto add = [&](Vec3d p, std::uint32_t face) {
    next_point_.push_back(std::exchange(first_point_[face], static_cast<std::uint32_t>(points_at_.size())));
    points_at_.push_back(p);
  };
  for (std::uint32_t v = 0; v < positions_.size(); ++v) {
    if (first_corner_[v] != kInvalid) add(position(v), first_corner_[v] / 3);
  }
  for (std::size_t m = 0; m < original_.meshes.size(); ++m) {
    const std::vector<HalfEdge> half_edges = sorted_half_edges(original_.meshes[m].surface.triangles);
    for_each_edge(half_edges, [&](std::span<const HalfEdge> edge) {
      const HalfEdge& e = edge.front();
      const std::uint32_t face = first_face_[m] + e.triangle();
      const auto end = [&](std::size_t corner) { return position(faces_[face][corner % 3]); };
      add((end(e.low_corner()) + end(e.high_corner())) * 0.5, face);
    });
  }
}

void Builder::run(Context& context) {
  const CollapseRecord& record = levels_.record;
  if (record.triangles_before != levels_.triangles)
    throw Error(ErrorKind::usage, "the record is of another model", "record",
                fmt::format("it begins with {} triangles, the model has {}", record.triangles_before,
                            levels_.triangles));
  const std::size_t count = record.steps.size();
  levels_.needs_end.reserve(count);
  levels_.corners_end.reserve(count);
  levels_.error.assign(count, 0.0f);
  for (std::size_t first = 0; first < count; first += kBlock) {
    context.advance_or_throw("levels", static_cast<double>(first) / static_cast<double>(count));
    const std::size_t end = std::min(first + kBlock, count);
    for (std::size_t s = first; s < end; ++s) take(s);
    measure_samples();
  }
  finish_errors();
}

void Builder::take(std::size_t s) {
  const CollapseRecord& record = levels_.record;
  const CollapseStep& step = record.steps[s];
  check_step(original_, record, s);
  const bool collapses = step.kind == StepKind::collapse;
  const std::uint32_t a = collapses ? levels_.vertex(step.mesh, step.removed) : kInvalid;
  const std::uint32_t b = collapses ? levels_.vertex(step.mesh, step.kept) : kInvalid;
  const std::size_t begin = s > 0 ? record.steps[s - 1].faces_end : 0;

  ++mark_;
  old_faces_.clear();
  if (collapses) {
    add_old_faces(a);
    if (changes_kept(s, b)) add_old_faces(b);
  }
  for (std::size_t i = begin; i < step.faces_end; ++i)
    add_old_face(first_face_[step.mesh] + record.removed_faces[i].value);
  note_needs(step);
  old_corners_.clear();
  for (const std::uint32_t f : old_faces_) {
    for (const std::uint32_t v : faces_[f]) old_corners_.push_back(position(v));
  }

  for (std::size_t i = begin; i < step.faces_end; ++i)
    remove_face(first_face_[step.mesh] + record.removed_faces[i].value, s);
  if (collapses) merge(step, a, b);
  new_faces_.clear();
  for (const std::uint32_t f : old_faces_) {
    if (!alive_[f]) continue;
    new_faces_.push_back(f);
    made_by_[f] = static_cast<std::uint32_t>(s);
  }
  note_corners(b);
  levels_.error[s] = static_cast<float>(new_faces_.empty() ? old_extent() : keep_points());
  if (collapses) add_samples(s, step.mesh, b);
}

/// Whether a collapse changes triangles at b that are not at a.
bool Builder::changes_kept(std::size_t s, std::uint32_t b) {
  const CollapseRecord& record = levels_.record;
  const CollapseStep& step = record.steps[s];
  if (step.moved) return true;
  const auto is_at_b = [&](std::uint32_t layer, ValueId value) {
    const std::uint32_t home = home_[step.mesh][layer][value.index()];
    return home != kInvalid && vertex_now(home) == b;
  };
  const std::size_t first_join = s > 0 ? record.steps[s - 1].joins_end : 0;
  for (std::size_t i = first_join; i < step.joins_end; ++i) {
    if (is_at_b(record.joins[i].layer, record.joins[i].removed)) return true;
  }
  const std::size_t first_write = s > 0 ? record.steps[s - 1].writes_end : 0;
  for (std::size_t i = first_write; i < step.writes_end; ++i) {
    const ValueWrite& write = record.writes[i];
    if (write.layer == kInvalid || is_at_b(write.layer, ValueId{write.value})) return true;
  }
  return false;
}

/// What an original vertex has become.
std::uint32_t Builder::vertex_now(std::uint32_t v) {
  while (merged_into_[v] != v) v = merged_into_[v] = merged_into_[merged_into_[v]];
  return v;
}

void Builder::add_old_faces(std::uint32_t v) {
  for_corners(v, [&](std::uint32_t c) { add_old_face(c / 3); });
}

void Builder::add_old_face(std::uint32_t f) {
  if (face_mark_[f] == mark_ || !alive_[f]) return;
  face_mark_[f] = mark_;
  old_faces_.push_back(f);
}

void Builder::remove_face(std::uint32_t f, std::size_t s) {
  alive_[f] = 0;
  for (const std::uint32_t v : faces_[f]) stripped_by_[v] = static_cast<std::uint32_t>(s);
}

/// Gives a's corners to b, which moves.
void Builder::merge(const CollapseStep& step, std::uint32_t a, std::uint32_t b) {
  for_corners(a, [&](std::uint32_t c) { faces_[c / 3][c % 3] = b; });
  for_corners(b, [](std::uint32_t) {});
  if (first_corner_[b] == kInvalid) {
    first_corner_[b] = first_corner_[a];
  } else {
    next_corner_[last_corner_[b]] = first_corner_[a];
  }
  if (last_corner_[a] != kInvalid) last_corner_[b] = last_corner_[a];
  first_corner_[a] = last_corner_[a] = kInvalid;
  merged_into_[a] = b;
  if (step.moved) positions_[b] = step.position;
}

/// The steps that made the faces around the edge, or removed one at its ends: without these a vertex would
/// have triangles here that this step does not know.
void Builder::note_needs(const CollapseStep& step) {
  needs_.clear();
  for (const std::uint32_t f : old_faces_) needs_.push_back(made_by_[f]);
  if (step.kind == StepKind::collapse) {
    for (const VertexId v : {step.removed, step.kept})
      needs_.push_back(stripped_by_[levels_.vertex(step.mesh, v)]);
  }
  std::sort(needs_.begin(), needs_.end());
  needs_.erase(std::unique(needs_.begin(), needs_.end()), needs_.end());
  if (!needs_.empty() && needs_.back() == kNever) needs_.pop_back();
  levels_.needs.insert(levels_.needs.end(), needs_.begin(), needs_.end());
  levels_.needs_end.push_back(static_cast<std::uint32_t>(levels_.needs.size()));
}

void Builder::note_corners(std::uint32_t b) {
  const auto note = [&](std::uint32_t v) {
    if (v == kInvalid || vertex_mark_[v] == mark_) return;
    vertex_mark_[v] = mark_;
    levels_.corners.push_back(v);
  };
  note(b);
  for (const std::uint32_t f : new_faces_.empty() ? old_faces_ : new_faces_) {
    for (const std::uint32_t v : faces_[f]) note(v);
  }
  levels_.corners_end.push_back(static_cast<std::uint32_t>(levels_.corners.size()));
}

/// Gives the points that the old faces stood for to the nearest of the new ones. Returns the largest
/// distance.
double Builder::keep_points() {
  points_.clear();
  for (const std::uint32_t f : old_faces_) {
    for (std::uint32_t i = std::exchange(first_point_[f], kInvalid); i != kInvalid; i = next_point_[i])
      points_.push_back(i);
  }
  places_.clear();
  for (const std::uint32_t f : new_faces_) {
    const auto& [i, j, k] = faces_[f];
    places_.emplace_back(f, position(i), position(j), position(k));
  }
  double largest = 0;
  for (const std::uint32_t i : points_) {
    const Vec3d p = points_at_[i];
    double least = std::numeric_limits<double>::infinity();
    std::uint32_t best = new_faces_.front();
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
double Builder::old_extent() const {
  Box box;
  for (const Vec3d p : old_corners_) box.add(p);
  return box.diagonal();
}

/// Notes the points of new triangles that look for the original.
void Builder::add_samples(std::size_t s, std::uint32_t mesh, std::uint32_t b) {
  const auto add = [&](Vec3d p) { samples_.push_back({p, mesh, static_cast<std::uint32_t>(s)}); };
  const Vec3d at_b = position(b);
  add(at_b);
  for (const std::uint32_t v : levels_.corners_of(s)) {
    if (v == b) continue;
    for (const double t : {0.25, 0.5, 0.75}) add(at_b * (1 - t) + position(v) * t);
  }
  for (const std::uint32_t f : new_faces_) {
    const auto& [i, j, k] = faces_[f];
    add((position(i) + position(j) + position(k)) / 3.0);
  }
}

void Builder::measure_samples() {
  std::vector<float> distance(samples_.size());
  parallel_for_or_throw(context_, samples_.size(), 1 << 10, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      distance[i] = static_cast<float>(nearest_[samples_[i].mesh].nearest(samples_[i].point).distance);
  });
  for (std::size_t i = 0; i < samples_.size(); ++i) {
    float& error = levels_.error[samples_[i].step];
    error = std::max(error, distance[i]);
  }
  samples_.clear();
}

/// To scene units, and none less than those that it needs.
void Builder::finish_errors() {
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
  Builder(original, levels, context).run(context);
  return levels;
}

}  // namespace fovea
