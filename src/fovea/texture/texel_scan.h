#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <utility>

#include "fovea/base/math.h"
#include "fovea/model/image.h"
#include "fovea/model/material.h"
#include "fovea/model/wrap.h"

// Shared inside Fovea, not installed.

namespace fovea {

/// Calls f(y, begin, end) for rows of texels whose centres (x + ½, y + ½), begin ≤ x < end, lie in a triangle
/// given in texels: each texel in one of two triangles that share an edge. Of rows and columns only those at
/// multiples of `step`; then begin is one. Either orientation.
template <class F>
void for_texel_rows(const std::array<Vec2d, 3>& triangle, std::int64_t step, F&& f) {
  const auto first_after = [&](double centre) {
    const auto i = static_cast<std::int64_t>(std::ceil(centre - 0.5));
    if (step == 1) return i;
    const std::int64_t rest = i % step;
    return rest == 0 ? i : i - rest + (rest > 0 ? step : 0);
  };
  const auto [low, high] = std::minmax({triangle[0].y, triangle[1].y, triangle[2].y});
  for (std::int64_t y = first_after(low); static_cast<double>(y) + 0.5 < high; y += step) {
    const double at = static_cast<double>(y) + 0.5;
    std::array<double, 2> x{};
    std::size_t crossings = 0;
    for (std::size_t k = 0; k < 3 && crossings < 2; ++k) {
      // From its lower end, so that both triangles of an edge see it at the same place.
      Vec2d p = triangle[k], q = triangle[(k + 1) % 3];
      if (p.y > q.y) std::swap(p, q);
      if (p.y <= at && at < q.y) x[crossings++] = p.x + (q.x - p.x) * ((at - p.y) / (q.y - p.y));
    }
    if (crossings < 2) continue;
    const std::int64_t begin = first_after(std::min(x[0], x[1])), end = first_after(std::max(x[0], x[1]));
    if (begin < end) f(y, begin, end);
  }
}

/// The four texels around a point given in texels, with their weights as bilinear filters have them.
struct BilinearTap {
  int x = 0, y = 0;
  double weight = 0;
};
inline std::array<BilinearTap, 4> bilinear_taps(Vec2d point, int width, int height, const Sampler& sampler) {
  const double left = std::floor(point.x - 0.5), top = std::floor(point.y - 0.5);
  const double fx = point.x - 0.5 - left, fy = point.y - 0.5 - top;
  const auto column = static_cast<std::int64_t>(left), row = static_cast<std::int64_t>(top);
  const int x0 = wrapped_texel(column, width, sampler.wrap_u),
            x1 = wrapped_texel(column + 1, width, sampler.wrap_u),
            y0 = wrapped_texel(row, height, sampler.wrap_v),
            y1 = wrapped_texel(row + 1, height, sampler.wrap_v);
  return {
      {{x0, y0, (1 - fx) * (1 - fy)}, {x1, y0, fx * (1 - fy)}, {x0, y1, (1 - fx) * fy}, {x1, y1, fx * fy}}};
}

/// Texels beyond a border repeat it; linear filters.
inline Sampler clamping_sampler() {
  return {.wrap_u = Wrap::clamp, .wrap_v = Wrap::clamp, .mag_filter = {}, .min_filter = {}, .json = {}};
}

/// What a bilinear filter finds at `uv`, 0 … 1: stored values, 0 … 1, of as many channels as there are.
inline std::array<double, 4> looked_up(const Image8& image, Vec2d uv, const Sampler& sampler) {
  std::array<double, 4> sum{};
  for (const BilinearTap& tap :
       bilinear_taps({uv.x * image.width, uv.y * image.height}, image.width, image.height, sampler)) {
    const std::uint8_t* texel = image.at(tap.x, tap.y);
    for (int k = 0; k < image.channels; ++k) sum[static_cast<std::size_t>(k)] += tap.weight * texel[k] / 255;
  }
  return sum;
}

}  // namespace fovea
