#pragma once

#include "fovea/judge/flip.h"
#include "fovea/judge/plane.h"
#include "fovea/judge/ssim.h"
#include "fovea/render/render.h"

namespace fovea {

/// How like two pictures are, or the views of two models. Names with `foreground`: over the pixels that
/// either model covers, so that values do not depend on how much background there is.
struct ImageScores {
  double mse = 0, mse_foreground = 0;    ///< Of display values.
  double psnr = 0, psnr_foreground = 0;  ///< dB, from `mse`; infinite if there is no difference.
  double ssim = 1, ssim_foreground = 1;
  double ms_ssim = 1, ms_ssim_foreground = 1;
  double flip = 0, flip_foreground = 0;  ///< 0 is identical, 1 the most.
};

/// A picture, with what its comparison with any other needs.
class ReferencePicture {
 public:
  /// Throws Error(usage) for pictures of less than 11 pixels along a side.
  explicit ReferencePicture(Picture picture, double pixels_per_degree = kFlipPixelsPerDegree);

  const Picture& picture() const { return picture_; }
  /// FLIP's error map.
  Plane flip(const Picture& test) const { return flip_.map(test.color); }
  /// All scores of another picture of the same size. `flip` is its error map if that is there already; `mask`
  /// what either covers (silhouette.h).
  ImageScores score(const Picture& test) const;
  ImageScores score(const Picture& test, const Plane& flip, const Plane& mask) const;

 private:
  Picture picture_;
  SsimReference ssim_;
  FlipReference flip_;
};

}  // namespace fovea
