#pragma once

#include <cstdint>

#include "fovea/base/context.h"
#include "fovea/sample/height_map.h"
#include "fovea/sample/paint.h"

namespace fovea {

/// A landscape as the painter needs it. Heights and the water's level in widths of the map.
struct Landscape {
  HeightMap ground;  ///< Without water.
  HeightMap flow;    ///< How often water ran there.
  double water = 0;  ///< Level of lakes.
};

/// As seen from above on a summer morning: woods, meadows, rock, snow and lakes, with shadows.
Image8 paint_terrain(const Landscape& land, int size, std::uint64_t seed, const Context& context);

}  // namespace fovea
