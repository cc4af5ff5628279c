#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "fovea/base/context.h"
#include "fovea/model/model.h"
#include "fovea/surface/facing_point.h"
#include "fovea/texture/atlas.h"
#include "fovea/texture/tangent_frame.h"
#include "fovea/texture/texel_origin.h"

// Shared inside Fovea, not installed.

namespace fovea {

/// An atlas on two models, one of which was simplified to the other: finds for each place of the simpler
/// surface the place of the original that it stands for, in the pose at rest.
///
/// That is the place of the same mesh, material and connected piece that lies nearest along the normal of the
/// triangle's plane and faces the same way, no farther than half the triangle's longest edge; if there is
/// none, the nearest in any direction; else there is none.
class SurfaceOrigin {
 public:
  /// A place on the original.
  struct Place {
    std::uint32_t face = 0;  ///< Of `original_faces`.
    std::array<double, 3> weights{1, 0, 0};
  };

  /// The models have the same meshes and parts, and must outlive this. O(#F log #F).
  SurfaceOrigin(const Model& original, const Atlas& original_atlas, const Model& simplified,
                const Atlas& simplified_atlas);

  std::span<const AtlasFace> original_faces() const { return original_faces_; }
  std::span<const AtlasFace> faces() const { return faces_; }
  const TangentFrames& original_frames() const { return original_frames_; }

  /// Thread-safe. About O(log #F).
  std::optional<Place> place(std::uint32_t face, const std::array<double, 3>& weights) const;

  /// Where the texels of a new image come from in the original's. Texels stay where they are
  /// by their own coordinates if there is no place, and if it is less than half a texel away. Where several
  /// triangles lie (halves that share their texels, mostly) they get the mean of what these ask for, or stay
  /// if that is far apart. O(#texels log #F), parallel. Throws Error(cancelled).
  TexelOrigins origins(int width, int height, const Context& context) const;

 private:
  TexelOrigin origin(std::uint32_t face, const std::array<double, 3>& weights) const;

  /// The triangles of one mesh that may be found.
  struct Target {
    Surface surface;
    std::vector<std::uint32_t> faces;  // triangle -> of `original_faces_`
    std::unique_ptr<FacingPoint> tree;
  };

  std::vector<AtlasFace> original_faces_, faces_;
  TangentFrames original_frames_, frames_;
  std::vector<Target> targets_;               // [#meshes], empty for those without
  std::vector<std::uint32_t> kinds_;          // of `faces_`
  std::vector<std::array<Vec3d, 3>> points_;  // of `faces_`
};

}  // namespace fovea
