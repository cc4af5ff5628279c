#pragma once

#include <vector>

#include "fovea/model/model.h"
#include "fovea/texture/resize.h"

namespace fovea {

/// How a model's materials use an image, all of them together.
struct ImageUse {
  bool is_used = false;
  TexelMeaning meaning;
  /// Materials read it in ways that cannot be resized together (a normal map that is a colour elsewhere).
  bool is_ambiguous = false;
  /// Somebody may read its alpha: alpha masks and blending, and all that extensions do.
  bool alpha_counts = false;
  Wrap wrap_u = Wrap::clamp, wrap_v = Wrap::clamp;  ///< Repeating wins over mirroring and that over clamping.
};

/// [#images] Over all reads of all materials (texture_read.h).
std::vector<ImageUse> image_uses(const Model& model);

}  // namespace fovea
