#pragma once

#include <cstdint>

#include "fovea/base/context.h"
#include "fovea/model/model.h"

namespace fovea {

/// How far apart the base colours on both sides of the seams of a texture are.
struct SeamJump {
  double mean = 0;          ///< Over the length of all seams on the surface, 0 … 1.
  double largest = 0;       ///< The mean of the worst edge.
  double length = 0;        ///< Of the seams, in scene units.
  std::uint64_t edges = 0;  ///< In how many edges.
};

/// Looks along every edge whose two triangles have one material and different texture coordinates. At points
/// not farther apart than a texel of either side, the base-colour image is looked up where each side has it:
/// between four texels, display values, nothing smaller than the image as it is. The jump is the absolute
/// difference, mean over red, green and blue.
///
/// A mesh counts once, at the largest scale at which it is shown; meshes that nothing shows do not count, nor
/// do edges of one or of more than two triangles. Images that cannot be decoded are reported to `context`
/// ("image-not-shown") and left out. O(#F log #F + #texels along seams).
SeamJump seam_jump(const Model& model, Context& context);

}  // namespace fovea
