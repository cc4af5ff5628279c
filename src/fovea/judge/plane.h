#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "fovea/model/image.h"

namespace fovea {

/// A picture of one number per pixel, rows from top to bottom.
struct Plane {
  int width = 0, height = 0;
  std::vector<float> values;  ///< [height × width]

  Plane() = default;
  Plane(int w, int h)
      : width(w), height(h), values(static_cast<std::size_t>(w) * static_cast<std::size_t>(h)) {}
  float* row(int y) { return values.data() + static_cast<std::size_t>(y) * static_cast<std::size_t>(width); }
  const float* row(int y) const {
    return values.data() + static_cast<std::size_t>(y) * static_cast<std::size_t>(width);
  }
};

/// What a filter sees beyond the border.
enum class Border {
  crop,       ///< Nothing: the result is smaller by the kernel's radius on each side.
  replicate,  ///< The border's own pixels again.
};

/// The kernel exp(−x² / 2σ²) over −radius … radius, with sum 1. σ in pixels.
std::vector<float> gaussian_kernel(double sigma, int radius);

/// Correlates rows with `kernel_x` and columns with `kernel_y`, both of odd length. With Border::crop the
/// picture must be at least as large as the kernel. O(#pixels · kernel).
Plane filter(const Plane& plane, std::span<const float> kernel_x, std::span<const float> kernel_y,
             Border border);

/// Means of 2 × 2 pixels; an odd last row or column is left out.
Plane halved(const Plane& plane);

/// The mean, or that of the pixels where `mask` (of the same size) is above 0; 0 without any. Summed in
/// double, in order.
double mean(const Plane& plane, const Plane* mask = nullptr);

/// Rec. 601 luma of display values, 0 … 255, without rounding. One or three channels.
Plane luma(const Image8& image);

/// One channel of an image as 0 … 255.
Plane channel(const Image8& image, int index);

}  // namespace fovea
