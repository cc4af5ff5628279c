#pragma once

#include <array>

#include "fovea/render/screen_vertex.h"

namespace fovea {

/// How much each corner of a triangle counts at a pixel: perspective-correct weights that add up to 1, as
/// functions of the pixel. A pure function of the screen vertices.
class CornerWeights {
 public:
  /// `v` has an area and one sample per pixel.
  CornerWeights(const std::array<ScreenVertex, 3>& v, bool perspective) {
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

  std::array<float, 3> at(int x, int y) const {
    const auto fx = static_cast<float>(x), fy = static_cast<float>(y);
    std::array<float, 3> w;
    for (std::size_t k = 0; k < 3; ++k) w[k] = at_0_[k] + dx_[k] * fx + dy_[k] * fy;
    const float inverse = 1 / (w[0] + w[1] + w[2]);
    for (float& x_k : w) x_k *= inverse;
    return w;
  }

 private:
  std::array<float, 3> at_0_, dx_, dy_;
};

}  // namespace fovea
