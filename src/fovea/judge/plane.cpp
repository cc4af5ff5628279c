#include "fovea/judge/plane.h"

#include <algorithm>
#include <cmath>

namespace fovea {

namespace {

/// Adds `weight` times what lies `shift` to the right, for `count` pixels.
void add_scaled(float* out, const float* in, float weight, int count) {
  for (int x = 0; x < count; ++x) out[x] += weight * in[x];
}

Plane filter_rows(const Plane& in, std::span<const float> kernel, Border border) {
  const int taps = static_cast<int>(kernel.size()), radius = taps / 2;
  Plane out(border == Border::crop ? in.width - 2 * radius : in.width, in.height);
  std::vector<float> padded(static_cast<std::size_t>(in.width + 2 * radius));
  for (int y = 0; y < in.height; ++y) {
    const float* source = in.row(y);
    if (border == Border::replicate) {
      std::fill_n(padded.begin(), radius, source[0]);
      std::copy_n(source, in.width, padded.begin() + radius);
      std::fill_n(padded.begin() + radius + in.width, radius, source[in.width - 1]);
      source = padded.data();
    }
    for (int k = 0; k < taps; ++k)
      add_scaled(out.row(y), source + k, kernel[static_cast<std::size_t>(k)], out.width);
  }
  return out;
}

Plane filter_columns(const Plane& in, std::span<const float> kernel, Border border) {
  const int taps = static_cast<int>(kernel.size()), radius = taps / 2;
  const int skipped = border == Border::crop ? radius : 0;
  Plane out(in.width, in.height - 2 * skipped);
  for (int y = 0; y < out.height; ++y) {
    for (int k = 0; k < taps; ++k) {
      const int from = std::clamp(y + skipped + k - radius, 0, in.height - 1);
      add_scaled(out.row(y), in.row(from), kernel[static_cast<std::size_t>(k)], out.width);
    }
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
