#include "fovea/render/projection.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace fovea {

namespace {

/// Screen coordinates stay below this, so that edge functions stay within 64 bits.
constexpr double kFarthest = 1 << 28;

}  // namespace

Projection::Projection(const View& view, const SampleGrid& grid) : view_(view) {
  half_width_ = view.half_height * grid.width / grid.height;
  pixel_ = 2 * view.half_height / grid.height;
  scale_ = grid.per_pixel * (1 << kSubsampleBits) / pixel_;
  center_x_ = 0.5 * grid.width * grid.per_pixel * (1 << kSubsampleBits);
  center_y_ = 0.5 * grid.height * grid.per_pixel * (1 << kSubsampleBits);
}

Vec2d Projection::to_plane(double x, double y) const {
  return {x * pixel_ - half_width_, view_.half_height - y * pixel_};
}

bool Projection::project(Vec3d eye, ScreenVertex& out) const {
  if (eye.z < view_.near || !(eye.z > 0 || !view_.perspective)) return false;
  const double scale = view_.perspective ? scale_ / eye.z : scale_;
  const double x = center_x_ + eye.x * scale, y = center_y_ - eye.y * scale;
  if (!(std::abs(x) < kFarthest && std::abs(y) < kFarthest)) return false;
  out.x = static_cast<std::int32_t>(std::floor(x + 0.5));
  out.y = static_cast<std::int32_t>(std::floor(y + 0.5));
  out.nearness = static_cast<float>(view_.perspective ? 1 / eye.z : -eye.z);
  return true;
}

std::vector<ScreenVertex> Projection::clip(const std::array<Vec3d, 3>& eye) const {
  std::vector<Vec3d> polygon(eye.begin(), eye.end()), next;
  // Keeps what has distance(p) ≥ 0, a linear function.
  const auto cut = [&](auto&& distance) {
    next.clear();
    for (std::size_t i = 0; i < polygon.size(); ++i) {
      const Vec3d a = polygon[i], b = polygon[(i + 1) % polygon.size()];
      const double da = distance(a), db = distance(b);
      if (da >= 0) next.push_back(a);
      if ((da >= 0) != (db >= 0)) next.push_back(a + (b - a) * (da / (da - db)));
    }
    std::swap(polygon, next);
  };
  const double near = view_.perspective ? std::max(view_.near, 1e-30) : view_.near;
  cut([&](Vec3d p) { return p.z - near; });
  // The sides of a field of view well within what can be put on the grid, and well beyond the picture.
  const double wide = 0.4 * kFarthest / scale_;
  const auto reach = [&](Vec3d p) { return view_.perspective ? p.z * wide : wide; };
  cut([&](Vec3d p) { return reach(p) - p.x; });
  cut([&](Vec3d p) { return reach(p) + p.x; });
  cut([&](Vec3d p) { return reach(p) - p.y; });
  cut([&](Vec3d p) { return reach(p) + p.y; });
  std::vector<ScreenVertex> result;
  for (Vec3d p : polygon) {
    p.z = std::max(p.z, near);  // rounding
    ScreenVertex v;
    if (!project(p, v)) return {};
    result.push_back(v);
  }
  return result.size() < 3 ? std::vector<ScreenVertex>{} : result;
}

}  // namespace fovea
