#include "fovea/surface/curvature.h"

#include "fovea/base/parallel.h"

namespace fovea {

namespace {

constexpr std::size_t kCurvatureGrain = 1 << 13;

/// Twice the area of a triangle along its normal.
Vec3d area_vector(const Surface& surface, std::uint32_t triangle) {
  const auto [a, b, c] = surface.triangles[triangle];
  const Vec3d p = surface.position(a);
  return cross(surface.position(b) - p, surface.position(c) - p);
}

/// Calls f(vertex) for all vertices.
template <class F>
void for_vertices(const Adjacency& adjacency, const Context& context, F&& f) {
  parallel_for(context, adjacency.vertex_count(), kCurvatureGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t v = begin; v < end; ++v) f(static_cast<std::uint32_t>(v));
  });
}

}  // namespace

std::vector<Vec3d> vertex_normals(const Surface& surface, const Adjacency& adjacency,
                                  const Context& context) {
  std::vector<Vec3d> normals(adjacency.vertex_count());
  for_vertices(adjacency, context, [&](std::uint32_t v) {
    Vec3d sum;
    const Vec3d p = surface.position(v);
    for (const std::uint32_t c : adjacency.corners(v)) {
      const auto& t = surface.triangles[c / 3];
      const Vec3d a = surface.position(t[(c + 1) % 3]) - p, b = surface.position(t[(c + 2) % 3]) - p;
      const double squares = length_squared(a) * length_squared(b);
      if (squares > 0) sum += cross(a, b) / squares;
    }
    normals[v] = normalized(sum);
  });
  return normals;
}

VertexField vertex_areas(const Surface& surface, const Adjacency& adjacency, const Context& context) {
  VertexField areas(adjacency.vertex_count());
  for_vertices(adjacency, context, [&](std::uint32_t v) {
    double sum = 0;
    for (const std::uint32_t c : adjacency.corners(v)) sum += length(area_vector(surface, c / 3));
    areas.values()[v] = static_cast<float>(sum / 6);
  });
  return areas;
}

VertexField mean_curvature(const Surface& surface, const Adjacency& adjacency, const Context& context) {
  const std::vector<Vec3d> normals = vertex_normals(surface, adjacency, context);
  VertexField curvature(adjacency.vertex_count());
  for_vertices(adjacency, context, [&](std::uint32_t v) {
    const Vec3d p = surface.position(v);
    double sum = 0, weights = 0;
    // A triangle weighs on both of its edges at v, so that an edge gets the area of all its triangles.
    for (const std::uint32_t c : adjacency.corners(v)) {
      const double area = length(area_vector(surface, c / 3));
      if (!(area > 0)) continue;
      for (const std::uint32_t k : {(c + 1) % 3, (c + 2) % 3}) {
        const Vec3d edge = surface.position(surface.triangles[c / 3][k]) - p;
        sum += area * 2 * dot(normals[v], edge) / length_squared(edge);
        weights += area;
      }
    }
    if (weights > 0) curvature.values()[v] = static_cast<float>(sum / weights);
  });
  return curvature;
}

}  // namespace fovea
