#include "fovea/judge/ssim.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "fovea/base/error.h"

namespace fovea {

namespace {

constexpr int kRadius = 5;
constexpr double kSigma = 1.5;
constexpr float kC1 = (0.01f * 255) * (0.01f * 255), kC2 = (0.03f * 255) * (0.03f * 255);
constexpr std::array<double, 5> kWeights{0.0448, 0.2856, 0.3001, 0.2363, 0.1333};

Plane windowed(const Plane& plane) {
  static const std::vector<float> kKernel = gaussian_kernel(kSigma, kRadius);
  return filter(plane, kKernel, kKernel, Border::crop);
}

/// Luma around 0: variances are differences of squares, which then lose less.
constexpr float kMiddle = 128;
Plane centered_luma(const Image8& image) {
  Plane plane = luma(image);
  for (float& value : plane.values) value -= kMiddle;
  return plane;
}

Plane product(const Plane& a, const Plane& b) {
  Plane out(a.width, a.height);
  for (std::size_t i = 0; i < out.values.size(); ++i) out.values[i] = a.values[i] * b.values[i];
  return out;
}

/// The mask of windows: that of their middle pixels.
Plane inner(const Plane& mask) {
  Plane out(mask.width - 2 * kRadius, mask.height - 2 * kRadius);
  for (int y = 0; y < out.height; ++y) std::copy_n(mask.row(y + kRadius) + kRadius, out.width, out.row(y));
  return out;
}

/// SSIM and its contrast–structure term in every window.
struct SsimMaps {
  Plane ssim, contrast_structure;
};

SsimMaps compare(const SsimScale& scale, const Plane& test) {
  const Plane mean_b = windowed(test), square_b = windowed(product(test, test)),
              cross = windowed(product(scale.luma, test));
  SsimMaps maps{Plane(mean_b.width, mean_b.height), Plane(mean_b.width, mean_b.height)};
  for (std::size_t i = 0; i < mean_b.values.size(); ++i) {
    const float a = scale.mean.values[i], b = mean_b.values[i];
    const float variance_a = scale.mean_square.values[i] - a * a, variance_b = square_b.values[i] - b * b;
    const float covariance = cross.values[i] - a * b;
    const float cs = (2 * covariance + kC2) / (variance_a + variance_b + kC2);
    const float light_a = a + kMiddle, light_b = b + kMiddle;
    maps.contrast_structure.values[i] = cs;
    maps.ssim.values[i] = cs * (2 * light_a * light_b + kC1) / (light_a * light_a + light_b * light_b + kC1);
  }
  return maps;
}

bool has_window(const Plane& plane) { return std::min(plane.width, plane.height) > 2 * kRadius; }

}  // namespace

SsimReference::SsimReference(const Image8& image) {
  Plane plane = centered_luma(image);
  if (!has_window(plane))
    throw Error(ErrorKind::usage, "SSIM needs images of at least 11 pixels along a side");
  while (scales_.size() < kWeights.size() && has_window(plane)) {
    SsimScale scale{plane, windowed(plane), windowed(product(plane, plane))};
    plane = halved(plane);
    scales_.push_back(std::move(scale));
  }
}

SsimScores SsimReference::score(const Image8& test, const Plane* mask) const {
  const Plane& own = scales_.front().luma;
  if (test.width != own.width || test.height != own.height)
    throw Error(ErrorKind::usage, "images of different size cannot be compared");
  // The weights of all five add up to 1.0001; those of fewer are scaled to that.
  const double all = std::accumulate(kWeights.begin(), kWeights.end(), 0.0);
  const double used = std::accumulate(kWeights.begin(), kWeights.begin() + scales_.size(), 0.0);
  Plane plane = centered_luma(test), reduced = mask != nullptr ? *mask : Plane();
  SsimScores scores;
  for (std::size_t s = 0; s < scales_.size(); ++s) {
    const SsimMaps maps = compare(scales_[s], plane);
    const Plane& term = s + 1 == scales_.size() ? maps.ssim : maps.contrast_structure;
    const double weight = kWeights[s] * all / used;
    if (s == 0) scores.ssim = mean(maps.ssim);
    scores.ms_ssim *= std::pow(std::max(mean(term), 0.0), weight);
    if (mask != nullptr) {
      const Plane windows = inner(reduced);
      // Where nothing of the mask is far enough from the border nothing is said against it.
      if (std::any_of(windows.values.begin(), windows.values.end(), [](float m) { return m > 0; })) {
        if (s == 0) scores.ssim_masked = mean(maps.ssim, &windows);
        scores.ms_ssim_masked *= std::pow(std::max(mean(term, &windows), 0.0), weight);
      }
    }
    if (s + 1 == scales_.size()) break;
    plane = halved(plane);
    if (mask != nullptr) reduced = halved(reduced);
  }
  scores.ms_ssim = std::min(scores.ms_ssim, 1.0);
  scores.ms_ssim_masked = std::min(scores.ms_ssim_masked, 1.0);
  return scores;
}

}  // namespace fovea
