#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "fovea/model/image.h"

// Private to texture.

namespace fovea {

/// The rows of an image smoothed by a Gaussian, one at a time: display values 0 … 255 in double precision,
/// the channels of colour one after the other (one plane if the image is grey), without alpha.
///
/// The kernel is that of SciPy's gaussian_filter: samples of the Gaussian up to four standard deviations,
/// with sum 1, rows before columns; beyond its borders the image is mirrored.
class GaussianRows {
 public:
  /// Refers to the image, which must outlive it. `sigma` in texels; 0 leaves the image as it is.
  GaussianRows(const Image8& image, double sigma);

  std::size_t planes() const { return planes_; }
  std::size_t width() const { return width_; }

  /// Memory of a thread.
  struct Scratch {
    std::vector<double> columns, padded;
  };
  /// Row `y` into `out` [planes × width]. O(width · σ).
  void smooth(int y, Scratch& scratch, std::span<double> out) const;

 private:
  void add_up_columns(int y, std::span<double> out) const;
  void pad(std::span<const double> columns, std::size_t plane, std::span<double> out) const;

  const Image8& image_;
  std::size_t width_, channels_, planes_;
  std::vector<double> weights_;  // [radius + 1], from the middle
};

}  // namespace fovea
