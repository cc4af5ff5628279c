#pragma once

#include <cstdint>

#include "fovea/base/context.h"
#include "fovea/sample/height_map.h"
#include "fovea/sample/paint.h"

namespace fovea::sample {

/// A landscape as the painter needs it, cut out of the earth as a block. Heights and levels in widths of
/// the map.
struct Landscape {
  HeightMap ground;  ///< Without water.
  HeightMap flow;    ///< How often water ran there.
  double water = 0;  ///< Level of lakes.
  double base = 0;   ///< Level of the block's underside.
  double crest = 0;  ///< Highest level along the block's rim.
};

/// The texture of the block: the land from above, and two strips with two sides each.
struct TerrainAtlas {
  static constexpr int kWidth = 1024, kHeight = 1536;
  static constexpr double kGutter = 8;

  Chart top{8, 8, 1008, 1008};
  Chart sides[2] = {{8, 1032, 936, 240}, {8, 1288, 936, 240}};  ///< South and east; north and west.
  Chart bottom{960, 1032, 56, 56};
};

/// On top a summer morning: woods, meadows, rock, snow and lakes, with shadows. On the sides soil and
/// layers of rock, from `base` to `crest`.
Image8 paint_terrain(const Landscape& land, const TerrainAtlas& atlas, std::uint64_t seed,
                     const Context& context);

}  // namespace fovea::sample
