#pragma once

#include "fovea/base/context.h"
#include "fovea/sample/paint.h"

namespace fovea::sample {

/// Six charts in three columns and two rows, one for each side of a cube blown up to a sphere.
struct CubeAtlas {
  static constexpr int kWidth = 1152, kHeight = 768;
  static constexpr double kPitch = 384, kGutter = 5;

  Chart side(int i) const {
    return {kPitch * (i % 3) + kGutter, kPitch * (i / 3) + kGutter, kPitch - 2 * kGutter,
            kPitch - 2 * kGutter};
  }
};

/// The direction that side `i` shows at s, t in [-1, 1], before it is made a unit vector. Equal angles
/// have about equal lengths. Bit-equal where sides meet.
Vec3d cube_direction(int side, double s, double t);

/// A banded planet with a storm.
Image8 paint_gas_giant(const CubeAtlas& atlas, const Context& context);
/// A planet with seas, land, ice and clouds.
Image8 paint_earth(const CubeAtlas& atlas, const Context& context);

}  // namespace fovea::sample
