#include "fovea/judge/picture_scores.h"

#include <utility>

#include "fovea/judge/silhouette.h"
#include "fovea/model/image_error.h"

namespace fovea {

ReferencePicture::ReferencePicture(Picture picture, double pixels_per_degree)
    : picture_(std::move(picture)), ssim_(picture_.color), flip_(picture_.color, pixels_per_degree) {}

ImageScores ReferencePicture::score(const Picture& test) const {
  return score(test, flip(test), foreground(picture_.coverage, test.coverage));
}

ImageScores ReferencePicture::score(const Picture& test, const Plane& flip, const Plane& mask) const {
  ImageScores s;
  s.mse = mean_squared_error(picture_.color, test.color);
  s.mse_foreground = mean_squared_error(picture_.color, test.color, mask.values);
  s.psnr = psnr(s.mse);
  s.psnr_foreground = psnr(s.mse_foreground);
  const SsimScores ssim = ssim_.score(test.color, &mask);
  s.ssim = ssim.ssim;
  s.ssim_foreground = ssim.ssim_masked;
  s.ms_ssim = ssim.ms_ssim;
  s.ms_ssim_foreground = ssim.ms_ssim_masked;
  s.flip = mean(flip);
  s.flip_foreground = mean(flip, &mask);
  return s;
}

}  // namespace fovea
