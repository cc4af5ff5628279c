#pragma once

#include "fovea/base/context.h"
#include "fovea/sample/paint.h"

namespace fovea::sample {

/// Where the charts of the arm lie on its texture; s runs around, t towards the fingertips.
struct ArmAtlas {
  static constexpr int kSize = 1024;
  static constexpr int kFingers = 5;
  Chart sleeve{6, 6, 552, 1012};
  Chart skin{572, 6, 446, 780};  ///< From the cuff to the end of the palm.

  Chart finger(int i) const { return {574.0 + 90 * i, 804, 80, 212}; }
};

/// Lengths that the painting needs to keep its proportions.
struct ArmMeasure {
  double sleeve = 1, skin = 1;  ///< Along the profile.
};

/// A striped knitted sleeve, and a hand and forearm with a tattoo.
Image8 paint_arm(const ArmAtlas& atlas, const ArmMeasure& measure, const Context& context);

}  // namespace fovea::sample
