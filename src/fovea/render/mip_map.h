#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "fovea/base/math.h"
#include "fovea/model/image.h"
#include "fovea/model/material.h"

namespace fovea {

/// Red, green, blue, alpha: light where they are colours, each 0 … 1 and beyond.
struct Rgba {
  float r = 0, g = 0, b = 0, a = 1;
  friend constexpr Rgba operator+(Rgba x, Rgba y) { return {x.r + y.r, x.g + y.g, x.b + y.b, x.a + y.a}; }
  friend constexpr Rgba operator*(Rgba x, float s) { return {x.r * s, x.g * s, x.b * s, x.a * s}; }
  friend constexpr Rgba operator*(Rgba x, Rgba y) { return {x.r * y.r, x.g * y.g, x.b * y.b, x.a * y.a}; }
  friend constexpr bool operator==(Rgba, Rgba) = default;
};

/// How a texture's coordinates change from a pixel to the next to the right and the next below.
struct UvSlopes {
  Vec2f dx, dy;
};

/// An image with its smaller copies down to one texel, to be looked up the way GPUs do: texels are four
/// bytes, colours are decoded to light before they are mixed, levels are made by averaging light over boxes
/// (of any size: odd rows and columns are shared by weight).
class MipMap {
 public:
  MipMap() = default;
  /// Takes any number of channels; missing colours repeat grey, missing alpha is opaque.
  MipMap(const Image8& image, ColorEncoding encoding);

  int width() const { return levels_.empty() ? 0 : levels_[0].width; }
  int height() const { return levels_.empty() ? 0 : levels_[0].height; }
  std::size_t level_count() const { return levels_.size(); }
  /// Texel of a level, decoded.
  Rgba texel(std::size_t level, int x, int y) const { return decode(levels_[level].at(x, y)); }

  /// The texture around `uv` (0 … 1, v down), filtered as `sampler` says: its magnification filter where a
  /// pixel is less than a texel, else its minification filter; without one, linear and trilinear. Up to
  /// `anisotropy` trilinear looks are spread along the longer slope.
  Rgba sample(Vec2f uv, const UvSlopes& slopes, const Sampler& sampler, int anisotropy = 1) const;

 private:
  struct Level {
    int width = 0, height = 0;
    std::vector<std::uint32_t> texels;  // [height × width], red in the lowest byte
    std::uint32_t at(int x, int y) const {
      return texels[static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
                    static_cast<std::size_t>(x)];
    }
  };

  Rgba decode(std::uint32_t texel) const {
    return {(*to_light_)[texel & 0xFF], (*to_light_)[texel >> 8 & 0xFF], (*to_light_)[texel >> 16 & 0xFF],
            static_cast<float>(texel >> 24) * (1.0f / 255)};
  }
  Level halved(const Level& level, bool srgb) const;
  Rgba nearest(const Level& level, Vec2f uv, const Sampler& sampler) const;
  Rgba bilinear(const Level& level, Vec2f uv, const Sampler& sampler) const;
  Rgba trilinear(float lod, Vec2f uv, const Sampler& sampler) const;

  std::vector<Level> levels_;
  const std::array<float, 256>* to_light_ = nullptr;
};

/// Display value (sRGB curve) of an amount of light in [0, 1], as a byte: the nearest. The same bits on every
/// machine, unlike std::pow.
std::uint8_t to_display(float light);
/// Amount of light of a display value.
float to_light(std::uint8_t display);

}  // namespace fovea
