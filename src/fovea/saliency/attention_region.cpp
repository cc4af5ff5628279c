#include "fovea/saliency/attention_region.h"

#include <algorithm>

#include "fovea/surface/closest_point.h"

namespace fovea {

namespace {

bool reaches_into(const Sphere& sphere, Vec3d a, Vec3d b, Vec3d c) {
  return length(closest_on_triangle(sphere.center, a, b, c).point - sphere.center) <= sphere.radius;
}

/// Cuts the triangle off at each side of the box (Sutherland and Hodgman 1974): whether anything is left.
bool reaches_into(const Box& box, Vec3d a, Vec3d b, Vec3d c) {
  std::vector<Vec3d> polygon{a, b, c}, rest;
  for (const auto& axis : {&Vec3d::x, &Vec3d::y, &Vec3d::z}) {
    for (const bool high : {false, true}) {
      const auto depth = [&](Vec3d p) { return high ? box.high.*axis - p.*axis : p.*axis - box.low.*axis; };
      rest.clear();
      for (std::size_t i = 0; i < polygon.size(); ++i) {
        const Vec3d p = polygon[i], q = polygon[(i + 1) % polygon.size()];
        const double of_p = depth(p), of_q = depth(q);
        if (of_p >= 0) rest.push_back(p);
        if ((of_p < 0) != (of_q < 0)) rest.push_back(p + (q - p) * (of_p / (of_p - of_q)));
      }
      polygon.swap(rest);
      if (polygon.empty()) return false;
    }
  }
  return true;
}

}  // namespace

bool reaches_into(const AttentionRegions& regions, Vec3d a, Vec3d b, Vec3d c) {
  const auto reaches = [&](const auto& region) { return reaches_into(region, a, b, c); };
  return std::ranges::any_of(regions.spheres, reaches) || std::ranges::any_of(regions.boxes, reaches);
}

std::uint64_t attend_regions(const Model& model, const Pose& pose, const AttentionRegions& regions,
                             float factor, std::vector<VertexField>& shares) {
  std::uint64_t count = 0;
  for (const Instance& instance : instances(model, pose)) {
    const TriMesh& mesh = model.meshes[instance.mesh].surface;
    const std::vector<Vec3f> positions = posed_surface(model, pose, instance).positions;
    for (const auto& t : mesh.triangles) {
      const auto at = [&](std::size_t k) { return Vec3d(positions[t[k].index()]); };
      if (!reaches_into(regions, at(0), at(1), at(2))) continue;
      ++count;
      for (const VertexId v : t) {
        float& share = shares[instance.mesh][v];
        share = std::min(share, factor);
      }
    }
  }
  return count;
}

}  // namespace fovea
