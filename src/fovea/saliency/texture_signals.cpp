#include "fovea/saliency/texture_signals.h"

#include <cmath>
#include <cstring>
#include <span>
#include <vector>

#include "fovea/base/error.h"
#include "fovea/base/parallel.h"
#include "fovea/base/srgb.h"
#include "fovea/base/wide.h"
#include "fovea/model/image_fit.h"
#include "fovea/texture/texel_scan.h"

namespace fovea {

namespace {

/// Rows that a thread takes at once.
constexpr std::size_t kRowGrain = 32;

/// Three rows of colours, one after the other, with a texel before and one after each.
class ColorRow {
 public:
  explicit ColorRow(int width) : stride_(static_cast<std::size_t>(width) + 2), values_(3 * stride_) {}

  void load(const Image8& image, int y, Wrap wrap) {
    const std::uint8_t* const texels = image.at(0, y);
    const auto step = static_cast<std::size_t>(image.channels);
    const std::size_t width = stride_ - 2;
    for (std::size_t k = 0; k < 3; ++k) {
      std::uint16_t* const row = values_.data() + k * stride_;
      const std::uint8_t* const from = texels + (step < 3 ? 0 : k);
      for (std::size_t x = 0; x < width; ++x) row[x + 1] = from[x * step];
      row[0] = from[static_cast<std::size_t>(wrapped_texel(-1, image.width, wrap)) * step];
      row[width + 1] = from[static_cast<std::size_t>(wrapped_texel(image.width, image.width, wrap)) * step];
    }
  }
  std::span<const std::uint16_t> values() const { return values_; }

 private:
  std::size_t stride_;
  std::vector<std::uint16_t> values_;
};

/// Sums of three rows by 1 2 1, and of their columns: out[i] is around i + 1.
FOVEA_WIDE void smooth(const std::uint16_t* above, const std::uint16_t* row, const std::uint16_t* below,
                       std::uint16_t* columns, std::uint16_t* out, std::size_t count) {
  for (std::size_t i = 0; i < count; ++i)
    columns[i] = static_cast<std::uint16_t>(above[i] + 2 * row[i] + below[i]);
  for (std::size_t i = 0; i + 2 < count; ++i)
    out[i] = static_cast<std::uint16_t>(columns[i] + 2 * columns[i + 1] + columns[i + 2]);
}

/// One row of a smoothed image.
struct SmoothRow {
  const std::uint16_t *r, *g, *b;
};

/// Calls f(y, SmoothRow) for all rows, in parallel.
template <class F>
void for_smooth_rows(const Image8& image, const Sampler& sampler, const Context& context, F&& f) {
  parallel_for(
      context, static_cast<std::size_t>(image.height), kRowGrain, [&](std::size_t from, std::size_t to) {
        std::array<ColorRow, 3> rows{ColorRow(image.width), ColorRow(image.width), ColorRow(image.width)};
        const std::size_t count = rows[0].values().size(), stride = count / 3;
        std::vector<std::uint16_t> columns(count), out(count);
        const int begin = static_cast<int>(from), end = static_cast<int>(to);
        const auto row = [&](int y) -> ColorRow& { return rows[static_cast<std::size_t>(y + 3) % 3]; };
        const auto load = [&](int y) {
          row(y).load(image, wrapped_texel(y, image.height, sampler.wrap_v), sampler.wrap_u);
        };
        load(begin - 1);
        load(begin);
        for (int y = begin; y < end; ++y) {
          load(y + 1);
          smooth(row(y - 1).values().data(), row(y).values().data(), row(y + 1).values().data(),
                 columns.data(), out.data(), count);
          f(y, SmoothRow{out.data(), out.data() + stride, out.data() + 2 * stride});
        }
      });
}

FOVEA_WIDE void judge_colors(const SmoothRow& row, std::size_t width, float* intensity, float* opponency) {
  constexpr float kScale = 1.0f / kSmoothUnit;
  const std::uint16_t *const r = row.r, *const g = row.g, *const b = row.b;
  for (std::size_t x = 0; x < width; ++x) {
    const ColorSignals signals =
        color_signals(static_cast<float>(r[x]) * kScale, static_cast<float>(g[x]) * kScale,
                      static_cast<float>(b[x]) * kScale);
    intensity[x] = signals.intensity;
    opponency[x] = signals.opponency;
  }
}

/// Which of `bins` greys the texels of a row have.
FOVEA_WIDE void sort_greys(const SmoothRow& row, std::size_t width, std::uint32_t bins, std::uint8_t* out) {
  const std::uint16_t *const r = row.r, *const g = row.g, *const b = row.b;
  for (std::size_t x = 0; x < width; ++x) {
    const std::uint32_t grey_100 = 30u * r[x] + 59u * g[x] + 11u * b[x];
    out[x] = static_cast<std::uint8_t>(std::min(grey_100 * bins / (100u * kSmoothUnit), bins - 1));
  }
}

/// The bins of an image's greys, with half a window beyond its borders.
class GreyBins {
 public:
  GreyBins(int width, int height, int half)
      : width_(width),
        height_(height),
        half_(half),
        stride_(static_cast<std::size_t>(width + 2 * half)),
        bins_(stride_ * static_cast<std::size_t>(height + 2 * half)) {}

  std::size_t stride() const { return stride_; }
  /// Texel (0, y) of the image.
  std::uint8_t* row(int y) { return bins_.data() + offset(y); }
  const std::uint8_t* row(int y) const { return bins_.data() + offset(y); }

  /// Fills what is beyond the borders.
  void wrap(const Sampler& sampler) {
    for (int y = 0; y < height_; ++y) {
      std::uint8_t* const texels = row(y);
      for (int x = -half_; x < 0; ++x) texels[x] = texels[wrapped_texel(x, width_, sampler.wrap_u)];
      for (int x = width_; x < width_ + half_; ++x)
        texels[x] = texels[wrapped_texel(x, width_, sampler.wrap_u)];
    }
    const auto copy = [&](int y) {
      std::memcpy(row(y) - half_, row(wrapped_texel(y, height_, sampler.wrap_v)) - half_, stride_);
    };
    for (int y = -half_; y < 0; ++y) copy(y);
    for (int y = height_; y < height_ + half_; ++y) copy(y);
  }

 private:
  std::size_t offset(int y) const {
    return static_cast<std::size_t>(y + half_) * stride_ + static_cast<std::size_t>(half_);
  }
  int width_, height_, half_;
  std::size_t stride_;
  std::vector<std::uint8_t> bins_;
};

/// Entropy of windows that slide along a row. Of N texels with counts c it is log₂ N − Σ c log₂ c / N; the
/// sum is kept as a whole number of 2⁻³² so that nothing is lost on the way.
class SlidingEntropy {
 public:
  explicit SlidingEntropy(int window) : window_(static_cast<std::size_t>(window)) {
    const std::size_t count = window_ * window_;
    const auto term = [](std::size_t c) {
      const auto x = static_cast<double>(c);
      return c < 2 ? std::int64_t{0} : static_cast<std::int64_t>(std::llround(x * std::log2(x) * kOne));
    };
    for (std::size_t c = 0; c < count; ++c) growth_.push_back(term(c + 1) - term(c));
    most_ = term(count);
    scale_ = 1 / (kOne * static_cast<double>(count));
  }

  /// `first` is the bin at the top left of the first window.
  void run(const std::uint8_t* first, std::size_t stride, std::size_t width, float* entropy) const {
    std::array<std::uint16_t, 256> counts{};
    std::int64_t sum = 0;
    const auto add = [&](std::uint8_t bin) { sum += growth_[counts[bin]++]; };
    const auto remove = [&](std::uint8_t bin) { sum -= growth_[--counts[bin]]; };
    for (std::size_t x = 0; x < window_; ++x) {
      for (std::size_t y = 0; y < window_; ++y) add(first[y * stride + x]);
    }
    entropy[0] = of(sum);
    for (std::size_t x = 1; x < width; ++x) {
      const std::uint8_t *out = first + x - 1, *in = out + window_;
      for (std::size_t y = 0; y < window_; ++y, out += stride, in += stride) {
        if (*out == *in) continue;
        remove(*out);
        add(*in);
      }
      entropy[x] = of(sum);
    }
  }

 private:
  static constexpr double kOne = 4294967296.0;
  float of(std::int64_t sum) const { return static_cast<float>(static_cast<double>(most_ - sum) * scale_); }

  std::size_t window_;
  std::vector<std::int64_t> growth_;  // of c log₂ c, from c to c + 1
  std::int64_t most_ = 0;
  double scale_ = 0;
};

void check(const TextureSignalOptions& options) {
  if (options.entropy_window < 3 || options.entropy_window > 63 || options.entropy_window % 2 == 0)
    throw Error(ErrorKind::usage, "the window of entropy must be odd, from 3 to 63");
  if (options.entropy_bins < 2 || options.entropy_bins > 256)
    throw Error(ErrorKind::usage, "entropy needs 2 to 256 bins");
}

}  // namespace

Image8 with_factor(const Image8& image, const std::array<double, 3>& light, const Context& context) {
  std::array<std::array<std::uint8_t, 256>, 3> display;
  for (std::size_t k = 0; k < 3; ++k) {
    for (std::size_t i = 0; i < 256; ++i)
      display[k][i] = to_display(to_light(static_cast<std::uint8_t>(i)) * static_cast<float>(light[k]));
  }
  Image8 result(image.width, image.height, 3, image.encoding);
  parallel_for(context, static_cast<std::size_t>(image.height), kRowGrain,
               [&](std::size_t begin, std::size_t end) {
                 for (std::size_t y = begin; y < end; ++y) {
                   const std::uint8_t* from = image.at(0, static_cast<int>(y));
                   std::uint8_t* to = result.at(0, static_cast<int>(y));
                   for (int x = 0; x < image.width; ++x, from += image.channels, to += 3) {
                     for (std::size_t k = 0; k < 3; ++k) to[k] = display[k][from[image.channels < 3 ? 0 : k]];
                   }
                 }
               });
  return result;
}

Image<std::uint16_t> smoothed(const Image8& image, const Sampler& sampler, const Context& context) {
  Image<std::uint16_t> result(image.width, image.height, 3, image.encoding);
  for_smooth_rows(image, sampler, context, [&](int y, const SmoothRow& row) {
    std::uint16_t* texel = result.at(0, y);
    for (int x = 0; x < image.width; ++x, texel += 3) {
      texel[0] = row.r[x];
      texel[1] = row.g[x];
      texel[2] = row.b[x];
    }
  });
  return result;
}

TextureSignals texture_signals(const Image8& image, const Sampler& sampler,
                               const TextureSignalOptions& options, const Context& context) {
  check(options);
  const int width = image.width, height = image.height;
  if (static_cast<std::int64_t>(width) * height > kMostTexels)
    return texture_signals(fitted(image, kMostTexels, context), sampler, options, context);
  const ImageF plane(width, height, 1, ColorEncoding::linear);
  TextureSignals signals{plane, plane, plane};
  if (plane.pixels.empty()) return signals;
  const auto columns = static_cast<std::size_t>(width);
  const int half = options.entropy_window / 2;
  GreyBins bins(width, height, half);
  for_smooth_rows(image, sampler, context, [&](int y, const SmoothRow& row) {
    judge_colors(row, columns, signals.intensity.at(0, y), signals.opponency.at(0, y));
    sort_greys(row, columns, static_cast<std::uint32_t>(options.entropy_bins), bins.row(y));
  });
  bins.wrap(sampler);
  const SlidingEntropy entropy(options.entropy_window);
  parallel_for(context, static_cast<std::size_t>(height), kRowGrain, [&](std::size_t begin, std::size_t end) {
    for (int y = static_cast<int>(begin); y < static_cast<int>(end); ++y)
      entropy.run(bins.row(y - half) - half, bins.stride(), columns, signals.entropy.at(0, y));
  });
  return signals;
}

}  // namespace fovea
