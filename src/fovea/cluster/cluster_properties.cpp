#include "fovea/cluster/cluster_properties.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "fovea/base/error.h"
#include "fovea/cluster/faces_by_cluster.h"

namespace fovea {

namespace {

void check_fit(const SceneSurface& scene, const VertexField& saliency, const Clusters& clusters) {
  const std::span<const std::uint32_t> of_face = clusters.of_face.values();
  if (saliency.size() != scene.surface.positions.size() || of_face.size() != scene.surface.triangles.size() ||
      std::any_of(of_face.begin(), of_face.end(), [&](std::uint32_t c) { return c >= clusters.count; }))
    throw Error(ErrorKind::usage, "saliency or clusters are of another scene");
}

/// Goes through clusters, one after the other.
class Walk {
 public:
  Walk(const SceneSurface& scene, const Clusters& clusters)
      : surface_(scene.surface),
        members_(clusters.of_face.values(), clusters.count),
        last_cluster_(surface_.positions.size(), clusters.count) {}

  std::span<const std::uint32_t> faces(std::uint32_t cluster) const { return members_.of(cluster); }
  /// Those of its triangles, each once, until the next call.
  const std::vector<std::uint32_t>& vertices(std::uint32_t cluster) {
    vertices_.clear();
    for (const std::uint32_t f : faces(cluster)) {
      for (const std::uint32_t v : surface_.triangles[f]) {
        if (last_cluster_[v] == cluster) continue;
        last_cluster_[v] = cluster;
        vertices_.push_back(v);
      }
    }
    return vertices_;
  }

 private:
  const Surface& surface_;
  FacesByCluster members_;
  std::vector<std::uint32_t> last_cluster_;  // [#V], in which a vertex was found last
  std::vector<std::uint32_t> vertices_;
};

/// Twice its area, along its normal.
Vec3d area_vector(const Surface& surface, std::uint32_t face) {
  const auto& t = surface.triangles[face];
  const Vec3d a = surface.position(t[0]);
  return cross(surface.position(t[1]) - a, surface.position(t[2]) - a);
}

void add_saliency(ClusterProperties& p, const VertexField& saliency,
                  const std::vector<std::uint32_t>& vertices) {
  p.vertices = vertices.size();
  if (vertices.empty()) return;
  p.base_saliency = std::numeric_limits<double>::infinity();
  for (const std::uint32_t v : vertices) {
    const auto s = static_cast<double>(saliency.values()[v]);
    p.total_saliency += s;
    p.peak_saliency = std::max(p.peak_saliency, s);
    p.base_saliency = std::min(p.base_saliency, s);
  }
  p.mean_saliency = p.total_saliency / static_cast<double>(vertices.size());
}

void add_shape(ClusterProperties& p, const Surface& surface, std::span<const std::uint32_t> faces) {
  p.triangles = faces.size();
  Vec3d sum;
  for (const std::uint32_t f : faces) {
    const Vec3d area = area_vector(surface, f);
    sum += area;
    p.area += length(area) / 2;
  }
  // What is left of normals that cancel out is rounding.
  constexpr double kLeastPart = 1e-12;
  if (!(length(sum) > kLeastPart * p.area)) {
    p.peak_deviation = std::numbers::pi;
    return;
  }
  p.mean_normal = normalized(sum);
  for (const std::uint32_t f : faces) {
    const Vec3d area = area_vector(surface, f);
    const double along = dot(area, p.mean_normal), across = length(cross(area, p.mean_normal));
    if (along != 0 || across != 0) p.peak_deviation = std::max(p.peak_deviation, std::atan2(across, along));
  }
}

/// Around the middle of their box.
Sphere sphere_around(const Surface& surface, const std::vector<std::uint32_t>& vertices) {
  Box box;
  for (const std::uint32_t v : vertices) box.add(surface.position(v));
  Sphere sphere{box.center(), 0};
  for (const std::uint32_t v : vertices)
    sphere.radius = std::max(sphere.radius, length(surface.position(v) - sphere.center));
  return sphere;
}

}  // namespace

std::vector<ClusterProperties> cluster_properties(const SceneSurface& scene, const VertexField& saliency,
                                                  const Clusters& clusters) {
  check_fit(scene, saliency, clusters);
  std::vector<ClusterProperties> properties(clusters.count);
  Walk walk(scene, clusters);
  for (std::uint32_t c = 0; c < clusters.count; ++c) {
    const std::vector<std::uint32_t>& vertices = walk.vertices(c);
    add_saliency(properties[c], saliency, vertices);
    add_shape(properties[c], scene.surface, walk.faces(c));
    properties[c].sphere = sphere_around(scene.surface, vertices);
  }
  return properties;
}

VertexField local_saliency(const SceneSurface& scene, const VertexField& saliency, const Clusters& clusters) {
  check_fit(scene, saliency, clusters);
  VertexField local(saliency.size());
  Walk walk(scene, clusters);
  for (std::uint32_t c = 0; c < clusters.count; ++c) {
    const std::vector<std::uint32_t>& vertices = walk.vertices(c);
    ClusterProperties p;
    add_saliency(p, saliency, vertices);
    const double range = p.peak_saliency - p.base_saliency;
    for (const std::uint32_t v : vertices) {
      const double above = static_cast<double>(saliency.values()[v]) - p.base_saliency;
      const double here = (range > 0 ? above / range : 0) + p.mean_saliency;
      local.values()[v] = std::max(local.values()[v], static_cast<float>(here));
    }
  }
  return local;
}

}  // namespace fovea
