#include "fovea/judge/plane.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "fovea/base/wide.h"

namespace fovea {

namespace {

/// Eight neighbours, in whatever registers the machine has.
using Float8 [[gnu::vector_size(32)]] = float;

/// out[x] = Σ_k weights[k] · in[k][x], added up in the order of k; in runs whose sums stay in registers.
FOVEA_WIDE void weighted_sum(const float* const* in, const float* weights, int taps, float* out, int count) {
  constexpr int kRun = 32;
  int x = 0;
  for (; x + kRun <= count; x += kRun) {
    Float8 sum_0 = {}, sum_1 = {}, sum_2 = {}, sum_3 = {}, in_0, in_1, in_2, in_3;
    for (int k = 0; k < taps; ++k) {
      const float* const from = in[k] + x;
      std::memcpy(&in_0, from, sizeof in_0);
      std::memcpy(&in_1, from + 8, sizeof in_1);
      std::memcpy(&in_2, from + 16, sizeof in_2);
      std::memcpy(&in_3, from + 24, sizeof in_3);
      sum_0 += weights[k] * in_0;
      sum_1 += weights[k] * in_1;
      sum_2 += weights[k] * in_2;
      sum_3 += weights[k] * in_3;
    }
    std::memcpy(out + x, &sum_0, sizeof sum_0);
    std::memcpy(out + x + 8, &sum_1, sizeof sum_1);
    std::memcpy(out + x + 16, &sum_2, sizeof sum_2);
    std::memcpy(out + x + 24, &sum_3, sizeof sum_3);
  }
  for (; x < count; ++x) {
    float sum = 0;
    for (int k = 0; k < taps; ++k) sum += weights[k] * in[k][x];
    out[x] = sum;
  }
}

Plane filter_rows(const Plane& in, std::span<const float> kernel, Border border) {
  const int taps = static_cast<int>(kernel.size()), radius = taps / 2;
  Plane out(border == Border::crop ? in.width - 2 * radius : in.width, in.height);
  std::vector<float> padded(static_cast<std::size_t>(in.width + 2 * radius));
  std::vector<const float*> shifted(kernel.size());
  for (int y = 0; y < in.height; ++y) {
    const float* source = in.row(y);
    if (border == Border::replicate) {
      std::fill_n(padded.begin(), radius, source[0]);
      std::copy_n(source, in.width, padded.begin() + radius);
      std::fill_n(padded.begin() + radius + in.width, radius, source[in.width - 1]);
      source = padded.data();
    }
    for (int k = 0; k < taps; ++k) shifted[static_cast<std::size_t>(k)] = source + k;
    weighted_sum(shifted.data(), kernel.data(), taps, out.row(y), out.width);
  }
  return out;
}

Plane filter_columns(const Plane& in, std::span<const float> kernel, Border border) {
  const int taps = static_cast<int>(kernel.size()), radius = taps / 2;
  const int skipped = border == Border::crop ? radius : 0;
  Plane out(in.width, in.height - 2 * skipped);
  std::vector<const float*> rows(kernel.size());
  for (int y = 0; y < out.height; ++y) {
    for (int k = 0; k < taps; ++k)
      rows[static_cast<std::size_t>(k)] = in.row(std::clamp(y + skipped + k - radius, 0, in.height - 1));
    weighted_sum(rows.data(), kernel.data(), taps, out.row(y), out.width);
  }
  return out;
}

}  // namespace

std::vector<float> gaussian_kernel(double sigma, int radius) {
  std::vector<double> weights;
  double sum = 0;
  for (int i = -radius; i <= radius; ++i) {
    weights.push_back(std::exp(-i * i / (2 * sigma * sigma)));
    sum += weights.back();
  }
  std::vector<float> kernel;
  for (const double w : weights) kernel.push_back(static_cast<float>(w / sum));
  return kernel;
}

Plane filter(const Plane& plane, std::span<const float> kernel_x, std::span<const float> kernel_y,
             Border border) {
  return filter_columns(filter_rows(plane, kernel_x, border), kernel_y, border);
}

Plane halved(const Plane& plane) {
  Plane out(plane.width / 2, plane.height / 2);
  for (int y = 0; y < out.height; ++y) {
    const float *a = plane.row(2 * y), *b = plane.row(2 * y + 1);
    for (int x = 0; x < out.width; ++x)
      out.row(y)[x] = 0.25f * (a[2 * x] + a[2 * x + 1] + b[2 * x] + b[2 * x + 1]);
  }
  return out;
}

double mean(const Plane& plane, const Plane* mask) {
  double sum = 0;
  std::size_t count = 0;
  for (std::size_t i = 0; i < plane.values.size(); ++i) {
    if (mask != nullptr && !(mask->values[i] > 0)) continue;
    sum += static_cast<double>(plane.values[i]);
    ++count;
  }
  return count > 0 ? sum / static_cast<double>(count) : 0;
}

Plane luma(const Image8& image) {
  if (image.channels < 3) return channel(image, 0);
  Plane out(image.width, image.height);
  const std::uint8_t* p = image.pixels.data();
  for (float& value : out.values) {
    value = 0.299f * p[0] + 0.587f * p[1] + 0.114f * p[2];
    p += image.channels;
  }
  return out;
}

Plane channel(const Image8& image, int index) {
  Plane out(image.width, image.height);
  const std::uint8_t* p = image.pixels.data() + index;
  for (float& value : out.values) {
    value = *p;
    p += image.channels;
  }
  return out;
}

}  // namespace fovea
