#include "fovea/saliency/material_texels.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "fovea/base/parallel.h"
#include "fovea/base/srgb.h"
#include "fovea/texture/barycentric.h"
#include "fovea/texture/texel_scan.h"

namespace fovea {

namespace {

constexpr std::size_t kTexelRowGrain = 64;
constexpr float kByte = 1.0f / 255;

/// A plane of f(r, g, b) of the stored bytes.
template <class F>
ImageF plane_of(const Image8& image, const Context& context, F&& f) {
  ImageF plane(image.width, image.height, 1, ColorEncoding::linear);
  const int g = image.channels < 3 ? 0 : 1, b = image.channels < 3 ? 0 : 2;
  parallel_for(context, static_cast<std::size_t>(image.height), kTexelRowGrain,
               [&](std::size_t begin, std::size_t end) {
                 for (int y = static_cast<int>(begin); y < static_cast<int>(end); ++y) {
                   const std::uint8_t* texel = image.at(0, y);
                   float* const out = plane.at(0, y);
                   for (int x = 0; x < image.width; ++x, texel += image.channels)
                     out[x] = f(texel[0], texel[g], texel[b]);
                 }
               });
  return plane;
}

float grey_of_bytes(std::uint8_t r, std::uint8_t g, std::uint8_t b) {
  return grey(static_cast<float>(r), static_cast<float>(g), static_cast<float>(b)) * kByte;
}

/// 1 − z of the normal that a texel of a normal map stands for.
float bend(std::uint8_t r, std::uint8_t g, std::uint8_t b, float scale) {
  const auto part = [](std::uint8_t byte) { return static_cast<float>(2 * byte - 255) * kByte; };
  const float x = part(r) * scale, y = part(g) * scale, z = part(b);
  return 1 - z / std::sqrt(x * x + y * y + z * z);  // no byte stands for 0
}

std::vector<ImageF> planes_of(const TexelSource& source, const Sampler& sampler, const Image8& image,
                              const TextureSignalOptions& options, const Context& context) {
  const auto& factor = source.factor;
  const auto plane = [&](auto&& f) { return plane_of(image, context, f); };
  const auto scaled = [](std::uint8_t byte, double by) {
    return static_cast<float>(byte) * kByte * static_cast<float>(by);
  };
  std::vector<ImageF> planes;
  switch (source.role) {
    case TextureRole::base_color: {
      TextureSignals signals = texture_signals(image, sampler, options, context);
      planes.push_back(std::move(signals.intensity));
      planes.push_back(std::move(signals.opponency));
      planes.push_back(std::move(signals.entropy));
      break;
    }
    case TextureRole::emissive: planes.push_back(plane(grey_of_bytes)); break;
    case TextureRole::metallic_roughness:
      planes.push_back(plane([&](auto, auto g, auto) { return scaled(g, factor[1]); }));
      planes.push_back(plane([&](auto, auto, auto b) { return scaled(b, factor[2]); }));
      break;
    case TextureRole::normal:
      planes.push_back(
          plane([&](auto r, auto g, auto b) { return bend(r, g, b, static_cast<float>(factor[0])); }));
      break;
    case TextureRole::occlusion: break;
  }
  return planes;
}

}  // namespace

Signal first_signal(TextureRole role) {
  switch (role) {
    case TextureRole::base_color: return Signal::intensity;
    case TextureRole::emissive: return Signal::emission;
    case TextureRole::metallic_roughness: return Signal::roughness;
    case TextureRole::normal: return Signal::normal_detail;
    case TextureRole::occlusion: break;
  }
  return Signal::intensity;
}

ColorSignals signals_of_light(Vec3f light) {
  const auto display = [](float x) { return static_cast<float>(to_display(x)) * kByte; };
  return color_signals(display(light.x), display(light.y), display(light.z));
}

float grey_of_light(Vec3f light) {
  return grey_of_bytes(to_display(light.x), to_display(light.y), to_display(light.z));
}

MaterialTexels::MaterialTexels(const TexelSource& source, const Image8& image, bool tinted,
                               const TextureSignalOptions& options, const Context& context)
    : width_(image.width), height_(image.height) {
  sampler_.wrap_u = source.wrap_u;
  sampler_.wrap_v = source.wrap_v;
  const bool is_light = source.role == TextureRole::base_color || source.role == TextureRole::emissive;
  const bool has_factor = is_light && source.factor != std::array<double, 3>{1, 1, 1};
  const Image8 multiplied = has_factor ? with_factor(image, source.factor, context) : Image8();
  const Image8& seen = has_factor ? multiplied : image;
  planes_ = planes_of(source, sampler_, seen, options, context);
  for (std::size_t k = 0; k < 3; ++k) plane_[k] = planes_[std::min(k, planes_.size() - 1)].pixels.data();
  if (!tinted) return;
  smooth_ = smoothed(seen, sampler_, context);
  for (int i = 0; i <= kSmoothUnit; ++i)
    light_.push_back(srgb_to_linear(static_cast<float>(i) / kSmoothUnit));
}

/// `signals(texel, corners)` gives those of a texel at a place with these weights of the corners.
template <class F>
TexelMeans MaterialTexels::means_of(const std::array<Vec2d, 3>& triangle, std::int64_t step,
                                    F&& signals) const {
  const auto texel = [&](int x, int y) {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) + static_cast<std::size_t>(x);
  };
  const Barycentric barycentric(triangle);
  TexelMeans means;
  for_texel_rows(triangle, step, [&](std::int64_t y, std::int64_t begin, std::int64_t end) {
    const std::size_t row = texel(0, wrapped_texel(y, height_, sampler_.wrap_v));
    const double at = static_cast<double>(y) + 0.5;
    for (std::int64_t x = begin; x < end; x += step) {
      const auto column = static_cast<std::size_t>(wrapped_texel(x, width_, sampler_.wrap_u));
      const std::array<double, 3> corners = barycentric.at({static_cast<double>(x) + 0.5, at});
      means.add(signals(row + column, corners), corners);
    }
  });
  if (!means.empty()) return means;
  constexpr std::array<double, 3> kMiddle{1.0 / 3, 1.0 / 3, 1.0 / 3};
  const Vec2d middle = (triangle[0] + triangle[1] + triangle[2]) * (1.0 / 3);
  for (const BilinearTap& tap : bilinear_taps(middle, width_, height_, sampler_)) {
    if (tap.weight > 0) means.add(signals(texel(tap.x, tap.y), kMiddle), kMiddle, tap.weight);
  }
  return means;
}

TexelMeans MaterialTexels::means(const std::array<Vec2d, 3>& triangle, std::int64_t step) const {
  return means_of(triangle, step, [&](std::size_t texel, const auto&) {
    return std::array<float, 3>{plane_[0][texel], plane_[1][texel], plane_[2][texel]};
  });
}

TexelMeans MaterialTexels::means(const std::array<Vec2d, 3>& triangle, std::int64_t step,
                                 const std::array<Vec3f, 3>& tint) const {
  return means_of(triangle, step, [&](std::size_t texel, const std::array<double, 3>& corners) {
    Vec3f by;
    for (std::size_t k = 0; k < 3; ++k) by += tint[k] * static_cast<float>(corners[k]);
    const std::uint16_t* const smooth = smooth_.pixels.data() + 3 * texel;
    const ColorSignals color =
        signals_of_light({light_[smooth[0]] * by.x, light_[smooth[1]] * by.y, light_[smooth[2]] * by.z});
    return std::array<float, 3>{color.intensity, color.opponency, plane_[2][texel]};
  });
}

}  // namespace fovea
