#include "fovea/lod/step_shapes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>

#include "fovea/base/wide.h"
#include "fovea/lod/step_order.h"
#include "fovea/surface/pose.h"
#include "fovea/surface/scene_surface.h"

namespace fovea {

namespace {

/// Goes through the steps once more for the triangles that each makes.
class ShapeMaker {
 public:
  ShapeMaker(const Model& original, const MultiTessellation& levels, const Importance& importance)
      : levels_(levels), scene_(scene_surface(original, rest_pose(original)).surface) {
    check(importance, original);
    again_.record = levels.record;
    weight_.assign(scene_.positions.size(), 1.0f);
    for (std::size_t m = 0; m < importance.size(); ++m)
      std::ranges::copy(importance[m].values(), weight_.begin() + levels.first_vertex[m]);
  }

  StepShapes run(const Model& original) {
    StepOrder order(original, again_);
    for (std::size_t s = 0; s < levels_.step_count(); ++s) {
      order.begin(s);
      order.finish();
      add_sphere(s);
      add_cone(order);
      add_error(s);
      shapes_.takes_more.push_back(order.new_faces().empty() || takes_more(s, order));
    }
    return std::move(shapes_);
  }

 private:
  void add_sphere(std::size_t s) {
    const std::span<const std::uint32_t> corners = levels_.corners_of(s);
    Box box;
    for (const std::uint32_t v : corners) box.add(scene_.position(v));
    const Vec3d center = corners.empty() ? Vec3d() : (box.low + box.high) * 0.5;
    double radius = 0;
    for (const std::uint32_t v : corners) radius = std::max(radius, length(scene_.position(v) - center));
    shapes_.x.push_back(static_cast<float>(center.x));
    shapes_.y.push_back(static_cast<float>(center.y));
    shapes_.z.push_back(static_cast<float>(center.z));
    shapes_.radius.push_back(static_cast<float>(radius) + levels_.error[s]);
  }

  void add_cone(const StepOrder& order) {
    normals_.clear();
    Vec3d axis;
    for (const std::uint32_t f : order.new_faces()) {
      const auto& [i, j, k] = order.faces()[f];
      const Vec3d a = scene_.position(i);
      const Vec3d n = cross(scene_.position(j) - a, scene_.position(k) - a);
      if (!(length(n) > 0)) continue;
      normals_.push_back(n / length(n));
      axis += normals_.back();
    }
    double cosine = -1;
    if (length(axis) > 0) {
      axis = axis / length(axis);
      cosine = 1;
      for (const Vec3d n : normals_) cosine = std::min(cosine, dot(n, axis));
    }
    shapes_.axis_x.push_back(static_cast<float>(axis.x));
    shapes_.axis_y.push_back(static_cast<float>(axis.y));
    shapes_.axis_z.push_back(static_cast<float>(axis.z));
    constexpr float kNoCone = 2;
    shapes_.spread.push_back(cosine > 0 ? static_cast<float>(std::sqrt(1 - cosine * cosine)) : kNoCone);
  }

  void add_error(std::size_t s) {
    float weight = 0;
    for (const std::uint32_t v : levels_.corners_of(s)) weight = std::max(weight, weight_[v]);
    const CollapseStep& step = levels_.record.steps[s];
    if (step.kind == StepKind::collapse) {
      float& kept = weight_[levels_.vertex(step.mesh, step.kept)];
      kept = std::max(kept, weight_[levels_.vertex(step.mesh, step.removed)]);
      weight = std::max(weight, kept);
    }
    shapes_.error.push_back(std::isinf(weight) ? weight : levels_.error[s] * std::sqrt(weight));
  }

  bool takes_more(std::size_t s, const StepOrder& order) const {
    const CollapseStep& step = levels_.record.steps[s];
    if (step.kind != StepKind::collapse) return true;
    const std::array ends{levels_.vertex(step.mesh, step.removed), levels_.vertex(step.mesh, step.kept)};
    for (std::size_t i = s > 0 ? levels_.record.steps[s - 1].faces_end : 0; i < step.faces_end; ++i) {
      const auto& face = order.faces()[order.first_face(step.mesh) + levels_.record.removed_faces[i].value];
      for (const std::uint32_t end : ends) {
        if (std::ranges::find(face, end) == face.end()) return true;
      }
    }
    return false;
  }

  const MultiTessellation& levels_;
  Surface scene_;
  MultiTessellation again_;
  std::vector<float> weight_;  // [#vertices], the largest of those merged into each
  std::vector<Vec3d> normals_;
  StepShapes shapes_;
};

}  // namespace

StepShapes make_step_shapes(const Model& original, const MultiTessellation& levels,
                            const Importance& importance) {
  return ShapeMaker(original, levels, importance).run(original);
}

StepEye::StepEye(const LevelCamera& camera)
    : position(camera.view.eye),
      back(camera.view.back),
      pixels(static_cast<float>(camera.height / (2 * camera.view.half_height))),
      near(static_cast<float>(std::max(camera.view.near, 1e-30))),
      perspective(camera.view.perspective ? 1.0f : 0.0f) {
  const View& view = camera.view;
  const double half_width = view.half_height * camera.width / camera.height;
  const std::array<Vec3d, 4> across{view.right, -view.right, view.up, -view.up};
  for (std::size_t i = 0; i < across.size(); ++i) {
    const double half = i < 2 ? half_width : view.half_height;
    const Vec3d inwards = (view.perspective ? -view.back * half : Vec3d()) - across[i];
    sides[i] = Vec3f(inwards / length(inwards));
    offsets[i] = view.perspective ? 0.0f : static_cast<float>(half);
  }
}

FOVEA_WIDE void see(const StepShapes& shapes, const StepEye& eye, std::size_t begin, std::size_t end,
                    float* out) {
  const float* const xs = shapes.x.data();
  const float* const ys = shapes.y.data();
  const float* const zs = shapes.z.data();
  const float* const radii = shapes.radius.data();
  const float* const axis_x = shapes.axis_x.data();
  const float* const axis_y = shapes.axis_y.data();
  const float* const axis_z = shapes.axis_z.data();
  const float* const spread = shapes.spread.data();
  const float* const errors = shapes.error.data();
  const float p = eye.perspective, q = 1 - p;
  for (std::size_t s = begin; s < end; ++s) {
    const float x = xs[s] - eye.position.x, y = ys[s] - eye.position.y, z = zs[s] - eye.position.z;
    const float r = radii[s];
    const float distance = std::sqrt(x * x + y * y + z * z);
    // Towards the eye: along the line to it, or as the whole picture looks.
    const float vx = q * eye.back.x - p * x, vy = q * eye.back.y - p * y, vz = q * eye.back.z - p * z;
    float inside = axis_x[s] * vx + axis_y[s] * vy + axis_z[s] * vz + spread[s] * (p * distance + q) + p * r;
    for (int i = 0; i < 4; ++i) {
      const Vec3f n = eye.sides[i];
      inside = std::min(inside, n.x * x + n.y * y + n.z * z + eye.offsets[i] + r);
    }
    const float nearest = std::max(distance - r, eye.near);
    const float seen = errors[s] * eye.pixels / (p * nearest + q);
    out[s] = inside < 0 ? -seen : seen;
  }
}

}  // namespace fovea
