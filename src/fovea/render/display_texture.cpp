#include "fovea/render/display_texture.h"

#include <algorithm>
#include <cmath>

#include "fovea/base/srgb.h"

namespace fovea {

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

PackedColor DisplayTexture::at(std::size_t level, Vec2f uv) const {
  WideFloats u{}, v{};
  WideWords out;
  u[0] = uv.x;
  v[0] = uv.y;
  at(level, u, v, out);
  return out[0];
}

std::size_t DisplayTexture::level_for(float texels_per_pixel) const {
  if (!(texels_per_pixel > 1)) return 0;
  constexpr float kMost = 1e18f;  // more than any image has; of infinity there is no exponent
  const int level = (std::ilogb(std::min(texels_per_pixel, kMost)) + 1) / 2 - left_out_;
  return static_cast<std::size_t>(std::clamp(level, 0, static_cast<int>(levels_.size()) - 1));
}

}  // namespace fovea
