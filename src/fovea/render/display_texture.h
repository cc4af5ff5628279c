#pragma once

#include <cmath>
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

namespace display {

/// Two neighbouring texels along an axis, and how much the second counts, of 256.
struct TexelPairs {
  WideInts first, second;
  WideWords share;
};

FOVEA_WIDE_PART void find_pairs(const WideFloats& coordinates, int count, Wrap wrap, TexelPairs& out) {
  // What is no number is 0, too.
  WideFloats x = ((coordinates < 1e6f) & (coordinates > -1e6f)) ? coordinates : 0.0f;
  if (wrap == Wrap::mirror) x *= 0.5f;
  if (wrap != Wrap::clamp) {
    WideInts cut;
    convert(x, cut);
    WideFloats whole;
    convert(cut, whole);
    x -= whole;
    x += x < 0 ? WideFloats{} + 1.0f : WideFloats{};
  }
  if (wrap == Wrap::mirror) x = x > 0.5f ? 2 - 2 * x : 2 * x;
  const auto scale = static_cast<float>(count) * 256.0f;
  const std::int32_t last = count - 1, before_first = wrap == Wrap::repeat ? last : 0,
                     after_last = wrap == Wrap::repeat ? 0 : last;
  x = x > 0 ? (x < 1 ? x : 1.0f) : 0.0f;
  WideInts at;
  convert(x * scale, at);
  at -= 128;
  const WideInts below = at >> 8;
  out.share = reinterpret_cast<WideWords>(at & 255);
  out.first = below < 0 ? before_first : (below < last ? below : last);
  out.second = below < 0 ? 0 : (below < last ? below + 1 : after_last);
}

/// Mixes two channels at a time; `a` becomes the mixture.
FOVEA_WIDE_PART void mix(WideWords& a, const WideWords& b, const WideWords& share) {
  constexpr PackedColor kEven = 0x00FF00FF;
  const WideWords rest = 256 - share;
  const WideWords even = ((a & kEven) * rest + (b & kEven) * share) >> 8;
  const WideWords odd = ((a >> 8) & kEven) * rest + ((b >> 8) & kEven) * share;
  a = (even & kEven) | (odd & ~kEven);
}

FOVEA_WIDE_PART void mix_texels(const PackedColor* texels, std::int32_t width, const TexelPairs& x,
                                const TexelPairs& y, WideWords& out) {
  const WideInts above = y.first * width, below = y.second * width;
  WideWords top_left, top_right, bottom_left, bottom_right;
  for (std::size_t i = 0; i < kWide; ++i) {
    top_left[i] = texels[above[i] + x.first[i]];
    top_right[i] = texels[above[i] + x.second[i]];
    bottom_left[i] = texels[below[i] + x.first[i]];
    bottom_right[i] = texels[below[i] + x.second[i]];
  }
  mix(top_left, top_right, x.share);
  mix(bottom_left, bottom_right, x.share);
  mix(top_left, bottom_left, y.share);
  out = top_left;
}

}  // namespace display

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
  PackedColor at(std::size_t level, Vec2f uv) const;

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

FOVEA_WIDE_PART void DisplayTexture::at(std::size_t level, const WideFloats& u, const WideFloats& v,
                                        WideWords& out) const {
  const Level& l = levels_[level];
  display::TexelPairs x, y;
  display::find_pairs(u, l.width, wrap_u_, x);
  display::find_pairs(v, l.height, wrap_v_, y);
  display::mix_texels(texels_.data() + l.first, l.width, x, y, out);
}

}  // namespace fovea
