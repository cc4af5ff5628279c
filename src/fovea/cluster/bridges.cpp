#include "fovea/cluster/bridges.h"

#include <algorithm>

namespace fovea {

namespace {

constexpr int kLevels = 20;  // of the octree

/// The lowest 20 bits of x, three places apart.
std::uint64_t spread_bits(std::uint64_t x) {
  x = (x | x << 32) & 0x001F00000000FFFFull;
  x = (x | x << 16) & 0x001F0000FF0000FFull;
  x = (x | x << 8) & 0x100F00F00F00F00Full;
  x = (x | x << 4) & 0x10C30C30C30C30C3ull;
  return (x | x << 2) & 0x1249249249249249ull;
}

struct PlacedPoint {
  std::uint64_t code = 0;
  std::uint32_t point = 0;
};

/// The points along a Z-order curve (Morton 1966) through the cells of the finest level.
std::vector<PlacedPoint> along_curve(std::span<const Vec3f> points) {
  Box box;
  for (const Vec3f& p : points) box.add(Vec3d(p));
  const Vec3d size = box.high - box.low;
  const double longest = std::max({size.x, size.y, size.z});
  const double cells = longest > 0 ? ((1 << kLevels) - 1) / longest : 0;
  const auto bits = [](double x) { return spread_bits(static_cast<std::uint64_t>(x)); };
  std::vector<PlacedPoint> placed;
  placed.reserve(points.size());
  for (std::uint32_t i = 0; i < points.size(); ++i) {
    const Vec3d cell = (Vec3d(points[i]) - box.low) * cells;
    placed.push_back({bits(cell.x) | bits(cell.y) << 1 | bits(cell.z) << 2, i});
  }
  std::sort(placed.begin(), placed.end(), [](const PlacedPoint& a, const PlacedPoint& b) {
    return a.code != b.code ? a.code < b.code : a.point < b.point;
  });
  return placed;
}

}  // namespace

std::vector<std::pair<std::uint32_t, std::uint32_t>> bridges(std::span<const Vec3f> points,
                                                             DisjointSets& sets) {
  std::vector<std::pair<std::uint32_t, std::uint32_t>> result;
  std::size_t missing = 0;
  for (std::size_t i = 0; i < points.size(); ++i) missing += sets.find(i) == i;
  if (missing <= 1) return result;
  --missing;
  std::vector<PlacedPoint> placed = along_curve(points);
  for (int level = 0; missing > 0; ++level) {
    std::size_t kept = 0;  // the first of each cell
    for (std::size_t i = 0; i < placed.size(); ++i) {
      if (i == 0 || placed[i].code >> 3 * level != placed[kept - 1].code >> 3 * level) {
        placed[kept++] = placed[i];
        continue;
      }
      const std::uint32_t a = placed[kept - 1].point, b = placed[i].point;
      if (sets.find(a) == sets.find(b)) continue;
      sets.unite(a, b);
      result.emplace_back(a, b);
      --missing;
    }
    placed.resize(kept);
  }
  return result;
}

}  // namespace fovea
