#include "fovea/texture/resize.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <span>
#include <vector>

#include "fovea/base/error.h"
#include "fovea/base/float4.h"
#include "fovea/base/parallel.h"
#include "fovea/base/srgb.h"
#include "fovea/model/wrap.h"

namespace fovea {

namespace {

/// Rows that a thread takes at once.
constexpr std::size_t kResizedRowGrain = 16;
constexpr double kLobes = 3;

double lanczos(double x) {
  if (x == 0) return 1;
  if (std::abs(x) >= kLobes) return 0;
  const double t = std::numbers::pi * x;
  return kLobes * std::sin(t) * std::sin(t / kLobes) / (t * t);
}

/// Which texels of a row (or column) make up each of the new one.
class Filter {
 public:
  struct Tap {
    int texel;
    float weight;
  };

  Filter(int from, int to, Wrap wrap) {
    const double step = static_cast<double>(from) / to, width = std::max(step, 1.0);
    for (int i = 0; i < to; ++i) {
      begins_.push_back(taps_.size());
      const double center = (i + 0.5) * step - 0.5;
      const auto first = static_cast<int>(std::ceil(center - kLobes * width)),
                 last = static_cast<int>(std::floor(center + kLobes * width));
      double sum = 0;
      for (int j = first; j <= last; ++j) sum += lanczos((j - center) / width);
      for (int j = first; j <= last; ++j) {
        if (const double w = lanczos((j - center) / width); w != 0)
          taps_.push_back({wrapped_texel(j, from, wrap), static_cast<float>(w / sum)});
      }
    }
    begins_.push_back(taps_.size());
  }

  std::span<const Tap> taps(int i) const {
    const auto at = static_cast<std::size_t>(i);
    return std::span(taps_).subspan(begins_[at], begins_[at + 1] - begins_[at]);
  }

 private:
  std::vector<std::size_t> begins_;
  std::vector<Tap> taps_;
};

/// Between stored bytes and numbers that can be mixed.
class Mixing {
 public:
  Mixing(const TexelMeaning& meaning, const Image8& image)
      : colors_(image.color_channels()),
        channels_(image.channels),
        weighted_(meaning.transparent && image.has_alpha()),
        normal_(meaning.kind == TexelMeaning::Kind::normal && image.channels >= 3),
        color_(meaning.kind == TexelMeaning::Kind::color) {
    for (std::size_t i = 0; i < 256; ++i) {
      const auto byte = static_cast<std::uint8_t>(i);
      plain_[i] = static_cast<float>(byte) / 255;
      stored_[i] = color_ ? to_light(byte) : normal_ ? 2 * plain_[i] - 1 : plain_[i];
    }
  }

  void decode(const std::uint8_t* in, float* out) const {
    for (int k = 0; k < colors_; ++k) out[k] = stored_[in[k]];
    if (colors_ == channels_) return;
    out[colors_] = plain_[in[colors_]];
    // What does not show at all still counts a little: else it would be black where nothing else is near.
    if (weighted_)
      for (int k = 0; k < colors_; ++k) out[k] *= weight(out[colors_]);
  }

  void encode(const float* in, std::uint8_t* out) const {
    const float scale = weighted_ ? 1 / weight(std::clamp(in[colors_], 0.0f, 1.0f)) : 1;
    if (normal_) {
      const float length = std::sqrt(in[0] * in[0] + in[1] * in[1] + in[2] * in[2]);
      for (int k = 0; k < 3; ++k) out[k] = byte(length > 0 ? 0.5f + 0.5f * in[k] / length : k < 2 ? 0.5f : 1);
    } else {
      for (int k = 0; k < colors_; ++k) out[k] = color_ ? to_display(in[k] * scale) : byte(in[k] * scale);
    }
    if (colors_ < channels_) out[colors_] = byte(in[colors_]);
  }

 private:
  static std::uint8_t byte(float x) {
    return static_cast<std::uint8_t>(std::clamp(x, 0.0f, 1.0f) * 255 + 0.5f);
  }
  static float weight(float alpha) { return std::max(alpha, 1.0f / 1024); }

  int colors_, channels_;
  bool weighted_, normal_, color_;
  std::array<float, 256> stored_{}, plain_{};
};

/// Of decoded texels; channels that an image does not have are 0.
Float4 added_up(std::span<const Filter::Tap> taps, const Float4* row) {
  Float4 sum{};
  for (const Filter::Tap& tap : taps) sum += tap.weight * row[tap.texel];
  return sum;
}

double coverage(const Image8& image, int limit) {
  std::size_t count = 0, passed = 0;
  for (std::size_t i = static_cast<std::size_t>(image.channels) - 1; i < image.pixels.size();
       i += static_cast<std::size_t>(image.channels), ++count)
    passed += image.pixels[i] >= limit;
  return count > 0 ? static_cast<double>(passed) / static_cast<double>(count) : 0;
}

/// Scales alpha so that as many texels pass the cutoff as before, as nearly as bytes allow.
void keep_coverage(Image8& image, double wanted, double cutoff) {
  const int limit = std::clamp(static_cast<int>(std::ceil(cutoff * 255)), 1, 255);
  std::array<std::size_t, 256> histogram{};
  std::size_t count = 0;
  const auto step = static_cast<std::size_t>(image.channels);
  for (std::size_t i = step - 1; i < image.pixels.size(); i += step, ++count) ++histogram[image.pixels[i]];
  // The value that should be the first to pass.
  int best = limit;
  double nearest = 2;
  std::size_t passed = 0;
  for (int value = 255; value >= 1; --value) {
    passed += histogram[static_cast<std::size_t>(value)];
    const double off = std::abs(static_cast<double>(passed) / static_cast<double>(count) - wanted);
    const bool is_nearer =
        off < nearest || (off == nearest && std::abs(value - limit) < std::abs(best - limit));
    if (is_nearer) nearest = off, best = value;
  }
  if (best == limit) return;
  std::array<std::uint8_t, 256> scaled{};
  for (int value = 0; value < 256; ++value) {
    // In two pieces, so that 0 and 255 stay and `best` becomes `limit`.
    const double to = value <= best ? static_cast<double>(value) * limit / best
                                    : 255 - static_cast<double>(255 - value) * (255 - limit) / (255 - best);
    scaled[static_cast<std::size_t>(value)] = static_cast<std::uint8_t>(
        value < best ? std::min<double>(to, limit - 1) : std::max<double>(to, limit));
  }
  for (std::size_t i = step - 1; i < image.pixels.size(); i += step)
    image.pixels[i] = scaled[image.pixels[i]];
}

}  // namespace

Image8 resized(const Image8& image, int width, int height, const TexelMeaning& meaning, Wrap wrap_u,
               Wrap wrap_v, const Context& context) {
  if (width < 1 || height < 1) throw Error(ErrorKind::usage, "an image has at least one texel");
  if (width == image.width && height == image.height) return image;
  const Mixing mixing(meaning, image);
  const int channels = image.channels;
  const std::size_t narrow = static_cast<std::size_t>(width) * static_cast<std::size_t>(channels);

  std::vector<float> rows(narrow * static_cast<std::size_t>(image.height));  // [old height × new width]
  const Filter across(image.width, width, wrap_u);
  parallel_for(context, static_cast<std::size_t>(image.height), kResizedRowGrain,
               [&](std::size_t begin, std::size_t end) {
                 std::vector<Float4> decoded(static_cast<std::size_t>(image.width));
                 for (std::size_t y = begin; y < end; ++y) {
                   const std::uint8_t* texel = image.at(0, static_cast<int>(y));
                   for (Float4& to : decoded) {
                     std::array<float, 4> values{};
                     mixing.decode(texel, values.data());
                     to = Float4{values[0], values[1], values[2], values[3]};
                     texel += channels;
                   }
                   float* out = rows.data() + y * narrow;
                   for (int x = 0; x < width; ++x) {
                     const Float4 sum = added_up(across.taps(x), decoded.data());
                     for (int k = 0; k < channels; ++k) *out++ = sum[k];
                   }
                 }
               });

  Image8 result(width, height, channels, image.encoding);
  const Filter down(image.height, height, wrap_v);
  parallel_for(context, static_cast<std::size_t>(height), kResizedRowGrain,
               [&](std::size_t begin, std::size_t end) {
                 std::vector<float> sum(narrow);
                 for (std::size_t y = begin; y < end; ++y) {
                   std::fill(sum.begin(), sum.end(), 0.0f);
                   for (const Filter::Tap& tap : down.taps(static_cast<int>(y))) {
                     const float* row = rows.data() + static_cast<std::size_t>(tap.texel) * narrow;
                     for (std::size_t i = 0; i < narrow; ++i) sum[i] += tap.weight * row[i];
                   }
                   std::uint8_t* out = result.at(0, static_cast<int>(y));
                   for (std::size_t i = 0; i < narrow; i += static_cast<std::size_t>(channels))
                     mixing.encode(sum.data() + i, out + i);
                 }
               });
  if (meaning.alpha_cutoff && image.has_alpha()) {
    const int limit = std::clamp(static_cast<int>(std::ceil(*meaning.alpha_cutoff * 255)), 1, 255);
    keep_coverage(result, coverage(image, limit), *meaning.alpha_cutoff);
  }
  return result;
}

}  // namespace fovea
