#pragma once

#include <array>
#include <cstddef>

#include "fovea/base/float4.h"
#include "fovea/render/screen_vertex.h"

namespace fovea {

/// Numbers at the corners of a triangle as functions of the pixel: divided by that of 1 they are what lies
/// between the corners in perspective. Pure functions of the screen vertices.
class CornerPlanes {
 public:
  /// `v` has an area and one sample per pixel.
  CornerPlanes(const std::array<ScreenVertex, 3>& v, bool perspective) {
    const double inverse = 1 / static_cast<double>(double_area(v));
    for (std::size_t k = 0; k < 3; ++k) {
      const ScreenVertex &p = v[(k + 1) % 3], &q = v[(k + 2) % 3];
      const double px = p.x, py = p.y, dx = q.x - px, dy = q.y - py;
      // Twice the area of the triangle p, q, pixel; over that of the whole it is the weight on the screen.
      const double share = inverse * (perspective ? static_cast<double>(v[k].nearness) : 1.0);
      constexpr double kHalf = kSubsamples / 2;
      at_0_[k] = static_cast<float>((dx * (kHalf - py) - dy * (kHalf - px)) * share);
      dx_[k] = static_cast<float>(-dy * kSubsamples * share);
      dy_[k] = static_cast<float>(dx * kSubsamples * share);
    }
  }

  /// Four numbers at once.
  struct Plane {
    Float4 at_0{}, dx{}, dy{};
    Float4 operator()(int x, int y) const {
      return at_0 + dx * static_cast<float>(x) + dy * static_cast<float>(y);
    }
  };
  Plane plane(const std::array<Float4, 3>& corners) const {
    Plane plane;
    for (std::size_t k = 0; k < 3; ++k) {
      plane.at_0 += corners[k] * at_0_[k];
      plane.dx += corners[k] * dx_[k];
      plane.dy += corners[k] * dy_[k];
    }
    return plane;
  }

 private:
  std::array<float, 3> at_0_, dx_, dy_;
};

}  // namespace fovea
