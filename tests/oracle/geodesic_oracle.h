#pragma once

#include <vector>

#include "fovea/surface/surface.h"

namespace fovea::test {

/// Shortest paths over a small surface by definition: between any two vertices the straight lines over every
/// sequence of triangles that they can cross, up to `radius`, and then chains of these (Dijkstra). Grows
/// exponentially with the radius in edges. [#V][#V], infinite where no path is short enough.
std::vector<std::vector<double>> all_geodesics(const Surface& surface, double radius);

}  // namespace fovea::test
