#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

#include "fovea/base/context.h"
#include "fovea/base/parallel.h"
#include "fovea/texture/atlas.h"
#include "fovea/texture/barycentric.h"
#include "fovea/texture/texel_scan.h"

// Shared inside Fovea, not installed.

namespace fovea {

/// A picture in the space of an atlas: a T for each texel whose centre lies in a triangle.
template <class T>
struct AtlasRaster {
  int width = 0, height = 0;
  std::vector<T> texels;            // [height × width], T() where no triangle is
  std::vector<std::uint8_t> drawn;  // [height × width]

  std::size_t index(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x);
  }
};

/// Calls `visit(number, weights of corners, texel)` for each texel of the image whose centre lies in a
/// triangle, and for each triangle that it lies in, in their order; texels count row by row. O(#F + #texels),
/// parallel over bands of rows. Throws Error(cancelled).
template <class Visit>
void for_atlas_texels(std::span<const AtlasFace> faces, int width, int height, const Visit& visit,
                      const Context& context) {
  constexpr int kBand = 32;
  std::vector<std::vector<std::uint32_t>> bands(static_cast<std::size_t>((height + kBand - 1) / kBand));
  const auto band = [&](double v) {
    return std::min(static_cast<int>(std::clamp(v, 0.0, 1.0) * height), height - 1) / kBand;
  };
  for (std::uint32_t f = 0; f < faces.size(); ++f) {
    const auto [low, high] = std::minmax({faces[f].uv[0].y, faces[f].uv[1].y, faces[f].uv[2].y});
    for (int b = band(low); b <= band(high); ++b) bands[static_cast<std::size_t>(b)].push_back(f);
  }
  parallel_for_or_throw(context, bands.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t b = begin; b < end; ++b) {
      const std::int64_t top = static_cast<std::int64_t>(b) * kBand,
                         bottom = std::min<std::int64_t>(top + kBand, height);
      for (const std::uint32_t f : bands[b]) {
        std::array<Vec2d, 3> triangle;
        for (std::size_t k = 0; k < 3; ++k)
          triangle[k] = {faces[f].uv[k].x * width, faces[f].uv[k].y * height};
        const Barycentric barycentric(triangle);
        for_texel_rows(triangle, 1, [&](std::int64_t y, std::int64_t first, std::int64_t last) {
          if (y < top || y >= bottom) return;
          const std::int64_t from = std::max<std::int64_t>(first, 0),
                             to = std::min<std::int64_t>(last, width);
          for (std::int64_t x = from; x < to; ++x) {
            const Vec2d center{static_cast<double>(x) + 0.5, static_cast<double>(y) + 0.5};
            visit(f, clamped(barycentric.at(center)), static_cast<std::size_t>(y * width + x));
          }
        });
      }
    }
  });
}

/// Draws triangles: each texel whose centre lies in one gets `value(number, weights of corners)`; where
/// several lie, that of the first. As `for_atlas_texels`.
template <class T, class Value>
AtlasRaster<T> rasterized(std::span<const AtlasFace> faces, int width, int height, const Value& value,
                          const Context& context) {
  AtlasRaster<T> result{width, height, {}, {}};
  result.texels.resize(static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
  result.drawn.resize(result.texels.size(), 0);
  for_atlas_texels(
      faces, width, height,
      [&](std::uint32_t face, const std::array<double, 3>& weights, std::size_t texel) {
        if (result.drawn[texel] != 0) return;
        result.texels[texel] = value(face, weights);
        result.drawn[texel] = 1;
      },
      context);
  return result;
}

/// Calls `visit(number, weights of corners, texel)` for the texels that are read along the edges of triangles
/// by linear filters, also where a triangle is too thin to have a texel's centre; the weights are those of a
/// place on the edge. Many times for the same texels; in the triangles' order. O(#F + texels along edges).
template <class Visit>
void for_edge_texels(std::span<const AtlasFace> faces, int width, int height, const Visit& visit) {
  for (std::uint32_t f = 0; f < faces.size(); ++f) {
    for (std::size_t k = 0; k < 3; ++k) {
      const std::size_t next = (k + 1) % 3;
      const Vec2d from{faces[f].uv[k].x * width, faces[f].uv[k].y * height},
          to{faces[f].uv[next].x * width, faces[f].uv[next].y * height};
      const int steps = 1 + static_cast<int>(2 * std::hypot(to.x - from.x, to.y - from.y));
      for (int i = 0; i <= steps; ++i) {
        const double part = static_cast<double>(i) / steps;
        std::array<double, 3> weights{};
        weights[k] = 1 - part;
        weights[next] = part;
        const Vec2d at = from * (1 - part) + to * part;
        const int left = static_cast<int>(std::floor(at.x - 0.5)),
                  top = static_cast<int>(std::floor(at.y - 0.5));
        for (int y = std::max(top, 0); y < std::min(top + 2, height); ++y) {
          for (int x = std::max(left, 0); x < std::min(left + 2, width); ++x)
            visit(
                f, weights,
                static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x));
        }
      }
    }
  }
}

}  // namespace fovea
