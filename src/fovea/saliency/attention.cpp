#include "fovea/saliency/attention.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <optional>

#include "fovea/base/error.h"
#include "fovea/base/parallel.h"
#include "fovea/render/depth_map.h"
#include "fovea/render/projection.h"
#include "fovea/render/render.h"
#include "fovea/render/scan_convert.h"
#include "fovea/saliency/distance_transform.h"
#include "fovea/surface/geodesic.h"
#include "fovea/surface/scene_surface.h"

namespace fovea {

namespace {

constexpr float kNowhere = std::numeric_limits<float>::infinity();
constexpr std::size_t kRegionGrain = 1 << 12;

/// Foci of one kind: those of attention, or those of neglect.
using Foci = std::vector<Focus>;

void check(std::span<const Focus> foci, int size) {
  if (foci.empty()) throw Error(ErrorKind::usage, "there is no focus", "foci");
  for (const Focus& focus : foci) {
    if (!(focus.x >= 0 && focus.x < size && focus.y >= 0 && focus.y < size)) {
      throw Error(ErrorKind::usage,
                  fmt::format("the focus {}, {} is not in the picture of {} × {} pixels", focus.x, focus.y,
                              size, size),
                  "foci");
    }
    if (!std::isfinite(focus.weight) || focus.weight == 0)
      throw Error(ErrorKind::usage, "the weight of a focus is 0 or no number", "foci");
  }
}

GridCell cell_of(const Focus& focus) { return {static_cast<int>(focus.x), static_cast<int>(focus.y)}; }

void lower(float& label, double value) { label = std::min(label, static_cast<float>(value)); }

// --- In the picture --------------------------------------------------------------------------------------

/// The distance of every cell from the foci, each by its weight. [size × size], none without foci.
std::vector<float> label_cells(const Foci& foci, int size) {
  std::map<double, std::vector<GridCell>> by_weight;
  for (const Focus& focus : foci) by_weight[std::abs(focus.weight)].push_back(cell_of(focus));
  std::vector<float> cells(static_cast<std::size_t>(size) * static_cast<std::size_t>(size), kNowhere);
  for (const auto& [weight, sources] : by_weight) {
    const std::vector<std::int32_t> distance = distance_transform(size, size, sources);
    for (std::size_t i = 0; i < cells.size(); ++i) lower(cells[i], distance[i] / weight);
  }
  return cells;
}

/// Puts the labels of the picture's cells back on what projects there.
class BackProjection {
 public:
  BackProjection(const RenderScene& scene, const View& view, const AttentionOptions& options,
                 const Context& context)
      : scene_(scene),
        view_(view),
        options_(options),
        size_(static_cast<int>(options.view_size)),
        context_(context) {}

  void add(const std::vector<float>& cells, std::vector<VertexField>& labels) {
    if (options_.element == AttentionElement::vertices) {
      for (const SceneMesh& mesh : scene_.meshes) label_vertices(mesh, cells, labels[mesh.mesh_index]);
    } else if (options_.visible_only) {
      label_visible_faces(cells, labels);
    } else {
      for (const SceneMesh& mesh : scene_.meshes) label_faces(mesh, cells, labels[mesh.mesh_index]);
    }
  }

 private:
  /// The label of a point of the picture; outside it goes on from the border.
  float label_at(const std::vector<float>& cells, const PicturePoint& p) const {
    const double x = std::clamp(p.x, 0.0, size_ - 0.5), y = std::clamp(p.y, 0.0, size_ - 0.5);
    const double outside =
        std::hypot(p.x - std::clamp(p.x, 0.0, 1.0 * size_), p.y - std::clamp(p.y, 0.0, 1.0 * size_));
    return cells[index(static_cast<int>(x), static_cast<int>(y))] +
           static_cast<float>(kChamferEdge * outside);
  }
  bool is_inside(const PicturePoint& p) const { return p.x >= 0 && p.x < size_ && p.y >= 0 && p.y < size_; }

  void label_vertices(const SceneMesh& mesh, const std::vector<float>& cells, VertexField& labels) {
    if (options_.visible_only && !depth_) depth_.emplace(scene_, view_, size_, context_);
    const std::vector<char> faces_eye =
        options_.visible_only ? vertices_that_face_the_eye(mesh) : std::vector<char>{};
    parallel_for(context_, labels.size(), kRegionGrain, [&](std::size_t begin, std::size_t end) {
      for (std::size_t v = begin; v < end; ++v) {
        const Vec3d p(mesh.surface.positions[v]);
        const PicturePoint at = picture_point(view_, size_, p);
        if (view_.perspective && at.distance <= 0) continue;
        if (options_.visible_only && !(faces_eye[v] != 0 && is_inside(at) && depth_->shows(p))) continue;
        lower(labels.values()[v], static_cast<double>(label_at(cells, at)));
      }
    });
  }

  /// Those with a triangle that shows its front, or has two.
  std::vector<char> vertices_that_face_the_eye(const SceneMesh& mesh) const {
    std::vector<char> result(mesh.surface.positions.size(), 0);
    const TriMesh& triangles = *mesh.mesh;
    for (std::size_t f = 0; f < triangles.face_count(); ++f) {
      std::array<Vec3d, 3> eye;
      for (std::size_t k = 0; k < 3; ++k)
        eye[k] = view_.to_eye(Vec3d(mesh.surface.positions[triangles.triangles[f][k].index()]));
      // In eye space z points away: fronts are clockwise, unless the instance is mirrored.
      const Vec3d normal = cross(eye[1] - eye[0], eye[2] - eye[0]);
      const double toward = view_.perspective ? dot(normal, eye[0]) : normal.z;
      const bool front = (toward > 0) != mesh.surface.mirrored;
      if (!front && !scene_.materials[mesh.part_material[triangles.face_part[f]]].double_sided) continue;
      for (const VertexId v : triangles.triangles[f]) result[v.index()] = 1;
    }
    return result;
  }

  void label_faces(const SceneMesh& mesh, const std::vector<float>& cells, VertexField& labels) {
    const Projection projection(view_, {size_, size_, 1});
    for (std::size_t f = 0; f < mesh.mesh->face_count(); ++f) {
      float label = kNowhere;
      std::array<Vec3d, 3> eye;
      for (std::size_t k = 0; k < 3; ++k) {
        const Vec3d p(mesh.surface.positions[mesh.mesh->triangles[f][k].index()]);
        eye[k] = view_.to_eye(p);
        const PicturePoint at = picture_point(view_, size_, p);
        if (!view_.perspective || at.distance > 0) label = std::min(label, label_at(cells, at));
      }
      const std::vector<ScreenVertex> fan = projection.clip(eye);
      for (std::size_t k = 2; k < fan.size(); ++k) {
        for_spans({fan[0], fan[k - 1], fan[k]}, {0, 0, size_, size_},
                  [&](int y, int x0, int x1, const NearnessPlane&) {
                    for (int x = x0; x < x1; ++x) label = std::min(label, cells[index(x, y)]);
                  });
      }
      for (const VertexId v : mesh.mesh->triangles[f]) labels[v] = std::min(labels[v], label);
    }
  }

  void label_visible_faces(const std::vector<float>& cells, std::vector<VertexField>& labels) {
    if (!visible_) visible_ = visible_surface(scene_, view_, size_, size_, context_);
    for (std::size_t i = 0; i < cells.size(); ++i) {
      if (visible_->triangle[i] == kInvalid) continue;
      const TriangleOrigin from = origin(scene_, visible_->triangle[i]);
      const SceneMesh& mesh = scene_.meshes[from.mesh];
      for (const VertexId v : mesh.mesh->triangles[from.face.index()]) {
        float& label = labels[mesh.mesh_index][v];
        label = std::min(label, cells[i]);
      }
    }
  }

  std::size_t index(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(size_) + static_cast<std::size_t>(x);
  }

  const RenderScene& scene_;
  const View& view_;
  const AttentionOptions& options_;
  const int size_;
  const Context& context_;
  std::optional<DepthMap> depth_;
  std::optional<VisibleSurface> visible_;
};

// --- On the surface --------------------------------------------------------------------------------------

/// Distances over the surface from points that a picture shows.
class SurfaceDistances {
 public:
  SurfaceDistances(const Model& model, const RenderScene& scene, const View& view, int size, double reach,
                   const Context& context)
      : scene_(scene),
        view_(view),
        size_(size),
        reach_(reach),
        visible_(visible_surface(scene, view, size, size, context)),
        whole_(scene_surface(model, rest_pose(model))),
        adjacency_(whole_.surface, context),
        geodesic_(whole_.surface, adjacency_, context),
        search_(geodesic_),
        farthest_(kWinding * diagonal(whole_.surface)) {}

  void add(const Focus& focus, VertexField& labels) {
    const GridCell cell = cell_of(focus);
    const std::size_t pixel =
        static_cast<std::size_t>(cell.y) * static_cast<std::size_t>(size_) + static_cast<std::size_t>(cell.x);
    if (visible_.triangle[pixel] == kInvalid) {
      throw Error(ErrorKind::usage, fmt::format("the picture shows no surface at {}, {}", focus.x, focus.y),
                  "foci");
    }
    const TriangleOrigin from = origin(scene_, visible_.triangle[pixel]);
    const std::uint32_t mesh = scene_.meshes[from.mesh].mesh_index;
    const auto& corners = whole_.surface.triangles[whole_.first_triangle[mesh] + from.face.value];
    const Vec3d point = point_under(focus, from, corners);
    // A fifth of a pixel's width where the point is.
    const double unit = pixel_width(view_, size_, static_cast<double>(visible_.distance[pixel])) /
                        kChamferEdge * std::abs(focus.weight);
    std::vector<char> is_joined(labels.size(), 0);
    for (const std::uint32_t corner : corners) {
      const double before = length(whole_.surface.position(corner) - point);
      for (const auto& [vertex, distance] : search_.from(corner, std::min(reach_ * unit, farthest_))) {
        const double label = (before + distance) / unit;
        if (label <= reach_) lower(labels.values()[vertex], label);
      }
    }
    mark_joined(corners[0], is_joined);
    for (std::uint32_t v = 0; v < labels.size(); ++v) {
      const double distance = length(whole_.surface.position(v) - point) / unit;
      if (is_joined[v] == 0 && distance <= reach_) lower(labels.values()[v], distance);
    }
  }

  std::vector<VertexField> split(const VertexField& labels) const { return fovea::split(whole_, labels); }
  std::size_t vertex_count() const { return whole_.surface.positions.size(); }

 private:
  /// Where the ray through the focus meets the triangle, on the surface at rest.
  Vec3d point_under(const Focus& focus, const TriangleOrigin& from,
                    const std::array<std::uint32_t, 3>& corners) const {
    const SceneMesh& mesh = scene_.meshes[from.mesh];
    std::array<Vec2d, 3> p;
    std::array<double, 3> nearness{};
    for (std::size_t k = 0; k < 3; ++k) {
      const VertexId v = mesh.mesh->triangles[from.face.index()][k];
      const PicturePoint at = picture_point(view_, size_, Vec3d(mesh.surface.positions[v.index()]));
      p[k] = {at.x, at.y};
      nearness[k] = view_.perspective ? 1 / at.distance : 1;
    }
    const Vec2d at{std::floor(focus.x) + 0.5, std::floor(focus.y) + 0.5};
    std::array<double, 3> weight{};
    double sum = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      const std::size_t next = (k + 1) % 3, last = (k + 2) % 3;
      weight[k] = std::abs(cross(p[next] - at, p[last] - at)) * nearness[k];
      sum += weight[k];
    }
    Vec3d point;
    for (std::size_t k = 0; k < 3; ++k)
      point += whole_.surface.position(corners[k]) * (sum > 0 ? weight[k] / sum : 1.0 / 3);
    return point;
  }

  /// Marks all vertices that triangles join to one.
  void mark_joined(std::uint32_t start, std::vector<char>& joined) const {
    std::vector<std::uint32_t> waiting{start};
    joined[start] = 1;
    while (!waiting.empty()) {
      const std::uint32_t v = waiting.back();
      waiting.pop_back();
      for (const std::uint32_t w : adjacency_.neighbors(v)) {
        if (joined[w] != 0) continue;
        joined[w] = 1;
        waiting.push_back(w);
      }
    }
  }

  const RenderScene& scene_;
  const View& view_;
  const int size_;
  const double reach_;
  VisibleSurface visible_;
  SceneSurface whole_;
  Adjacency adjacency_;
  GeodesicSurface geodesic_;
  GeodesicSearch search_;
  /// Over a surface nothing that matters is farther: so many diagonals.
  static constexpr double kWinding = 8;
  const double farthest_;
};

}  // namespace

OptionList describe(AttentionOptions& o) {
  return {{"labels",
           "What is labelled: vertices where they project, or triangles over all that they cover, so that "
           "large ones "
           "are found between their corners.",
           choice(o.element, {"vertices", "faces"}), ""},
          {"visible-only", "Label only what the picture shows, not what is hidden behind it.",
           &o.visible_only, ""},
          {"on-surface",
           "Measure from the points of the surface under the foci, over the surface, so that it holds for "
           "all views.",
           &o.on_surface, ""},
          {"view-size", "Width and height of the picture in which --at counts pixels.", &o.view_size,
           "pixels", 16, 4096}};
}

AttentionLabels attention_labels(const Model& model, const RenderScene& scene, const View& view,
                                 std::span<const Focus> foci, const AttentionOptions& options, double reach,
                                 const Context& context) {
  AttentionOptions checked = options;
  check(describe(checked));
  const auto size = static_cast<int>(options.view_size);
  check(foci, size);
  Foci attended, neglected;
  for (const Focus& focus : foci) (focus.weight > 0 ? attended : neglected).push_back(focus);

  AttentionLabels labels;
  if (options.on_surface) {
    SurfaceDistances distances(model, scene, view, size, reach, context);
    const auto label = [&](const Foci& of) {
      VertexField field(distances.vertex_count(), kNowhere);
      for (const Focus& focus : of) distances.add(focus, field);
      return distances.split(field);
    };
    labels.attended = label(attended);
    labels.neglected = label(neglected);
    return labels;
  }
  for (const Mesh& mesh : model.meshes) labels.attended.emplace_back(mesh.surface.vertex_count(), kNowhere);
  labels.neglected = labels.attended;
  BackProjection back(scene, view, options, context);
  if (!attended.empty()) back.add(label_cells(attended, size), labels.attended);
  if (!neglected.empty()) back.add(label_cells(neglected, size), labels.neglected);
  return labels;
}

}  // namespace fovea
