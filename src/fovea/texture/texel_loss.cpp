#include "fovea/texture/texel_loss.h"

#include <array>
#include <cassert>

#include "fovea/base/parallel.h"
#include "fovea/texture/texel_scan.h"

namespace fovea {

namespace {

/// Rows that a thread takes at once.
constexpr std::size_t kGrain = 16;

}  // namespace

float loss_weight(const TexelMeaning& meaning) {
  switch (meaning.kind) {
    case TexelMeaning::Kind::color: return 1;
    case TexelMeaning::Kind::normal: return 0.5f;
    case TexelMeaning::Kind::data: break;
  }
  return 0.25f;
}

ImageF texel_losses(const Image8& before, const Image8& after, const TexelMeaning& meaning,
                    const TexelOrigins& places, const Context& context) {
  assert(before.channels == after.channels);
  const int channels = meaning.transparent ? before.channels : before.color_channels();
  const float weight = loss_weight(meaning);
  const Sampler clamp = clamping_sampler();
  ImageF result(places.width, places.height, 1, ColorEncoding::linear);
  parallel_for_or_throw(
      context, static_cast<std::size_t>(places.height), kGrain, [&](std::size_t begin, std::size_t end) {
        for (std::size_t row = begin; row < end; ++row) {
          const auto y = static_cast<int>(row);
          for (int x = 0; x < places.width; ++x) {
            const std::size_t i = places.index(x, y);
            if (places.drawn[i] == 0) continue;
            const TexelOrigin& place = places.texels[i];
            const auto was = looked_up(before, {(x + 0.5) / places.width, (y + 0.5) / places.height}, clamp),
                       is = looked_up(after,
                                      Vec2d{static_cast<double>(place.uv.x), static_cast<double>(place.uv.y)},
                                      clamp);
            double sum = 0;
            for (std::size_t k = 0; k < static_cast<std::size_t>(channels); ++k)
              sum += (was[k] - is[k]) * (was[k] - is[k]);
            *result.at(x, y) = weight * static_cast<float>(sum);
          }
        }
      });
  return result;
}

}  // namespace fovea
