#include "fovea/texture/texel_loss.h"

#include <array>
#include <cassert>

#include "fovea/base/parallel.h"

namespace fovea {

namespace {

/// Rows that a thread takes at once.
constexpr std::size_t kGrain = 16;

using Texel = std::array<float, 4>;

Texel looked_up(const Image8& image, double u, double v) {
  const Sampler clamp{
      .wrap_u = Wrap::clamp, .wrap_v = Wrap::clamp, .mag_filter = {}, .min_filter = {}, .json = {}};
  Texel sum{};
  for (const BilinearTap& tap :
       bilinear_taps({u * image.width, v * image.height}, image.width, image.height, clamp)) {
    const std::uint8_t* texel = image.at(tap.x, tap.y);
    for (int k = 0; k < image.channels; ++k)
      sum[static_cast<std::size_t>(k)] += static_cast<float>(tap.weight) * static_cast<float>(texel[k]) / 255;
  }
  return sum;
}

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
  const bool has_alpha = before.channels % 2 == 0;
  const int channels = has_alpha && !meaning.transparent ? before.channels - 1 : before.channels;
  const float weight = loss_weight(meaning);
  ImageF result(places.width, places.height, 1, ColorEncoding::linear);
  parallel_for_or_throw(
      context, static_cast<std::size_t>(places.height), kGrain, [&](std::size_t begin, std::size_t end) {
        for (std::size_t row = begin; row < end; ++row) {
          const auto y = static_cast<int>(row);
          for (int x = 0; x < places.width; ++x) {
            const std::size_t i = places.index(x, y);
            if (places.drawn[i] == 0) continue;
            const Texel was = looked_up(before, (x + 0.5) / places.width, (y + 0.5) / places.height),
                        is = looked_up(after, static_cast<double>(places.texels[i].uv.x),
                                       static_cast<double>(places.texels[i].uv.y));
            float sum = 0;
            for (int k = 0; k < channels; ++k) {
              const float d = was[static_cast<std::size_t>(k)] - is[static_cast<std::size_t>(k)];
              sum += d * d;
            }
            *result.at(x, y) = weight * sum;
          }
        }
      });
  return result;
}

}  // namespace fovea
