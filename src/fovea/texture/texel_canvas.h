#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "fovea/base/math.h"
#include "fovea/model/material.h"
#include "fovea/model/wrap.h"
#include "fovea/texture/barycentric.h"
#include "fovea/texture/texel_scan.h"

// Shared inside Fovea, not installed.

namespace fovea {

/// A picture in texture space that triangles are drawn into: a T for each texel that has one.
/// `merge(T, T)` says what stays where several come together.
template <class T>
class TexelCanvas {
 public:
  TexelCanvas(int width, int height)
      : width_(width),
        height_(height),
        values_(static_cast<std::size_t>(width) * static_cast<std::size_t>(height)),
        is_drawn_(values_.size(), 0) {}

  int width() const { return width_; }
  int height() const { return height_; }
  bool is_drawn(int x, int y) const { return is_drawn_[index(x, y)] != 0; }
  /// T() where nothing is drawn.
  const T& at(int x, int y) const { return values_[index(x, y)]; }

  /// Draws a triangle given in texels: those whose centres it covers get `value(weights)`, of the weights of
  /// corners there; if there are none, the texel at its middle does. O(#texels covered).
  template <class Value, class Merge>
  void draw(const std::array<Vec2d, 3>& triangle, const Sampler& sampler, Value&& value, Merge&& merge) {
    const Barycentric barycentric(triangle);
    bool drawn = false;
    for_texel_rows(triangle, 1, [&](std::int64_t y, std::int64_t begin, std::int64_t end) {
      drawn = true;
      const int row = wrapped_texel(y, height_, sampler.wrap_v);
      for (std::int64_t x = begin; x < end; ++x) {
        const Vec2d centre{static_cast<double>(x) + 0.5, static_cast<double>(y) + 0.5};
        put(wrapped_texel(x, width_, sampler.wrap_u), row, value(clamped(barycentric.at(centre))), merge);
      }
    });
    if (drawn) return;
    const Vec2d middle = (triangle[0] + triangle[1] + triangle[2]) * (1.0 / 3);
    put(wrapped_texel(static_cast<std::int64_t>(std::floor(middle.x)), width_, sampler.wrap_u),
        wrapped_texel(static_cast<std::int64_t>(std::floor(middle.y)), height_, sampler.wrap_v),
        value({1.0 / 3, 1.0 / 3, 1.0 / 3}), merge);
  }

  /// Lets what is drawn go on over `texels` more, so that filters find nothing else there.
  template <class Merge>
  void grow(int texels, Merge&& merge) {
    for (int i = 0; i < texels; ++i) grow(merge);
  }

 private:
  std::size_t index(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) + static_cast<std::size_t>(x);
  }

  template <class Merge>
  void put(int x, int y, const T& value, Merge&& merge) {
    const std::size_t i = index(x, y);
    values_[i] = is_drawn_[i] != 0 ? merge(values_[i], value) : value;
    is_drawn_[i] = 1;
  }

  template <class Merge>
  void grow(Merge&& merge) {
    const std::vector<std::uint8_t> was_drawn = is_drawn_;
    for (int y = 0; y < height_; ++y) {
      for (int x = 0; x < width_; ++x) {
        if (was_drawn[index(x, y)] != 0) continue;
        for (const auto& [dx, dy] : {std::pair{-1, 0}, {1, 0}, {0, -1}, {0, 1}}) {
          const int nx = x + dx, ny = y + dy;
          if (nx >= 0 && ny >= 0 && nx < width_ && ny < height_ && was_drawn[index(nx, ny)] != 0)
            put(x, y, values_[index(nx, ny)], merge);
        }
      }
    }
  }

  int width_, height_;
  std::vector<T> values_;
  std::vector<std::uint8_t> is_drawn_;
};

}  // namespace fovea
