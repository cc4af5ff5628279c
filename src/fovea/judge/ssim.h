#pragma once

#include <vector>

#include "fovea/judge/plane.h"

namespace fovea {

/// The reference's part of SSIM at one scale: what does not depend on the image that it is compared with.
struct SsimScale {
  Plane luma;         ///< Less 128.
  Plane mean;         ///< Windowed, 5 pixels smaller on each side.
  Plane mean_square;  ///< Of luma², the same.
};

/// What SSIM says of two images.
struct SsimScores {
  double ssim = 1;                             ///< Mean of the full scale, −1 … 1; 1 is identical.
  double ms_ssim = 1;                          ///< 0 … 1; negative terms count as 0, as usual.
  double ssim_masked = 1, ms_ssim_masked = 1;  ///< Over the mask; 1 without one.
};

/// An image ready to be compared with others by SSIM and MS-SSIM.
///
/// Structural similarity (Wang, Bovik, Sheikh, Simoncelli 2004) of Rec. 601 luma, windows of 11 × 11 pixels
/// weighted by a Gaussian with σ = 1.5, K₁ = 0.01, K₂ = 0.03, only windows inside the image. Multi-scale
/// (Wang, Simoncelli, Bovik 2003): five scales, each of means of 2 × 2 pixels of the one before, weights
/// 0.0448, 0.2856, 0.3001, 0.2363, 0.1333; the contrast–structure term of every scale and the luminance term
/// of the last. Images below 176 pixels along a side have fewer scales: those where a window fits, their
/// weights scaled up to the sum of all.
class SsimReference {
 public:
  /// Throws Error(usage) for images of less than 11 pixels along a side.
  explicit SsimReference(const Image8& image);

  /// Compares `test` with this image; with a mask (of the image's size) also over the windows around pixels
  /// above 0, at every scale where any of them is in. Throws Error(usage) for an image of another size.
  SsimScores score(const Image8& test, const Plane* mask = nullptr) const;

 private:
  std::vector<SsimScale> scales_;
};

}  // namespace fovea
