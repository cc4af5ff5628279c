#include "fovea/saliency/distance_transform.h"

#include <algorithm>
#include <array>

namespace fovea {

namespace {

constexpr std::int32_t kFar = 1 << 30;

struct Step {
  int dx, dy, cost;
};
/// To cells that the first pass has been at; the second goes the other way.
constexpr std::array<Step, 8> kBefore{{{-1, 0, kChamferEdge},
                                       {0, -1, kChamferEdge},
                                       {-1, -1, kChamferCorner},
                                       {1, -1, kChamferCorner},
                                       {-2, -1, kChamferKnight},
                                       {2, -1, kChamferKnight},
                                       {-1, -2, kChamferKnight},
                                       {1, -2, kChamferKnight}}};

}  // namespace

std::vector<std::int32_t> distance_transform(int width, int height, std::span<const GridCell> sources) {
  std::vector<std::int32_t> distance(static_cast<std::size_t>(width) * static_cast<std::size_t>(height),
                                     kFar);
  const auto at = [&](int x, int y) -> std::int32_t& {
    return distance[static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
                    static_cast<std::size_t>(x)];
  };
  for (const GridCell& source : sources) at(source.x, source.y) = 0;
  const auto relax = [&](int x, int y, int way) {
    std::int32_t& here = at(x, y);
    for (const Step& step : kBefore) {
      const int from_x = x + way * step.dx, from_y = y + way * step.dy;
      if (from_x < 0 || from_x >= width || from_y < 0 || from_y >= height) continue;
      here = std::min(here, at(from_x, from_y) + step.cost);
    }
  };
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) relax(x, y, 1);
  }
  for (int y = height; y-- > 0;) {
    for (int x = width; x-- > 0;) relax(x, y, -1);
  }
  return distance;
}

}  // namespace fovea
