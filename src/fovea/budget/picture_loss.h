#pragma once

#include <vector>

#include "fovea/base/context.h"
#include "fovea/judge/compare.h"
#include "fovea/model/model.h"
#include "fovea/render/render.h"
#include "fovea/render/scene.h"

namespace fovea {

/// What models lose against one original, in the same pictures again and again.
class PictureLoss {
 public:
  /// Draws the original from `views`, `size` × `size` pixels, base colour and lit. It must outlive this.
  /// Throws as `compare`.
  PictureLoss(const Model& original, const ViewOptions& views, int size, Context& context);

  /// The mean squared difference of display values over what either covers, both passes and all views alike.
  /// Images that the original or the model before had are not decoded again.
  double squared(const Model& model);
  /// All scores, as `compare` has them: MS-SSIM and FLIP cost several times as much.
  Comparison scores(const Model& model);

 private:
  const Model& original_;
  CompareOptions options_;
  Context& context_;
  RenderScene scene_;
  std::vector<View> views_;
  std::vector<std::vector<Picture>> pictures_;  // [#views][#passes]
};

}  // namespace fovea
