#pragma once

#include <functional>
#include <list>
#include <optional>
#include <vector>

#include "fovea/base/context.h"
#include "fovea/judge/compare.h"
#include "fovea/judge/flip.h"
#include "fovea/judge/ssim.h"
#include "fovea/model/model.h"
#include "fovea/render/render.h"
#include "fovea/render/scene.h"

namespace fovea {

/// What counts as lost in pictures, over what either model covers.
enum class Distortion {
  mse,      ///< Mean squared difference of display values (Horbelt et al. 2001),
  ms_ssim,  ///< 1 − MS-SSIM (Wang et al. 2003),
  flip,     ///< FLIP's error (Andersson et al. 2020).
};

/// What models lose against one original, in the same pictures again and again.
class PictureLoss {
 public:
  /// Draws the original from `views`, `size` pixels high, base colour and lit. It must outlive this.
  /// Throws as `compare`.
  PictureLoss(const Model& original, const ViewOptions& views, int size, Distortion distortion,
              Context& context);

  struct Loss {
    double value = 0;    ///< By the distortion, over all views and both passes alike.
    double squared = 0;  ///< Mean squared difference of display values, 0 … 255².
  };
  /// Images that the original or the models before had are not decoded again, up to some 64 million texels.
  /// MS-SSIM takes twice as long as MSE, FLIP several times.
  Loss of(const Model& model);
  /// All scores, as `compare` has them.
  Comparison scores(const Model& model);

 private:
  /// One view of the original in one pass.
  struct Seen {
    Picture picture;
    std::optional<SsimReference> ssim;
    std::optional<FlipReference> flip;
  };
  /// Keeps what was decoded for a scene.
  void keep_images(const RenderScene& scene);
  double distortion_of(const Seen& seen, const Picture& test, const Plane& mask, double squared) const;

  const Model& original_;
  Distortion distortion_;
  CompareOptions options_;
  Context& context_;
  RenderScene scene_;
  std::vector<View> views_;
  std::list<EncodedImage> kept_;         // what the images of `decoded_` are of, oldest first
  RenderScene decoded_;                  // images alone
  std::vector<std::vector<Seen>> seen_;  // [#views][#passes]
};

/// What models lose by squared difference in pictures of `shown_pixels` (64 at least and 2048 at most; 0:
/// 512) from `views`, for `ShrinkOptions::lost`. `original` and `context` must outlive it. None if the
/// original shows nothing. Throws what `views_of` throws.
std::function<double(const Model&)> loss_by_pictures(const Model& original, const ViewOptions& views,
                                                     double shown_pixels, Context& context);

}  // namespace fovea
