#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "fovea/model/material.h"
#include "fovea/render/mip_map.h"

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
  /// Mixes the four texels around `uv` (0 … 1, v down), which wraps as the sampler says; coordinates that are
  /// no numbers are 0.
  PackedColor at(std::size_t level, Vec2f uv) const {
    const Level& l = levels_[level];
    const Pair x = pair(uv.x, l.width, wrap_u_), y = pair(uv.y, l.height, wrap_v_);
    const PackedColor* const texels = texels_.data() + l.first;
    const auto row = [&](int r) {
      const PackedColor* const row_texels =
          texels + static_cast<std::size_t>(r) * static_cast<std::size_t>(l.width);
      return mixed(row_texels[x.first], row_texels[x.second], x.share);
    };
    return mixed(row(y.first), row(y.second), y.share);
  }

 private:
  struct Level {
    int width = 0, height = 0;
    std::size_t first = 0;
  };
  /// Two neighbouring texels and how much the second counts, of 256.
  struct Pair {
    int first, second;
    std::uint32_t share;
  };
  /// To 0 … 1.
  static float wrapped(float x, Wrap wrap) {
    if (!(std::abs(x) < 1e6f)) return 0;  // nor what is no number
    if (wrap == Wrap::mirror) x *= 0.5f;
    if (wrap != Wrap::clamp) {
      x -= static_cast<float>(static_cast<int>(x));
      if (x < 0) x += 1;
      if (wrap == Wrap::mirror) x = x > 0.5f ? 2 - 2 * x : 2 * x;
    }
    return std::clamp(x, 0.0f, 1.0f);
  }
  static Pair pair(float x, int count, Wrap wrap) {
    const int at = static_cast<int>(wrapped(x, wrap) * static_cast<float>(count) * 256.0f) - 128;
    const int below = at >> 8, last = count - 1;
    const auto share = static_cast<std::uint32_t>(at & 255);
    if (below < 0) return {wrap == Wrap::repeat ? last : 0, 0, share};
    if (below >= last) return {last, wrap == Wrap::repeat ? 0 : last, share};
    return {below, below + 1, share};
  }
  /// Mixes two channels at a time.
  static PackedColor mixed(PackedColor a, PackedColor b, std::uint32_t share) {
    constexpr PackedColor kEven = 0x00FF00FF;
    const std::uint32_t rest = 256 - share;
    const PackedColor even = ((a & kEven) * rest + (b & kEven) * share) >> 8;
    const PackedColor odd = ((a >> 8) & kEven) * rest + ((b >> 8) & kEven) * share;
    return (even & kEven) | (odd & ~kEven);
  }

  std::vector<Level> levels_;
  std::vector<PackedColor> texels_;
  Wrap wrap_u_ = Wrap::repeat, wrap_v_ = Wrap::repeat;
  float full_width_ = 1, full_height_ = 1;
  int left_out_ = 0;  // levels
};

}  // namespace fovea
