#include "fovea/render/mip_map.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace fovea {

namespace {

// --- The sRGB curve, with nothing from the C library that differs between machines ----------------------

double fifth_root(double x) {
  double y = 1;  // x is in (0, 1]: Newton's steps come down to the root
  for (int i = 0; i < 64; ++i) y -= (y - x / (y * y * y * y)) / 5;
  return y;
}

/// IEC 61966-2-1, display value to light.
double light_of(double display) {
  if (display <= 0.04045) return display / 12.92;
  const double x = (display + 0.055) / 1.055, root = fifth_root(x);
  return x * x * root * root;  // x^2.4
}

struct DisplayCurve {
  static constexpr int kSteps = 1024;
  std::array<float, 256> light;                // of each display value
  std::array<float, 256> ends;                 // light above which the next display value is nearer
  std::array<std::uint8_t, kSteps + 1> first;  // display value at light i / kSteps

  DisplayCurve() {
    for (int i = 0; i < 256; ++i) {
      light[static_cast<std::size_t>(i)] = static_cast<float>(light_of(i / 255.0));
      ends[static_cast<std::size_t>(i)] = i < 255 ? static_cast<float>(light_of((i + 0.5) / 255)) : 2.0f;
    }
    std::size_t value = 0;
    for (int i = 0; i <= kSteps; ++i) {
      while (static_cast<float>(i) / kSteps > ends[value]) ++value;
      first[static_cast<std::size_t>(i)] = static_cast<std::uint8_t>(value);
    }
  }
};

const DisplayCurve& display_curve() {
  static const DisplayCurve curve;
  return curve;
}

const std::array<float, 256>& fractions() {
  static const std::array<float, 256> table = [] {
    std::array<float, 256> t{};
    for (std::size_t i = 0; i < 256; ++i) t[i] = static_cast<float>(i) / 255.0f;
    return t;
  }();
  return table;
}

std::uint8_t to_byte(float x) { return static_cast<std::uint8_t>(std::clamp(x, 0.0f, 1.0f) * 255.0f + 0.5f); }

std::uint32_t pack(std::uint8_t r, std::uint8_t g, std::uint8_t b, std::uint8_t a) {
  return static_cast<std::uint32_t>(r) | static_cast<std::uint32_t>(g) << 8 |
         static_cast<std::uint32_t>(b) << 16 | static_cast<std::uint32_t>(a) << 24;
}

std::uint32_t to_texel(const std::uint8_t* pixel, int channels) {
  switch (channels) {
    case 1: return pack(pixel[0], pixel[0], pixel[0], 255);
    case 2: return pack(pixel[0], pixel[0], pixel[0], pixel[1]);
    case 3: return pack(pixel[0], pixel[1], pixel[2], 255);
    default: return pack(pixel[0], pixel[1], pixel[2], pixel[3]);
  }
}

// --- Looking up -----------------------------------------------------------------------------------------

/// log2 of a positive number, to 0.0002: the exponent and a quartic over the mantissa.
float fast_log2(float x) {
  const auto bits = std::bit_cast<std::uint32_t>(x);
  const auto exponent = static_cast<float>(static_cast<int>(bits >> 23) - 127);
  const float m = std::bit_cast<float>((bits & 0x007FFFFFu) | 0x3F800000u) - 1;
  return exponent + m * (1.4387257f + m * (-0.6777838f + m * (0.3211887f - m * 0.0821306f)));
}

/// A coordinate in texels, wrapped so that it lies in [0, size] (repeat: [0, size)).
float wrapped(float u, int size, Wrap wrap) {
  if (wrap == Wrap::repeat) {
    u -= std::floor(u);
  } else if (wrap == Wrap::mirror) {
    u -= 2 * std::floor(0.5f * u);
    if (u > 1) u = 2 - u;
  } else {
    u = std::clamp(u, 0.0f, 1.0f);
  }
  return u * static_cast<float>(size);
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

constexpr float kMostTurns = 1e6f;
constexpr int kNearest = 9728, kLinear = 9729, kNearestMipNearest = 9984, kLinearMipNearest = 9985,
              kNearestMipLinear = 9986;

}  // namespace

std::uint8_t to_display(float light) {
  const DisplayCurve& curve = display_curve();
  if (!(light > 0)) return 0;
  if (light >= 1) return 255;
  std::uint8_t value = curve.first[static_cast<std::size_t>(light * DisplayCurve::kSteps)];
  while (light > curve.ends[value]) ++value;
  return value;
}

float to_light(std::uint8_t display) { return display_curve().light[display]; }

MipMap::MipMap(const Image8& image, ColorEncoding encoding)
    : to_light_(encoding == ColorEncoding::srgb ? &display_curve().light : &fractions()) {
  Level level{image.width, image.height, {}};
  level.texels.reserve(static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height));
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) level.texels.push_back(to_texel(image.at(x, y), image.channels));
  }
  levels_.push_back(std::move(level));
  while (levels_.back().width > 1 || levels_.back().height > 1)
    levels_.push_back(halved(levels_.back(), encoding == ColorEncoding::srgb));
}

MipMap::Level MipMap::halved(const Level& level, bool srgb) const {
  Level half{std::max(level.width / 2, 1), std::max(level.height / 2, 1), {}};
  half.texels.reserve(static_cast<std::size_t>(half.width) * static_cast<std::size_t>(half.height));
  for (int y = 0; y < half.height; ++y) {
    const Overlap rows = overlap(y, level.height, half.height);
    for (int x = 0; x < half.width; ++x) {
      const Overlap columns = overlap(x, level.width, half.width);
      Rgba sum{0, 0, 0, 0};
      for (int j = 0; j < rows.count; ++j) {
        for (int i = 0; i < columns.count; ++i) {
          sum = sum + decode(level.at(columns.first + i, rows.first + j)) *
                          (columns.weights[static_cast<std::size_t>(i)] *
                           rows.weights[static_cast<std::size_t>(j)]);
        }
      }
      const auto code = [&](float light) { return srgb ? to_display(light) : to_byte(light); };
      half.texels.push_back(pack(code(sum.r), code(sum.g), code(sum.b), to_byte(sum.a)));
    }
  }
  return half;
}

Rgba MipMap::nearest(const Level& level, Vec2f uv, const Sampler& sampler) const {
  const auto x = static_cast<int>(wrapped(uv.x, level.width, sampler.wrap_u));
  const auto y = static_cast<int>(wrapped(uv.y, level.height, sampler.wrap_v));
  return decode(level.at(std::min(x, level.width - 1), std::min(y, level.height - 1)));
}

Rgba MipMap::bilinear(const Level& level, Vec2f uv, const Sampler& sampler) const {
  const float x = wrapped(uv.x, level.width, sampler.wrap_u) - 0.5f;
  const float y = wrapped(uv.y, level.height, sampler.wrap_v) - 0.5f;
  const float floor_x = std::floor(x), floor_y = std::floor(y);
  const auto ix = static_cast<int>(floor_x), iy = static_cast<int>(floor_y);
  const int x0 = wrapped(ix, level.width, sampler.wrap_u), x1 = wrapped(ix + 1, level.width, sampler.wrap_u);
  const int y0 = wrapped(iy, level.height, sampler.wrap_v),
            y1 = wrapped(iy + 1, level.height, sampler.wrap_v);
  const float fx = x - floor_x, fy = y - floor_y;
  return (decode(level.at(x0, y0)) * (1 - fx) + decode(level.at(x1, y0)) * fx) * (1 - fy) +
         (decode(level.at(x0, y1)) * (1 - fx) + decode(level.at(x1, y1)) * fx) * fy;
}

Rgba MipMap::trilinear(float lod, Vec2f uv, const Sampler& sampler) const {
  const auto last = static_cast<float>(levels_.size() - 1);
  const int filter = sampler.min_filter.value_or(0);
  if (lod <= 0 || filter == kLinear || filter == kNearest) {
    const bool smooth = lod <= 0 ? sampler.mag_filter != kNearest : filter == kLinear;
    return smooth ? bilinear(levels_[0], uv, sampler) : nearest(levels_[0], uv, sampler);
  }
  lod = std::min(lod, last);
  if (filter == kNearestMipNearest || filter == kLinearMipNearest) {
    const Level& level = levels_[static_cast<std::size_t>(lod + 0.5f)];
    return filter == kLinearMipNearest ? bilinear(level, uv, sampler) : nearest(level, uv, sampler);
  }
  const auto below = static_cast<std::size_t>(lod);
  const float between = lod - static_cast<float>(below);
  const auto look = [&](std::size_t level) {
    return filter == kNearestMipLinear ? nearest(levels_[level], uv, sampler)
                                       : bilinear(levels_[level], uv, sampler);
  };
  if (between == 0) return look(below);
  return look(below) * (1 - between) + look(below + 1) * between;
}

Rgba MipMap::sample(Vec2f uv, const UvSlopes& slopes, const Sampler& sampler, int anisotropy) const {
  // Beyond that floats know no fractions of a texel; and what is not finite is nowhere.
  if (!(std::abs(uv.x) < kMostTurns)) uv.x = 0;
  if (!(std::abs(uv.y) < kMostTurns)) uv.y = 0;
  const auto w = static_cast<float>(width()), h = static_cast<float>(height());
  const auto texels2 = [&](Vec2f d) { return d.x * d.x * w * w + d.y * d.y * h * h; };
  const float dx2 = texels2(slopes.dx), dy2 = texels2(slopes.dy);
  const float long2 = std::max(dx2, dy2), short2 = std::min(dx2, dy2);
  if (!(long2 > 1)) return trilinear(0, uv, sampler);
  if (!(long2 < 1e30f)) return texel(levels_.size() - 1, 0, 0);
  int looks = 1;
  if (anisotropy > 1) {
    const float most = static_cast<float>(anisotropy) * static_cast<float>(anisotropy);
    const float ratio2 = std::min(long2, most * std::max(short2, 1.0f)) / std::max(short2, 1.0f);
    looks = std::clamp(static_cast<int>(std::ceil(std::sqrt(ratio2) - 1e-3f)), 1, anisotropy);
  }
  const float lod = 0.5f * fast_log2(long2) - (looks > 1 ? fast_log2(static_cast<float>(looks)) : 0.0f);
  if (looks == 1) return trilinear(lod, uv, sampler);
  const Vec2f along = dx2 >= dy2 ? slopes.dx : slopes.dy;
  Rgba sum{0, 0, 0, 0};
  for (int i = 0; i < looks; ++i) {
    const float t = (static_cast<float>(i) + 0.5f) / static_cast<float>(looks) - 0.5f;
    sum = sum + trilinear(lod, uv + along * t, sampler);
  }
  return sum * (1.0f / static_cast<float>(looks));
}

}  // namespace fovea
