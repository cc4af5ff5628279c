#include "fovea/texture/mip_map.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>

#include "fovea/base/float4.h"
#include "fovea/base/srgb.h"
#include "fovea/model/wrap.h"

namespace fovea {

namespace {

// Numbers that go together through one register.
using Int4 [[gnu::vector_size(16)]] = std::int32_t;
using Short8 [[gnu::vector_size(16)]] = std::uint16_t;
using Long2 [[gnu::vector_size(16)]] = std::uint64_t;

/// Four 16-bit numbers in memory as floats.
Float4 load_floats(const std::uint16_t* from) {
  std::uint64_t bits;
  std::memcpy(&bits, from, sizeof bits);
  const auto numbers = std::bit_cast<Short8>(Long2{bits, 0});
  const Short8 widened = __builtin_shufflevector(numbers, Short8{}, 0, 8, 1, 9, 2, 10, 3, 11);
  return __builtin_convertvector(std::bit_cast<Int4>(widened), Float4);
}

constexpr float kUnit = 65535;
/// Squared slope in texels beyond which nothing but the mean is seen.
constexpr float kSteepest = 1e30f;
constexpr int kNearest = 9728, kLinear = 9729, kNearestMipNearest = 9984, kLinearMipNearest = 9985,
              kNearestMipLinear = 9986;

/// log2 of a positive number, to 0.0002: the exponent and a quartic over the mantissa.
float fast_log2(float x) {
  const auto bits = std::bit_cast<std::uint32_t>(x);
  const auto exponent = static_cast<float>(static_cast<int>(bits >> 23) - 127);
  const float m = std::bit_cast<float>((bits & 0x007FFFFFu) | 0x3F800000u) - 1;
  return exponent + m * (1.4387257f + m * (-0.6777838f + m * (0.3211887f - m * 0.0821306f)));
}

/// A texel index next to the range brought back into it.
int wrapped(int i, int size, Wrap wrap) {
  if (wrap == Wrap::repeat) return i < 0 ? i + size : i >= size ? i - size : i;
  return std::clamp(i, 0, size - 1);  // a mirrored edge repeats its texel
}

/// How much a row of `from` texels gives to one of `to` ≤ `from` texels: those that it overlaps, by overlap.
struct Overlap {
  int first = 0, count = 0;
  std::array<float, 4> weights{};
};

Overlap overlap(int i, int from, int to) {
  const double scale = static_cast<double>(from) / to, begin = i * scale, end = (i + 1) * scale;
  Overlap o;
  o.first = static_cast<int>(begin);
  for (int k = o.first; k < from && k < end && o.count < 4; ++k) {
    const double share = std::min(end, k + 1.0) - std::max(begin, static_cast<double>(k));
    o.weights[static_cast<std::size_t>(o.count++)] = static_cast<float>(share / scale);
  }
  return o;
}

}  // namespace

MipMap::MipMap(const Image8& image, ColorEncoding encoding) {
  std::array<std::uint16_t, 256> value, alpha;
  for (std::size_t i = 0; i < 256; ++i) {
    alpha[i] = static_cast<std::uint16_t>(i * 257);
    value[i] = encoding == ColorEncoding::linear
                   ? alpha[i]
                   : static_cast<std::uint16_t>(to_light(static_cast<std::uint8_t>(i)) * kUnit + 0.5f);
  }
  const std::size_t count = static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height);
  texels_.reserve(count + count / 3 + 64);
  const int channels = image.channels;
  for (std::size_t i = 0; i < count; ++i) {
    const std::uint8_t* p = image.pixels.data() + i * static_cast<std::size_t>(channels);
    const std::uint8_t green = channels < 3 ? p[0] : p[1], blue = channels < 3 ? p[0] : p[2];
    const std::uint8_t a = channels == 2 ? p[1] : channels == 4 ? p[3] : 255;
    texels_.push_back({value[p[0]], value[green], value[blue], alpha[a]});
  }
  levels_.push_back({image.width, image.height, 0});
  while (levels_.back().width > 1 || levels_.back().height > 1) add_half(levels_.back());
}

void MipMap::add_half(const Level& level) {
  const Level half{std::max(level.width / 2, 1), std::max(level.height / 2, 1),
                   static_cast<std::uint32_t>(texels_.size())};
  if (level.width == 2 * half.width && level.height == 2 * half.height) {
    // The same as below, in whole numbers.
    for (int y = 0; y < half.height; ++y) {
      for (int x = 0; x < half.width; ++x) {
        const std::uint32_t above = level.at(2 * x, 2 * y), below = level.at(2 * x, 2 * y + 1);
        Texel mean;
        for (std::size_t k = 0; k < 4; ++k) {
          const unsigned sum =
              unsigned{texels_[above][k]} + texels_[above + 1][k] + texels_[below][k] + texels_[below + 1][k];
          mean[k] = static_cast<std::uint16_t>((sum + 2) / 4);
        }
        texels_.push_back(mean);
      }
    }
    levels_.push_back(half);
    return;
  }
  std::vector<Overlap> columns;
  for (int x = 0; x < half.width; ++x) columns.push_back(overlap(x, level.width, half.width));
  for (int y = 0; y < half.height; ++y) {
    const Overlap rows = overlap(y, level.height, half.height);
    for (const Overlap& column : columns) {
      std::array<float, 4> sum{0.5f, 0.5f, 0.5f, 0.5f};  // rounds
      for (int j = 0; j < rows.count; ++j) {
        for (int i = 0; i < column.count; ++i) {
          const Texel& texel = texels_[level.at(column.first + i, rows.first + j)];
          const float weight =
              column.weights[static_cast<std::size_t>(i)] * rows.weights[static_cast<std::size_t>(j)];
          for (std::size_t k = 0; k < 4; ++k) sum[k] += weight * texel[k];
        }
      }
      Texel mean;
      for (std::size_t k = 0; k < 4; ++k) mean[k] = static_cast<std::uint16_t>(std::min(sum[k], kUnit));
      texels_.push_back(mean);
    }
  }
  levels_.push_back(half);
}

Rgba MipMap::texel(std::size_t level, int x, int y) const {
  const Texel& t = texels_[levels_[level].at(x, y)];
  constexpr float kScale = 1 / kUnit;
  return {t[0] * kScale, t[1] * kScale, t[2] * kScale, t[3] * kScale};
}

void MipMap::add_nearest(Footprint& footprint, const Level& level, Vec2f uv, const Sampler& sampler,
                         float weight) {
  const int x = nearest_texel(uv.x, level.width, sampler.wrap_u);
  const int y = nearest_texel(uv.y, level.height, sampler.wrap_v);
  footprint.taps[footprint.count++] = {level.at(x, y), weight};
}

void MipMap::add_bilinear(Footprint& footprint, const Level& level, Vec2f uv, const Sampler& sampler,
                          float weight) {
  const float x = wrapped_coordinate(uv.x, sampler.wrap_u) * static_cast<float>(level.width) - 0.5f;
  const float y = wrapped_coordinate(uv.y, sampler.wrap_v) * static_cast<float>(level.height) - 0.5f;
  // Both are at least −0.5.
  const int ix = static_cast<int>(x + 1) - 1, iy = static_cast<int>(y + 1) - 1;
  const int x0 = wrapped(ix, level.width, sampler.wrap_u), x1 = wrapped(ix + 1, level.width, sampler.wrap_u);
  const int y0 = wrapped(iy, level.height, sampler.wrap_v),
            y1 = wrapped(iy + 1, level.height, sampler.wrap_v);
  const float fx = x - static_cast<float>(ix), fy = y - static_cast<float>(iy);
  const float above = weight * (1 - fy), below = weight * fy;
  Footprint::Tap* const taps = footprint.taps.data() + footprint.count;
  taps[0] = {level.at(x0, y0), above * (1 - fx)};
  taps[1] = {level.at(x1, y0), above * fx};
  taps[2] = {level.at(x0, y1), below * (1 - fx)};
  taps[3] = {level.at(x1, y1), below * fx};
  footprint.count += 4;
}

void MipMap::add_look(Footprint& footprint, float lod, Vec2f uv, const Sampler& sampler, float weight) const {
  const int filter = sampler.min_filter.value_or(0);
  const auto add = [&](bool smooth, std::size_t level, float share) {
    (smooth ? add_bilinear : add_nearest)(footprint, levels_[level], uv, sampler, weight * share);
  };
  if (lod <= 0 || filter == kLinear || filter == kNearest) {
    add(lod <= 0 ? sampler.mag_filter != kNearest : filter == kLinear, 0, 1);
    return;
  }
  lod = std::min(lod, static_cast<float>(levels_.size() - 1));
  if (filter == kNearestMipNearest || filter == kLinearMipNearest) {
    add(filter == kLinearMipNearest, static_cast<std::size_t>(lod + 0.5f), 1);
    return;
  }
  const auto below = static_cast<std::size_t>(lod);
  const float between = lod - static_cast<float>(below);
  add(filter != kNearestMipLinear, below, 1 - between);
  if (between > 0) add(filter != kNearestMipLinear, below + 1, between);
}

Footprint MipMap::footprint(Vec2f uv, const UvSlopes& slopes, const Sampler& sampler, int anisotropy) const {
  Footprint footprint;
  uv = {usable_coordinate(uv.x), usable_coordinate(uv.y)};
  const auto w = static_cast<float>(width()), h = static_cast<float>(height());
  const auto texels2 = [&](Vec2f d) { return d.x * d.x * w * w + d.y * d.y * h * h; };
  const float dx2 = texels2(slopes.dx), dy2 = texels2(slopes.dy);
  const float long2 = std::max(dx2, dy2), short2 = std::max(std::min(dx2, dy2), 1.0f);
  if (!(long2 > 1)) {
    add_look(footprint, 0, uv, sampler, 1);
    return footprint;
  }
  if (!(long2 < kSteepest)) {
    add_nearest(footprint, levels_.back(), {0, 0}, sampler, 1);
    return footprint;
  }
  int looks = 1;
  if (anisotropy > 1) {
    const int most = std::min(anisotropy, Footprint::kMostLooks);
    looks = std::clamp(static_cast<int>(std::ceil(std::sqrt(long2 / short2) - 1e-3f)), 1, most);
  }
  const float lod = 0.5f * fast_log2(long2) - (looks > 1 ? fast_log2(static_cast<float>(looks)) : 0.0f);
  const Vec2f along = dx2 >= dy2 ? slopes.dx : slopes.dy;
  const float share = 1.0f / static_cast<float>(looks);
  for (int i = 0; i < looks; ++i) {
    const float t = (static_cast<float>(i) + 0.5f) * share - 0.5f;
    add_look(footprint, lod, looks == 1 ? uv : uv + along * t, sampler, share);
  }
  return footprint;
}

Rgba MipMap::sample(const Footprint& footprint) const {
  Float4 sum = {};
  for (std::size_t i = 0; i < footprint.count; ++i)
    sum += footprint.taps[i].weight * load_floats(texels_[footprint.taps[i].texel].data());
  constexpr float kScale = 1 / kUnit;
  return {sum[0] * kScale, sum[1] * kScale, sum[2] * kScale, sum[3] * kScale};
}

}  // namespace fovea
