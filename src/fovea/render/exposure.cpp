#include "fovea/render/exposure.h"

#include <algorithm>
#include <cmath>

#include "fovea/base/parallel.h"
#include "fovea/render/render.h"

namespace fovea {

namespace {

constexpr std::size_t kGrain = 1 << 13;
/// With fewer the few samples that fall on a vertex's triangles are chance.
constexpr double kTellingPixels = 2;

/// Pixels of one triangle over all views.
struct Pixels {
  double seen = 0;     ///< In front.
  double covered = 0;  ///< By its outline, either side.
};

/// How large a triangle is in a picture, in pixels; 0 if part of it is behind the eye.
double outline_area(const View& view, int size, const std::array<Vec3d, 3>& world) {
  std::array<Vec2d, 3> p;
  for (std::size_t k = 0; k < 3; ++k) {
    const Vec3d eye = view.to_eye(world[k]);
    if (view.perspective && eye.z <= std::max(view.near, 1e-12)) return 0;
    const double to_plane = view.perspective ? 1 / eye.z : 1.0;
    p[k] = {eye.x * to_plane, eye.y * to_plane};
  }
  const double pixels = size / (2 * view.half_height);
  return 0.5 * std::abs(cross(p[1] - p[0], p[2] - p[0])) * pixels * pixels;
}

void add_outlines(const RenderScene& scene, const View& view, int size, const Context& context,
                  std::vector<Pixels>& pixels) {
  for (const SceneMesh& shown : scene.meshes) {
    const auto& triangles = shown.mesh->triangles;
    parallel_for_or_throw(context, triangles.size(), kGrain, [&](std::size_t begin, std::size_t end) {
      for (std::size_t f = begin; f < end; ++f) {
        std::array<Vec3d, 3> corners;
        for (std::size_t k = 0; k < 3; ++k)
          corners[k] = Vec3d(shown.surface.positions[triangles[f][k].index()]);
        pixels[shown.first_triangle + f].covered += outline_area(view, size, corners);
      }
    });
  }
}

}  // namespace

std::vector<VertexField> exposure(const RenderScene& scene, std::size_t mesh_count,
                                  std::span<const View> views, int size, const Context& context) {
  std::vector<Pixels> pixels(scene.triangle_count);
  for (const View& view : views) {
    for (const std::uint32_t triangle :
         visible_surface(scene, view, picture_width(view, size), size, context).triangle) {
      if (triangle != kInvalid) ++pixels[triangle].seen;
    }
    add_outlines(scene, view, size, context, pixels);
  }

  std::vector<std::vector<Pixels>> around(mesh_count);  // [#V]
  for (const SceneMesh& shown : scene.meshes) {
    std::vector<Pixels>& at = around[shown.mesh_index];
    at.resize(shown.mesh->vertex_count());
    for (std::size_t f = 0; f < shown.mesh->face_count(); ++f) {
      const Pixels& face = pixels[shown.first_triangle + f];
      for (const VertexId v : shown.mesh->triangles[f]) {
        at[v.index()].seen += face.seen;
        at[v.index()].covered += face.covered;
      }
    }
  }
  std::vector<VertexField> fields(mesh_count);
  for (std::size_t m = 0; m < mesh_count; ++m) {
    Pixels all;
    for (const Pixels& p : around[m]) all = {all.seen + p.seen, all.covered + p.covered};
    const auto share = [](const Pixels& p) { return static_cast<float>(std::min(1.0, p.seen / p.covered)); };
    const float mean = all.covered > 0 ? share(all) : 0;
    fields[m] = VertexField(around[m].size());
    for (std::size_t v = 0; v < around[m].size(); ++v)
      fields[m].values()[v] = around[m][v].covered >= kTellingPixels ? share(around[m][v]) : mean;
  }
  return fields;
}

}  // namespace fovea
