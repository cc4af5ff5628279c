#include "fovea/saliency/viewing.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "fovea/base/parallel.h"
#include "fovea/render/depth_map.h"
#include "fovea/surface/curvature.h"

namespace fovea {

namespace {

constexpr int kSize = 256;
constexpr std::size_t kSeenGrain = 1 << 13;

/// The surface with `up` along +y, where views expect it.
TriMesh upright(const Surface& surface, UpAxis up) {
  const Vec3d y = direction(up);
  const Vec3d other = std::abs(y.z) > 0.5 ? Vec3d{1, 0, 0} : Vec3d{0, 0, 1};
  const Vec3d x = cross(y, other), z = cross(x, y);
  const auto turned = [&](std::uint32_t v) {
    const Vec3d p = surface.position(v);
    return Vec3f(Vec3d{dot(x, p), dot(y, p), dot(z, p)});
  };
  TriMesh mesh;
  // Vertices without triangles must not widen the picture.
  mesh.positions.assign(surface.positions.size(), turned(surface.triangles.at(0)[0]));
  mesh.triangles.reserve(surface.triangles.size());
  for (const auto& t : surface.triangles) {
    mesh.triangles.push_back({VertexId{t[0]}, VertexId{t[1]}, VertexId{t[2]}});
    for (const std::uint32_t v : t) mesh.positions[v] = turned(v);
  }
  mesh.face_part.assign(mesh.triangles.size(), 0);
  mesh.parts.emplace_back();
  return mesh;
}

}  // namespace

Vec3d direction(UpAxis up) {
  const int number = static_cast<int>(up);
  const double sign = number < 3 ? 1 : -1;
  return {number % 3 == 0 ? sign : 0, number % 3 == 1 ? sign : 0, number % 3 == 2 ? sign : 0};
}

VertexField visibility(const Surface& surface, const Adjacency& adjacency, const ViewRing& ring,
                       const Context& context) {
  const std::size_t count = surface.positions.size();
  VertexField result(count);
  if (surface.triangles.empty()) return result;
  const TriMesh mesh = upright(surface, ring.up);
  const RenderScene scene = make_render_scene(mesh);
  Surface turned;
  turned.positions = mesh.positions;
  turned.triangles = surface.triangles;
  const std::vector<Vec3d> normals = vertex_normals(turned, adjacency, context);
  ViewOptions options;
  options.set = ViewSet::orbit;
  options.count = ring.count;
  options.elevation_deg = ring.elevation_deg;
  options.fov_deg = 0;
  const std::vector<View> views = make_views(options, scene.sphere);
  const auto share = 1 / static_cast<float>(views.size());
  for (const View& view : views) {
    const DepthMap depth(scene, view, kSize, context);
    parallel_for(context, count, kSeenGrain, [&](std::size_t begin, std::size_t end) {
      for (std::size_t v = begin; v < end; ++v) {
        const double cosine = dot(normals[v], view.back);
        if (cosine > 0 && depth.shows(Vec3d(mesh.positions[v])))
          result.values()[v] += share * static_cast<float>(cosine);
      }
    });
  }
  return result;
}

}  // namespace fovea
