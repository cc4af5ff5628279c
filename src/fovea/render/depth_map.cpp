#include "fovea/render/depth_map.h"

#include <algorithm>
#include <cmath>

#include "fovea/render/render.h"

namespace fovea {

PicturePoint picture_point(const View& view, int size, Vec3d p) {
  const Vec3d eye = view.to_eye(p);
  const double pixel = pixel_width(view, size, eye.z);
  return {size * 0.5 + eye.x / pixel, size * 0.5 - eye.y / pixel, eye.z};
}

double pixel_width(const View& view, int size, double distance) {
  return 2 * view.half_height / size * (view.perspective ? distance : 1);
}

DepthMap::DepthMap(const RenderScene& scene, const View& view, int size, const Context& context)
    : view_(view), size_(size), depth_(static_cast<std::size_t>(size) * static_cast<std::size_t>(size)) {
  const VisibleSurface nearest = visible_surface(scene, view, size, size, context);
  const auto clamp = [&](int i) { return std::clamp(i, 0, size_ - 1); };
  for (int y = 0; y < size_; ++y) {
    for (int x = 0; x < size_; ++x) {
      float farthest = 0;
      for (int dy = -1; dy <= 1; ++dy) {
        for (int dx = -1; dx <= 1; ++dx)
          farthest = std::max(farthest, nearest.distance[at(clamp(x + dx), clamp(y + dy))]);
      }
      depth_[at(x, y)] = static_cast<double>(farthest);
    }
  }
}

bool DepthMap::shows(Vec3d p) const {
  const PicturePoint point = picture_point(view_, size_, p);
  if (view_.perspective && point.distance <= 0) return false;
  const auto cell = [&](double x) { return static_cast<int>(std::clamp(std::floor(x), 0.0, size_ - 1.0)); };
  return point.distance <=
         depth_[at(cell(point.x), cell(point.y))] + pixel_width(view_, size_, point.distance);
}

}  // namespace fovea
