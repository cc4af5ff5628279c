#include "fovea/render/display_texture.h"

#include <algorithm>
#include <cmath>

#include "fovea/base/srgb.h"

namespace fovea {

namespace {

/// Two neighbouring texels along an axis, and how much the second counts, of 256.
struct TexelPairs {
  WideInts first, second;
  WideWords share;
};

FOVEA_WIDE void find_pairs(const WideFloats& __restrict coordinates, int count, Wrap wrap,
                           TexelPairs& __restrict out) {
  WideFloats x;
  for (std::size_t i = 0; i < kWide; ++i)  // what is no number is 0, too
    x[i] = std::abs(coordinates[i]) < 1e6f ? coordinates[i] : 0.0f;
  if (wrap == Wrap::mirror) {
    for (float& a : x) a *= 0.5f;
  }
  if (wrap != Wrap::clamp) {
    for (float& a : x) {
      a -= static_cast<float>(static_cast<std::int32_t>(a));
      a += a < 0 ? 1.0f : 0.0f;
    }
  }
  if (wrap == Wrap::mirror) {
    for (float& a : x) a = a > 0.5f ? 2 - 2 * a : 2 * a;
  }
  const auto scale = static_cast<float>(count) * 256.0f;
  const std::int32_t last = count - 1, before_first = wrap == Wrap::repeat ? last : 0,
                     after_last = wrap == Wrap::repeat ? 0 : last;
  for (std::size_t i = 0; i < kWide; ++i) {
    const float a = x[i] > 0 ? (x[i] < 1 ? x[i] : 1.0f) : 0.0f;
    const std::int32_t at = static_cast<std::int32_t>(a * scale) - 128, below = at >> 8;
    out.share[i] = static_cast<std::uint32_t>(at & 255);
    out.first[i] = below < 0 ? before_first : (below < last ? below : last);
    out.second[i] = below < 0 ? 0 : (below < last ? below + 1 : after_last);
  }
}

/// Mixes two channels at a time.
inline PackedColor mixed(PackedColor a, PackedColor b, std::uint32_t share) {
  constexpr PackedColor kEven = 0x00FF00FF;
  const std::uint32_t rest = 256 - share;
  const PackedColor even = ((a & kEven) * rest + (b & kEven) * share) >> 8;
  const PackedColor odd = ((a >> 8) & kEven) * rest + ((b >> 8) & kEven) * share;
  return (even & kEven) | (odd & ~kEven);
}

FOVEA_WIDE void mix_texels(const PackedColor* __restrict texels, std::int32_t width,
                           const TexelPairs& __restrict x, const TexelPairs& __restrict y,
                           WideWords& __restrict out) {
  for (std::size_t i = 0; i < kWide; ++i) {
    const std::int32_t above = y.first[i] * width, below = y.second[i] * width;
    const PackedColor top = mixed(texels[above + x.first[i]], texels[above + x.second[i]], x.share[i]);
    const PackedColor bottom = mixed(texels[below + x.first[i]], texels[below + x.second[i]], x.share[i]);
    out[i] = mixed(top, bottom, y.share[i]);
  }
}

}  // namespace

PackedColor packed(Rgba light) {
  const auto alpha = static_cast<PackedColor>(std::clamp(light.a, 0.0f, 1.0f) * 255 + 0.5f);
  return to_display(light.r) | PackedColor{to_display(light.g)} << 8 |
         PackedColor{to_display(light.b)} << 16 | alpha << 24;
}

DisplayTexture::DisplayTexture(const MipMap& map, Rgba factor, const Sampler& sampler, int most)
    : wrap_u_(sampler.wrap_u),
      wrap_v_(sampler.wrap_v),
      full_width_(static_cast<float>(map.width())),
      full_height_(static_cast<float>(map.height())) {
  int width = map.width(), height = map.height();
  for (std::size_t l = 0; l < map.level_count(); ++l) {
    if (std::max(width, height) > most && l + 1 < map.level_count()) {
      ++left_out_;
    } else {
      levels_.push_back({width, height, texels_.size()});
      for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x) texels_.push_back(packed(map.texel(l, x, y) * factor));
      }
    }
    width = std::max(1, width / 2);
    height = std::max(1, height / 2);
  }
}

void DisplayTexture::at(std::size_t level, const WideFloats& u, const WideFloats& v, WideWords& out) const {
  const Level& l = levels_[level];
  TexelPairs x, y;
  find_pairs(u, l.width, wrap_u_, x);
  find_pairs(v, l.height, wrap_v_, y);
  mix_texels(texels_.data() + l.first, l.width, x, y, out);
}

std::size_t DisplayTexture::level_for(float texels_per_pixel) const {
  if (!(texels_per_pixel > 1)) return 0;
  constexpr float kMost = 1e18f;  // more than any image has; of infinity there is no exponent
  const int level = (std::ilogb(std::min(texels_per_pixel, kMost)) + 1) / 2 - left_out_;
  return static_cast<std::size_t>(std::clamp(level, 0, static_cast<int>(levels_.size()) - 1));
}

}  // namespace fovea
