#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "fovea/base/wide.h"
#include "fovea/model/material.h"
#include "fovea/texture/mip_map.h"

namespace fovea {

/// A display value per channel in a word: red in the lowest byte, then green, blue, alpha.
using PackedColor = std::uint32_t;
PackedColor packed(Rgba light);

/// A mip map as it looks through a factor, in display values of eight bits: for whoever looks very often and
/// can do without trilinear filtering. Four bytes per texel.
class DisplayTexture {
 public:
  /// Levels of more than `most` texels along a side are left out. O(#texels).
  DisplayTexture(const MipMap& map, Rgba factor, const Sampler& sampler, int most);

  /// The level whose texels are about as large as pixels, each of which covers so many texels of the whole
  /// image.
  std::size_t level_for(float texels_per_pixel) const;
  /// Texels of the image, all of them.
  float full_width() const { return full_width_; }
  float full_height() const { return full_height_; }
  /// Mixes the four texels around (u, v) (0 … 1, v down), which wraps as the sampler says; coordinates that
  /// are no numbers are 0.
  void at(std::size_t level, const WideFloats& u, const WideFloats& v, WideWords& out) const;
  PackedColor at(std::size_t level, Vec2f uv) const {
    WideFloats u{}, v{};
    WideWords out;
    u[0] = uv.x;
    v[0] = uv.y;
    at(level, u, v, out);
    return out[0];
  }

 private:
  struct Level {
    int width = 0, height = 0;
    std::size_t first = 0;
  };
  std::vector<Level> levels_;
  std::vector<PackedColor> texels_;
  Wrap wrap_u_ = Wrap::repeat, wrap_v_ = Wrap::repeat;
  float full_width_ = 1, full_height_ = 1;
  int left_out_ = 0;  // levels
};

}  // namespace fovea
