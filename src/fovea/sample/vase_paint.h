#pragma once

#include "fovea/base/context.h"
#include "fovea/sample/paint.h"

namespace fovea::sample {

/// Where the charts of the vase lie on its texture.
struct VaseAtlas {
  static constexpr int kSize = 1024;
  Chart body{0, 0, kSize, 640};      ///< s around, t from foot to lip.
  Chart inside{0, 652, kSize, 116};  ///< s around, t from lip to floor.
  Chart lip{0, 780, kSize, 20};
  Chart bottom{6, 814, 204, 204};                              ///< Seen from below.
  Chart handles[2]{{226, 814, 96, 204}, {340, 814, 96, 204}};  ///< s around, t along.
};

/// Lengths on the body that the painting needs to keep its proportions.
struct VaseMeasure {
  double around = 1;  ///< Circumference at the belly.
  double along = 1;   ///< From foot to lip along the profile.
};

/// A light horse without detail on a ground of blue waves full of it, between borders.
Image8 paint_vase(const VaseAtlas& atlas, const VaseMeasure& measure, const Context& context);

}  // namespace fovea::sample
