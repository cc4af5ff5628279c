#include "oracle/segment_oracle.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

namespace fovea::test {

namespace {

/// A component for each node, and the edges that joined them.
struct Components {
  std::vector<std::uint32_t> of_node;
  std::vector<PlainEdge> joints;

  double internal(std::uint32_t c) const {
    double most = 0;
    for (const PlainEdge& e : joints) {
      if (of_node[e.a] == c) most = std::max(most, e.weight);
    }
    return most;
  }
  std::size_t size(std::uint32_t c) const {
    return static_cast<std::size_t>(std::count(of_node.begin(), of_node.end(), c));
  }
  double limit(std::uint32_t c, double k) const { return internal(c) + k / static_cast<double>(size(c)); }
  void join(const PlainEdge& e) {
    const std::uint32_t from = of_node[e.b], to = of_node[e.a];
    joints.push_back(e);
    std::replace(of_node.begin(), of_node.end(), from, to);
  }
};

int mirrored(int i, int size) {
  while (i < 0 || i >= size) i = i < 0 ? -1 - i : 2 * size - 1 - i;
  return i;
}

/// The colour of a texel of the smoothed image; the same three times if it is grey.
std::array<double, 3> smooth_texel(const Image8& image, double sigma, int x, int y) {
  const int radius = sigma > 0 ? static_cast<int>(4 * sigma + 0.5) : 0;
  std::array<double, 3> sum{};
  double weights = 0;
  for (int j = -radius; j <= radius; ++j) {
    for (int i = -radius; i <= radius; ++i) {
      const double w = sigma > 0 ? std::exp(-(i * i + j * j) / (2 * sigma * sigma)) : 1;
      const std::uint8_t* texel = image.at(mirrored(x + i, image.width), mirrored(y + j, image.height));
      for (std::size_t k = 0; k < 3; ++k) sum[k] += w * texel[image.channels < 3 ? 0 : k];
      weights += w;
    }
  }
  for (double& s : sum) s /= weights;
  return sum;
}

double distance(const std::array<double, 3>& a, const std::array<double, 3>& b, bool is_grey) {
  if (is_grey) return std::abs(a[0] - b[0]);
  return std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
}

}  // namespace

std::vector<std::uint32_t> literal_segments(std::size_t node_count, std::vector<PlainEdge> edges, double k,
                                            std::size_t min_size) {
  Components components;
  for (std::size_t i = 0; i < node_count; ++i) components.of_node.push_back(static_cast<std::uint32_t>(i));
  std::stable_sort(edges.begin(), edges.end(),
                   [](const PlainEdge& a, const PlainEdge& b) { return a.weight < b.weight; });
  for (const PlainEdge& e : edges) {
    const std::uint32_t a = components.of_node[e.a], b = components.of_node[e.b];
    if (a != b && e.weight < components.limit(a, k) && e.weight < components.limit(b, k)) components.join(e);
  }
  for (const PlainEdge& e : edges) {
    const std::uint32_t a = components.of_node[e.a], b = components.of_node[e.b];
    if (a != b && (components.size(a) < min_size || components.size(b) < min_size)) components.join(e);
  }
  std::map<std::uint32_t, std::uint32_t> number;
  for (std::uint32_t& c : components.of_node)
    c = number.try_emplace(c, static_cast<std::uint32_t>(number.size())).first->second;
  return components.of_node;
}

std::vector<std::uint32_t> literal_segments(const Image8& image, const SegmentOptions& options) {
  std::vector<std::array<double, 3>> texels;
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) texels.push_back(smooth_texel(image, options.sigma, x, y));
  }
  std::vector<PlainEdge> edges;
  constexpr std::array<std::array<int, 2>, 4> kSteps{{{1, 0}, {0, 1}, {1, 1}, {-1, 1}}};
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      for (const auto& [dx, dy] : kSteps) {
        if (x + dx < 0 || x + dx >= image.width || y + dy >= image.height) continue;
        const auto a = static_cast<std::uint32_t>(y * image.width + x),
                   b = static_cast<std::uint32_t>((y + dy) * image.width + x + dx);
        edges.push_back({a, b, distance(texels[a], texels[b], image.channels < 3)});
      }
    }
  }
  return literal_segments(texels.size(), std::move(edges), options.k,
                          static_cast<std::size_t>(options.min_size));
}

}  // namespace fovea::test
