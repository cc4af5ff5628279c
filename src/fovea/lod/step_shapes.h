#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "fovea/base/math.h"
#include "fovea/lod/level_selection.h"
#include "fovea/lod/multi_tessellation.h"
#include "fovea/model/model.h"
#include "fovea/simplify/simplify.h"

// Private to lod.

namespace fovea {

/// What the steps of a record make, as seen from afar: at rest, in scene units, where the scene shows the
/// mesh largest, and with vertices where the original has them. Each list is [#steps].
struct StepShapes {
  std::vector<float> x, y, z;                 ///< Centre of a sphere around it,
  std::vector<float> radius;                  ///< with its error.
  std::vector<float> axis_x, axis_y, axis_z;  ///< Mean normal; 0 without one.
  std::vector<float> spread;                  ///< Sine of the largest angle to it; 2 from 90° on.
  /// Whether it takes other triangles than those on the edge it collapses (two that came to lie on each
  /// other, a whole component), or leaves none.
  std::vector<std::uint8_t> takes_more;
  /// Its error by the importance of what it stands for: times the root of the largest weight, as weights
  /// multiply squares. Infinite where that is locked.
  std::vector<float> error;
};

/// Throws Error(usage) if importance or levels are of another model. O(#F).
StepShapes make_step_shapes(const Model& original, const MultiTessellation& levels,
                            const Importance& importance);

/// A camera as a loop over steps wants it.
struct StepEye {
  explicit StepEye(const LevelCamera& camera);
  StepEye() = default;

  Vec3f position, back;
  std::array<Vec3f, 4> sides;      ///< Normals of the planes that the picture lies between, inwards,
  std::array<float, 4> offsets{};  ///< and how far inside of each the eye is.
  float pixels = 1, near = 0;      ///< Pixels of a length at distance 1, or anywhere.
  float perspective = 1;           ///< 0 in parallel projection.
};

/// Errors on the screen in pixels, of steps `begin` to `end` into their places of `out` [#steps]: negative
/// for what cannot be seen, beyond the edges of the picture or turned away.
void see(const StepShapes& shapes, const StepEye& eye, std::size_t begin, std::size_t end, float* out);

}  // namespace fovea
