#include "fovea/surface/occlusion.h"

#include <utility>

#include "fovea/surface/embree_scene.h"

namespace fovea {

struct Occlusion::Tree {
  Tree(const Surface& triangles, std::vector<bool> both)
      : surface(&triangles), double_sided(std::move(both)), scene(triangles, [this](RTCGeometry geometry) {
          rtcSetGeometryUserData(geometry, this);
          rtcSetGeometryOccludedFilterFunction(geometry, skip_backs);
        }) {}

  /// Rays run from the point to the eye: they leave through what the eye sees the front of.
  static void skip_backs(const RTCFilterFunctionNArguments* arguments) {
    const Tree& tree = *static_cast<const Tree*>(arguments->geometryUserPtr);
    const unsigned triangle = RTCHitN_primID(arguments->hit, 1, 0);
    if (tree.double_sided[triangle]) return;
    const auto& t = tree.surface->triangles[triangle];
    const Vec3d p = tree.surface->position(t[0]);
    const Vec3d normal = cross(tree.surface->position(t[1]) - p, tree.surface->position(t[2]) - p);
    const Vec3d direction{RTCRayN_dir_x(arguments->ray, 1, 0), RTCRayN_dir_y(arguments->ray, 1, 0),
                          RTCRayN_dir_z(arguments->ray, 1, 0)};
    if (dot(normal, direction) <= 0) arguments->valid[0] = 0;
  }

  const Surface* surface;
  std::vector<bool> double_sided;
  EmbreeScene scene;
};

Occlusion::Occlusion(const Surface& surface, std::vector<bool> double_sided)
    : tree_(std::make_unique<Tree>(surface, std::move(double_sided))) {}
Occlusion::~Occlusion() = default;
Occlusion::Occlusion(Occlusion&&) noexcept = default;
Occlusion& Occlusion::operator=(Occlusion&&) noexcept = default;

bool Occlusion::hides(Vec3d point, Vec3d eye) const {
  if (tree_->scene.empty()) return false;
  const Vec3f from = tree_->scene.to_tree(point), along = tree_->scene.to_tree(eye - point);
  RTCRay ray{};
  ray.org_x = from.x;
  ray.org_y = from.y;
  ray.org_z = from.z;
  ray.dir_x = along.x;
  ray.dir_y = along.y;
  ray.dir_z = along.z;
  ray.tfar = 1;
  ray.mask = 0xFFFFFFFF;
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  rtcOccluded1(tree_->scene.get(), &context, &ray);
  return ray.tfar < 0;
}

}  // namespace fovea
