#include "fovea/budget/wavelet.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <string_view>

#include "fovea/base/error.h"
#include "fovea/budget/bit_coder.h"

namespace fovea {

namespace {

// The lifting steps of the filters of 9 and 7 taps, and the scale that makes them nearly orthonormal.
constexpr std::array<float, 4> kLifts{-1.586134342f, -0.052980118f, 0.882911076f, 0.443506852f};
constexpr float kScale = 1.149604398f;
constexpr int kSmallest = 8;              // of the smooth part
constexpr float kRound = 1.0f / 3;        // magnitudes of 2/3 and more become 1
constexpr float kLeastStep = 1.0f / 256;  // Multiples stay below 2^30.
constexpr float kMiddle = 128;
/// Coefficients on either side of what is seen that stay: waves reach some four to each side, but hardly so
/// far.
constexpr std::int64_t kReach = 1;

int half(int size) { return (size + 1) / 2; }

/// Index of a line's neighbour, mirrored at its ends.
int mirrored(int i, int size) { return i < 0 ? -i : i >= size ? 2 * (size - 1) - i : i; }

std::size_t at(int x, int y, int stride) {
  return static_cast<std::size_t>(y) * static_cast<std::size_t>(stride) + static_cast<std::size_t>(x);
}

/// Elements that are single values or whole rows: `add(i, j, k, c)` adds c times the sum of j and k to i.
template <class Add>
void lift(int size, bool back, Add&& add) {
  for (std::size_t n = 0; n < kLifts.size(); ++n) {
    const std::size_t step = back ? kLifts.size() - 1 - n : n;
    for (int i = step % 2 == 0 ? 1 : 0; i < size; i += 2)
      add(i, mirrored(i - 1, size), mirrored(i + 1, size), back ? -kLifts[step] : kLifts[step]);
  }
}

float scale_of(int i, bool back) { return (i % 2 == 0) != back ? kScale : 1 / kScale; }

/// Where element i of a line goes: even ones in front.
int sorted(int i, int size) { return i % 2 == 0 ? i / 2 : half(size) + i / 2; }

void transform_row(float* row, int width, bool back, std::vector<float>& line) {
  if (width < 2) return;
  for (int i = 0; i < width; ++i) {
    const auto from = static_cast<std::size_t>(back ? sorted(i, width) : i);
    line[static_cast<std::size_t>(i)] = back ? row[from] * scale_of(i, true) : row[from];
  }
  lift(width, back, [&](int i, int j, int k, float c) {
    line[static_cast<std::size_t>(i)] +=
        c * (line[static_cast<std::size_t>(j)] + line[static_cast<std::size_t>(k)]);
  });
  for (int i = 0; i < width; ++i) {
    const float value = line[static_cast<std::size_t>(i)];
    row[back ? i : sorted(i, width)] = back ? value : value * scale_of(i, false);
  }
}

void transform_columns(std::span<float> plane, int stride, int width, int height, bool back,
                       std::vector<float>& copy) {
  if (height < 2) return;
  for (int i = 0; i < height; ++i) {
    const float* from = plane.data() + at(0, back ? sorted(i, height) : i, stride);
    const float scale = back ? scale_of(i, true) : 1;
    std::transform(from, from + width, copy.data() + at(0, i, width), [&](float x) { return x * scale; });
  }
  lift(height, back, [&](int i, int j, int k, float c) {
    float* to = copy.data() + at(0, i, width);
    const float *a = copy.data() + at(0, j, width), *b = copy.data() + at(0, k, width);
    for (int x = 0; x < width; ++x) to[x] += c * (a[x] + b[x]);
  });
  for (int i = 0; i < height; ++i) {
    const float* from = copy.data() + at(0, i, width);
    const float scale = back ? 1 : scale_of(i, false);
    std::transform(from, from + width, plane.data() + at(0, back ? i : sorted(i, height), stride),
                   [&](float x) { return x * scale; });
  }
}

/// One level of the top left `width` × `height` values.
void transform_level(std::span<float> plane, int stride, int width, int height, bool back,
                     std::vector<float>& copy) {
  if (back) transform_columns(plane, stride, width, height, back, copy);
  for (int y = 0; y < height; ++y) transform_row(plane.data() + at(0, y, stride), width, back, copy);
  if (!back) transform_columns(plane, stride, width, height, back, copy);
}

/// Sides of the smooth part after a number of levels.
int side_after(int side, int levels) {
  for (int l = 0; l < levels; ++l) side = half(side);
  return side;
}

/// A rectangle of a plane with one kind of coefficients.
struct Band {
  int x = 0, y = 0, width = 0, height = 0;
  int level = 0;                            ///< 1 is the finest; the smooth part has that of the coarsest.
  int kind = 0;                             ///< 0 smooth, 1 along one axis, 2 along both.
  int parent_x = 0, parent_y = 0;           ///< Where the same kind of the next coarser level begins, and
  int parent_width = 0, parent_height = 0;  ///< its sides, 0 if there is none.
};

/// All bands of a plane, from the coarsest.
std::vector<Band> bands_of(int width, int height, int levels) {
  const auto sides = [&](int l) { return std::array{side_after(width, l), side_after(height, l)}; };
  std::vector<Band> bands{{0, 0, sides(levels)[0], sides(levels)[1], levels, 0}};
  for (int l = levels; l > 0; --l) {
    const auto low = sides(l), whole = sides(l - 1), coarser = sides(l + 1);
    for (const auto& [right, below] : {std::array{1, 0}, {0, 1}, {1, 1}}) {
      Band band{right * low[0],
                below * low[1],
                right ? whole[0] - low[0] : low[0],
                below ? whole[1] - low[1] : low[1],
                l,
                right + below};
      if (l < levels) {
        band.parent_x = right * coarser[0];
        band.parent_y = below * coarser[1];
        band.parent_width = right ? low[0] - coarser[0] : coarser[0];
        band.parent_height = below ? low[1] - coarser[1] : coarser[1];
      }
      if (band.width > 0 && band.height > 0) bands.push_back(band);
    }
  }
  return bands;
}

/// Codes planes through BitWriter or BitReader. What contexts look at is what has been coded so far, so that
/// both see the same.
template <class Io>
class PlaneCode {
 public:
  PlaneCode(Io& io, int stride) : io_(io), stride_(stride) {}

  /// Writes `source` or reads into `target`, which is 0 at first and then the same.
  void code(const Band& band, bool is_difference, const std::int32_t* source, std::int32_t* target) {
    band_ = band;
    models_ = &models_of_[static_cast<std::size_t>(band.kind + (is_difference ? 3 : 0))];
    source_ = source;
    target_ = target;
    const auto longest = static_cast<std::uint32_t>(std::max(band.width, band.height));
    block(0, 0, std::bit_width(longest - 1), false);
  }

 private:
  static constexpr std::size_t kSizes = 32, kParents = 3, kNeighbors = 6;
  struct Models {
    BitModel block[kSizes][2];
    BitModel single[kNeighbors][kParents];
    NumberModel magnitude[kNeighbors];
  };

  /// A square of 2^k coefficients a side; returns whether any is not 0. `known`: that one is not.
  bool block(int x, int y, int k, bool known) {
    bool any = true;
    if (!known) {
      if constexpr (Io::kWrites) any = any_in(source_, band_.x + x, band_.y + y, limited(x, y, k));
      BitModel& model = k == 0 ? models_->single[neighbors(x, y)][parent(x, y)]
                               : models_->block[static_cast<std::size_t>(k)][any_parent(x, y, k) ? 1 : 0];
      io_.bit(model, any);
    }
    if (!any) return false;
    if (k == 0) {
      code_value(x, y);
      return true;
    }
    const int side = 1 << (k - 1);
    const bool right = x + side < band_.width, below = y + side < band_.height;
    bool found = block(x, y, k - 1, !right && !below);
    if (right) found |= block(x + side, y, k - 1, !found && !below);
    if (below) found |= block(x, y + side, k - 1, !found && !right);
    if (right && below) block(x + side, y + side, k - 1, !found);
    return true;
  }

  void code_value(int x, int y) {
    const std::size_t i = at(band_.x + x, band_.y + y, stride_);
    std::uint32_t rest = 0;
    bool negative = false;
    if constexpr (Io::kWrites) {
      negative = source_[i] < 0;
      rest = static_cast<std::uint32_t>(negative ? -source_[i] : source_[i]) - 1;
    }
    models_->magnitude[neighbors(x, y)].code(io_, rest);
    io_.plain_bit(negative);
    const auto magnitude = static_cast<std::int32_t>(rest + 1);
    target_[i] = negative ? -magnitude : magnitude;
  }

  std::array<int, 2> limited(int x, int y, int k) const {
    return {std::min(1 << k, band_.width - x), std::min(1 << k, band_.height - y)};
  }
  bool any_in(const std::int32_t* plane, int x, int y, std::array<int, 2> sides) const {
    for (int j = 0; j < sides[1]; ++j) {
      const std::int32_t* row = plane + at(x, y + j, stride_);
      if (std::any_of(row, row + sides[0], [](std::int32_t v) { return v != 0; })) return true;
    }
    return false;
  }

  /// How much there is around a coefficient, in classes.
  std::size_t neighbors(int x, int y) const {
    constexpr std::int32_t kMost = 4;
    std::int32_t sum = 0;
    for (int j = std::max(y - 1, 0); j <= std::min(y + 1, band_.height - 1); ++j) {
      for (int i = std::max(x - 1, 0); i <= std::min(x + 1, band_.width - 1); ++i)
        sum += std::min(std::abs(target_[at(band_.x + i, band_.y + j, stride_)]), kMost);
    }
    return sum < 3 ? static_cast<std::size_t>(sum) : sum < 5 ? 3 : sum < 9 ? 4 : 5;
  }
  std::size_t parent(int x, int y) const {
    if (band_.parent_width == 0 || band_.parent_height == 0) return 0;
    const int i = std::min(x / 2, band_.parent_width - 1), j = std::min(y / 2, band_.parent_height - 1);
    return static_cast<std::size_t>(
        std::min(std::abs(target_[at(band_.parent_x + i, band_.parent_y + j, stride_)]), 2));
  }
  bool any_parent(int x, int y, int k) const {
    const int i = x / 2, j = y / 2, side = 1 << (k - 1);
    if (i >= band_.parent_width || j >= band_.parent_height) return false;
    return any_in(target_, band_.parent_x + i, band_.parent_y + j,
                  {std::min(side, band_.parent_width - i), std::min(side, band_.parent_height - j)});
  }

  Io& io_;
  int stride_;
  Band band_;
  std::array<Models, 6> models_of_;
  Models* models_ = nullptr;
  const std::int32_t* source_ = nullptr;
  std::int32_t* target_ = nullptr;
};

template <class Io>
void code_planes(Io& io, const WaveletImage* source, WaveletImage& target) {
  PlaneCode<Io> code(io, target.width);
  const bool has_color = target.channels >= 3;
  for (const Band& band : bands_of(target.width, target.height, target.levels)) {
    for (std::size_t c = 0; c < target.planes.size(); ++c) {
      const bool is_difference = has_color && (c == 1 || c == 2);
      code.code(band, is_difference, source ? source->planes[c].data() : nullptr, target.planes[c].data());
    }
  }
}

struct Head {
  std::array<char, 4> magic;
  std::uint32_t width, height;
  std::uint8_t channels, levels, encoding, reserved;
  float step;
};
constexpr std::array<char, 4> kMagic{'F', 'W', '9', '7'};
static_assert(sizeof(Head) == 20 && std::endian::native == std::endian::little);

WaveletImage empty_like(const WaveletImage& wavelets) {
  WaveletImage copy = wavelets;
  for (auto& plane : copy.planes) std::ranges::fill(plane, 0);
  return copy;
}

/// 0 for what is not a number: damaged codes may hold anything.
std::uint8_t to_byte(float value) {
  return value > 0 ? static_cast<std::uint8_t>(std::lround(std::min(value, 255.0f))) : std::uint8_t{0};
}

/// Brightness and differences of a texel in its first three channels, and back.
void to_differences(std::array<float, 4>& v) {
  const float y = 0.299f * v[0] + 0.587f * v[1] + 0.114f * v[2];
  v = {y, (v[2] - y) / 1.772f, (v[0] - y) / 1.402f, v[3]};
}
void to_colors(std::array<float, 4>& v) {
  const float r = v[0] + 1.402f * v[2], b = v[0] + 1.772f * v[1];
  v = {r, (v[0] - 0.299f * r - 0.114f * b) / 0.587f, b, v[3]};
}

bool is_centered(std::size_t channel, int channels) { return channels < 3 || channel == 0 || channel == 3; }

}  // namespace

void transform(std::span<float> plane, int width, int height, int levels) {
  std::vector<float> copy(std::max(plane.size(), static_cast<std::size_t>(width)));
  for (int l = 0; l < levels; ++l)
    transform_level(plane, width, side_after(width, l), side_after(height, l), false, copy);
}

void inverse_transform(std::span<float> plane, int width, int height, int levels) {
  std::vector<float> copy(std::max(plane.size(), static_cast<std::size_t>(width)));
  for (int l = levels; l-- > 0;)
    transform_level(plane, width, side_after(width, l), side_after(height, l), true, copy);
}

int wavelet_levels(int width, int height) {
  int levels = 0;
  while (side_after(std::max(width, height), levels) > kSmallest) ++levels;
  return levels;
}

WaveletImage wavelet_image(const Image8& image, float step) {
  if (!(step >= kLeastStep))
    throw Error(ErrorKind::usage, fmt::format("{} is no step for wavelets", step), {},
                fmt::format("allowed: {} and more", kLeastStep));
  WaveletImage wavelets{image.width,
                        image.height,
                        image.channels,
                        wavelet_levels(image.width, image.height),
                        step,
                        image.encoding,
                        {}};
  const auto channels = static_cast<std::size_t>(image.channels);
  const std::size_t count = image.pixels.size() / channels;
  std::vector<std::vector<float>> planes(channels, std::vector<float>(count));
  for (std::size_t i = 0; i < count; ++i) {
    std::array<float, 4> v{};
    for (std::size_t c = 0; c < channels; ++c) v[c] = image.pixels[i * channels + c];
    if (channels >= 3) to_differences(v);
    for (std::size_t c = 0; c < channels; ++c)
      planes[c][i] = v[c] - (is_centered(c, image.channels) ? kMiddle : 0);
  }
  for (std::vector<float>& plane : planes) {
    transform(plane, image.width, image.height, wavelets.levels);
    std::vector<std::int32_t>& multiples = wavelets.planes.emplace_back(count);
    for (std::size_t i = 0; i < count; ++i) {
      const auto magnitude = static_cast<std::int32_t>(std::abs(plane[i]) / step + kRound);
      multiples[i] = plane[i] < 0 ? -magnitude : magnitude;
    }
  }
  return wavelets;
}

Image8 reconstructed(const WaveletImage& wavelets) {
  Image8 image(wavelets.width, wavelets.height, wavelets.channels, wavelets.encoding);
  const auto channels = static_cast<std::size_t>(image.channels);
  const std::size_t count = image.pixels.size() / channels;
  std::vector<std::vector<float>> planes;
  for (const std::vector<std::int32_t>& multiples : wavelets.planes) {
    std::vector<float>& plane = planes.emplace_back(count);
    for (std::size_t i = 0; i < count; ++i) plane[i] = static_cast<float>(multiples[i]) * wavelets.step;
    inverse_transform(plane, image.width, image.height, wavelets.levels);
  }
  for (std::size_t i = 0; i < count; ++i) {
    std::array<float, 4> v{};
    for (std::size_t c = 0; c < channels; ++c)
      v[c] = planes[c][i] + (is_centered(c, image.channels) ? kMiddle : 0);
    if (channels >= 3) to_colors(v);
    for (std::size_t c = 0; c < channels; ++c) image.pixels[i * channels + c] = to_byte(v[c]);
  }
  return image;
}

PrunedWavelets pruned(const WaveletImage& wavelets, const ResolutionMap& map, double octaves) {
  PrunedWavelets result{empty_like(wavelets), 0};
  for (const Band& band : bands_of(wavelets.width, wavelets.height, wavelets.levels)) {
    const double least = std::exp2(octaves - band.level);
    const auto cells = [&](int i, int count) {
      const std::int64_t first = (std::int64_t{i} - kReach) << band.level,
                         last = ((std::int64_t{i} + kReach + 1) << band.level) - 1;
      const auto cell = [&](std::int64_t texel) {
        return static_cast<int>(std::clamp<std::int64_t>(texel / ResolutionMap::kCell, 0, count - 1));
      };
      return std::array{cell(first), cell(last)};
    };
    const auto is_seen = [&](int x, int y) {
      if (band.kind == 0) return true;
      const auto columns = cells(x, map.columns), rows = cells(y, map.rows);
      for (int r = rows[0]; r <= rows[1]; ++r) {
        for (int c = columns[0]; c <= columns[1]; ++c)
          if (map.pixels_per_texel[at(c, r, map.columns)] >= least) return true;
      }
      return false;
    };
    for (int y = 0; y < band.height; ++y) {
      for (int x = 0; x < band.width; ++x) {
        if (!is_seen(x, y)) continue;
        ++result.kept;
        const std::size_t i = at(band.x + x, band.y + y, wavelets.width);
        for (std::size_t c = 0; c < wavelets.planes.size(); ++c)
          result.image.planes[c][i] = wavelets.planes[c][i];
      }
    }
  }
  return result;
}

std::vector<std::uint8_t> encode(const WaveletImage& wavelets) {
  constexpr std::uint64_t kMostValues = std::uint64_t{1} << 28;
  if (static_cast<std::uint64_t>(wavelets.width) * static_cast<std::uint64_t>(wavelets.height) > kMostValues)
    throw Error(ErrorKind::limit, "the image is too large for a wavelet code");
  BitWriter writer;
  WaveletImage target = empty_like(wavelets);
  code_planes(writer, &wavelets, target);
  const Head head{kMagic,
                  static_cast<std::uint32_t>(wavelets.width),
                  static_cast<std::uint32_t>(wavelets.height),
                  static_cast<std::uint8_t>(wavelets.channels),
                  static_cast<std::uint8_t>(wavelets.levels),
                  static_cast<std::uint8_t>(wavelets.encoding),
                  0,
                  wavelets.step};
  std::vector<std::uint8_t> bytes(sizeof(Head));
  std::memcpy(bytes.data(), &head, sizeof(Head));
  const std::vector<std::uint8_t> code = writer.finish();
  bytes.insert(bytes.end(), code.begin(), code.end());
  return bytes;
}

WaveletImage decode_wavelets(std::span<const std::uint8_t> bytes, std::int64_t max_pixels) {
  Head head{};
  if (bytes.size() < sizeof(Head)) throw Error(ErrorKind::format, "the wavelet code has no head");
  std::memcpy(&head, bytes.data(), sizeof(Head));
  constexpr std::uint32_t kMostSide = 1u << 30;
  if (head.magic != kMagic || head.width == 0 || head.height == 0 || head.width > kMostSide ||
      head.height > kMostSide || head.channels < 1 || head.channels > 4 || head.encoding > 1 ||
      !(head.step >= kLeastStep) || !std::isfinite(head.step))
    throw Error(ErrorKind::format, "the wavelet code has a damaged head");
  if (std::int64_t{head.width} * head.height > max_pixels)
    throw Error(ErrorKind::limit, fmt::format("a wavelet image of {} x {} pixels exceeds the limit of {}",
                                              head.width, head.height, max_pixels));
  WaveletImage wavelets;
  wavelets.width = static_cast<int>(head.width);
  wavelets.height = static_cast<int>(head.height);
  wavelets.channels = head.channels;
  wavelets.levels = head.levels;
  wavelets.step = head.step;
  wavelets.encoding = static_cast<ColorEncoding>(head.encoding);
  if (wavelets.levels != wavelet_levels(wavelets.width, wavelets.height))
    throw Error(ErrorKind::format, "the wavelet code has another number of levels than its size needs");
  wavelets.planes.assign(head.channels, std::vector<std::int32_t>(static_cast<std::size_t>(head.width) *
                                                                  static_cast<std::size_t>(head.height)));
  BitReader reader(bytes.subspan(sizeof(Head)));
  code_planes(reader, nullptr, wavelets);
  if (!reader.is_at_end()) throw Error(ErrorKind::format, "the wavelet code goes on after its end");
  return wavelets;
}

}  // namespace fovea
