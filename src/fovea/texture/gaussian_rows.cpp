#include "fovea/texture/gaussian_rows.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "fovea/base/wide.h"
#include "fovea/model/wrap.h"

namespace fovea {

namespace {

constexpr double kTruncate = 4;  // standard deviations

std::vector<double> gaussian_weights(double sigma) {
  if (!(sigma > 0)) return {1};
  const auto radius = static_cast<std::size_t>(kTruncate * sigma + 0.5);
  std::vector<double> weights;
  double sum = 0;
  for (std::size_t i = 0; i <= radius; ++i) {
    const auto x = static_cast<double>(i);
    weights.push_back(std::exp(-0.5 * x * x / (sigma * sigma)));
    sum += (i == 0 ? 1 : 2) * weights.back();
  }
  for (double& w : weights) w /= sum;
  return weights;
}

FOVEA_WIDE void set_bytes(const std::uint8_t* row, double weight, std::size_t count, double* out) {
  for (std::size_t i = 0; i < count; ++i) out[i] = weight * row[i];
}

FOVEA_WIDE void add_bytes(const std::uint8_t* above, const std::uint8_t* below, double weight,
                          std::size_t count, double* sum) {
  for (std::size_t i = 0; i < count; ++i) sum[i] += weight * (above[i] + below[i]);
}

/// out[i] = Σ weights[|j|] · row[i + radius + j], for a row with `radius` numbers more at each end.
FOVEA_WIDE void add_up_row(const double* row, const double* weights, std::size_t radius, std::size_t count,
                           double* out) {
  for (std::size_t i = 0; i < count; ++i) out[i] = weights[0] * row[i + radius];
  for (std::size_t j = 1; j <= radius; ++j) {
    const double *const left = row + radius - j, *const right = row + radius + j;
    for (std::size_t i = 0; i < count; ++i) out[i] += weights[j] * (left[i] + right[i]);
  }
}

}  // namespace

GaussianRows::GaussianRows(const Image8& image, double sigma)
    : image_(image),
      width_(static_cast<std::size_t>(image.width)),
      channels_(static_cast<std::size_t>(image.channels)),
      planes_(image.channels < 3 ? 1 : 3),
      weights_(gaussian_weights(sigma)) {}

void GaussianRows::add_up_columns(int y, std::span<double> out) const {
  const auto row = [&](int i) { return image_.at(0, wrapped_texel(i, image_.height, Wrap::mirror)); };
  set_bytes(row(y), weights_[0], out.size(), out.data());
  for (int j = 1; j < static_cast<int>(weights_.size()); ++j)
    add_bytes(row(y - j), row(y + j), weights_[static_cast<std::size_t>(j)], out.size(), out.data());
}

void GaussianRows::pad(std::span<const double> columns, std::size_t plane, std::span<double> out) const {
  const std::size_t radius = weights_.size() - 1;
  const auto mirrored = [&](std::size_t padded) {
    const auto x = static_cast<std::int64_t>(padded) - static_cast<std::int64_t>(radius);
    const auto at = static_cast<std::size_t>(wrapped_texel(x, image_.width, Wrap::mirror));
    return columns[at * channels_ + plane];
  };
  for (std::size_t x = 0; x < radius; ++x) out[x] = mirrored(x);
  for (std::size_t x = 0; x < width_; ++x) out[radius + x] = columns[x * channels_ + plane];
  for (std::size_t x = radius + width_; x < out.size(); ++x) out[x] = mirrored(x);
}

void GaussianRows::smooth(int y, Scratch& scratch, std::span<double> out) const {
  const std::size_t radius = weights_.size() - 1;
  scratch.columns.resize(width_ * channels_);
  scratch.padded.resize(width_ + 2 * radius);
  add_up_columns(y, scratch.columns);
  for (std::size_t plane = 0; plane < planes_; ++plane) {
    pad(scratch.columns, plane, scratch.padded);
    add_up_row(scratch.padded.data(), weights_.data(), radius, width_, out.data() + plane * width_);
  }
}

}  // namespace fovea
