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

/// Which texels a look into a map reads, and with what weights. The same for all maps of one size, so that
/// those of a material are looked up with one footprint.
struct Footprint {
  static constexpr int kMostLooks = 16;
  struct Tap {
    std::uint32_t texel;
    float weight;
  };
  std::array<Tap, std::size_t{8} * kMostLooks> taps;
  std::size_t count = 0;
};

/// An image with its smaller copies down to one texel, to be looked up the way GPUs do: colours are decoded
/// to light before they are mixed, levels are made by averaging light over boxes (of any size: odd rows and
/// columns are shared by weight). Eight bytes per texel.
class MipMap {
 public:
  MipMap() = default;
  /// Takes any number of channels; missing colours repeat grey, missing alpha is opaque.
  MipMap(const Image8& image, ColorEncoding encoding);

  int width() const { return levels_.empty() ? 0 : levels_[0].width; }
  int height() const { return levels_.empty() ? 0 : levels_[0].height; }
  std::size_t level_count() const { return levels_.size(); }
  Rgba texel(std::size_t level, int x, int y) const;

  /// The look around `uv` (0 … 1, v down), filtered as `sampler` says: by its magnification filter where a
  /// pixel is less than a texel, else by its minification filter; without one, linear and trilinear. Up to
  /// `anisotropy` trilinear looks are spread along the longer slope.
  Footprint footprint(Vec2f uv, const UvSlopes& slopes, const Sampler& sampler, int anisotropy = 1) const;
  /// What a look at a map of this size sees of this one.
  Rgba sample(const Footprint& footprint) const;
  Rgba sample(Vec2f uv, const UvSlopes& slopes, const Sampler& sampler, int anisotropy = 1) const {
    return sample(footprint(uv, slopes, sampler, anisotropy));
  }

 private:
  struct Level {
    int width = 0, height = 0;
    std::uint32_t first = 0;  // texel
    std::uint32_t at(int x, int y) const {
      return first + static_cast<std::uint32_t>(y) * static_cast<std::uint32_t>(width) +
             static_cast<std::uint32_t>(x);
    }
  };
  using Texel = std::array<std::uint16_t, 4>;

  void add_half(const Level& level);
  void add_look(Footprint& footprint, float lod, Vec2f uv, const Sampler& sampler, float weight) const;
  static void add_nearest(Footprint& footprint, const Level& level, Vec2f uv, const Sampler& sampler,
                          float weight);
  static void add_bilinear(Footprint& footprint, const Level& level, Vec2f uv, const Sampler& sampler,
                           float weight);

  std::vector<Level> levels_;
  std::vector<Texel> texels_;  // of all levels: RGBA as light, 65535 is 1
};

}  // namespace fovea
