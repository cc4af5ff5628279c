#include "fovea/cluster/cluster_colors.h"

#include <algorithm>
#include <limits>
#include <utility>

namespace fovea {

namespace {

using Color = std::array<std::uint8_t, 3>;

constexpr std::array<Color, 12> kPalette{{{225, 75, 70},
                                          {70, 140, 215},
                                          {245, 200, 70},
                                          {80, 170, 90},
                                          {150, 95, 190},
                                          {245, 140, 55},
                                          {65, 190, 190},
                                          {240, 140, 190},
                                          {150, 105, 70},
                                          {180, 220, 95},
                                          {85, 85, 185},
                                          {215, 215, 225}}};
/// Squares of distances between colours that nobody takes for each other.
constexpr int kClear = 80 * 80;

int squared_distance(Color a, Color b) {
  int sum = 0;
  for (std::size_t i = 0; i < 3; ++i) sum += (a[i] - b[i]) * (a[i] - b[i]);
  return sum;
}

using Pair = std::pair<std::uint32_t, std::uint32_t>;

void make_unique(std::vector<Pair>& pairs) {
  std::sort(pairs.begin(), pairs.end());
  pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
}

/// Clusters that share a vertex, both ways. Of more than a few around one vertex only those that follow each
/// other.
std::vector<Pair> neighbors(const SceneSurface& scene, const Clusters& clusters) {
  constexpr std::size_t kFew = 12;
  std::vector<Pair> at;  // vertex and cluster
  for (std::size_t f = 0; f < scene.surface.triangles.size(); ++f) {
    for (const std::uint32_t v : scene.surface.triangles[f]) at.emplace_back(v, clusters.of_face[FaceId{f}]);
  }
  make_unique(at);
  std::vector<Pair> pairs;
  for (std::size_t i = 0; i < at.size(); ++i) {
    for (std::size_t j = i + 1; j < at.size() && j < i + kFew && at[j].first == at[i].first; ++j) {
      pairs.emplace_back(at[i].second, at[j].second);
      pairs.emplace_back(at[j].second, at[i].second);
    }
  }
  make_unique(pairs);
  return pairs;
}

}  // namespace

std::vector<Color> cluster_colors(const SceneSurface& scene, const Clusters& clusters) {
  const std::vector<Pair> pairs = neighbors(scene, clusters);
  std::vector<std::size_t> chosen(clusters.count);
  std::array<std::uint32_t, kPalette.size()> uses{};
  auto next = pairs.begin();
  for (std::uint32_t c = 0; c < clusters.count; ++c) {
    std::array<int, kPalette.size()> nearest;
    nearest.fill(std::numeric_limits<int>::max());
    for (; next != pairs.end() && next->first == c; ++next) {
      if (next->second > c) continue;  // has none yet
      for (std::size_t i = 0; i < kPalette.size(); ++i)
        nearest[i] = std::min(nearest[i], squared_distance(kPalette[i], kPalette[chosen[next->second]]));
    }
    std::size_t best = 0;
    for (std::size_t i = 1; i < kPalette.size(); ++i) {
      const int is = std::min(nearest[i], kClear), was = std::min(nearest[best], kClear);
      if (is > was || (is == was && uses[i] < uses[best])) best = i;
    }
    chosen[c] = best;
    ++uses[best];
  }
  std::vector<Color> colors;
  for (const std::size_t i : chosen) colors.push_back(kPalette[i]);
  return colors;
}

}  // namespace fovea
