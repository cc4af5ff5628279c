#include "fovea/texture/felzenszwalb.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <limits>

#include "fovea/base/error.h"
#include "fovea/model/image_fit.h"
#include "fovea/surface/disjoint_sets.h"
#include "fovea/texture/edge_sort.h"
#include "fovea/texture/texel_edges.h"

namespace fovea {

namespace {

constexpr std::uint64_t kMostTexelsOfAll = std::uint64_t{1} << 30;

/// Edges given as a list: the weight as the bits of a float, which are in the order of what they stand for,
/// above the number of the edge.
class ListedEdges {
 public:
  ListedEdges(std::span<const WeightedEdge> edges, std::size_t node_count, const Context& context)
      : edges_(edges) {
    keys_.reserve(edges.size());
    for (std::size_t i = 0; i < edges.size(); ++i) {
      const WeightedEdge& edge = edges[i];
      if (std::max(edge.a, edge.b) >= node_count || !(edge.weight >= 0))
        throw Error(
            ErrorKind::usage,
            fmt::format("edge {} is from {} to {} with the weight {}", i, edge.a, edge.b, edge.weight),
            "graph", fmt::format("there are {} nodes; weights are 0 or more", node_count));
      // −0 has other bits than 0.
      keys_.push_back(std::uint64_t{std::bit_cast<std::uint32_t>(edge.weight + 0.0f)} << 32 | i);
    }
    sort_by_high_bits(keys_, 32, context);
  }

  std::vector<std::uint64_t>& keys() { return keys_; }
  std::array<std::uint32_t, 2> ends(std::uint64_t key) const {
    const WeightedEdge& edge = edges_[static_cast<std::uint32_t>(key)];
    return {edge.a, edge.b};
  }
  double weight(std::uint64_t key) const {
    return static_cast<double>(edges_[static_cast<std::uint32_t>(key)].weight);
  }

 private:
  std::span<const WeightedEdge> edges_;
  std::vector<std::uint64_t> keys_;
};

/// The components of a graph as they grow; the first node stands for each.
class GrowingRegions {
 public:
  GrowingRegions(std::size_t node_count, double k)
      : sets_(node_count), size_(node_count, 1), limit_(node_count, k), k_(k) {}

  std::uint32_t find(std::uint32_t node) { return sets_.find(node); }
  void prefetch(std::uint32_t node) const { sets_.prefetch(node); }
  bool may_join(std::uint32_t a, std::uint32_t b, double weight) const {
    return weight < std::min(limit_[a], limit_[b]);
  }
  std::uint32_t smaller_size(std::uint32_t a, std::uint32_t b) const { return std::min(size_[a], size_[b]); }
  void join(std::uint32_t a, std::uint32_t b, double weight) {
    const std::uint32_t size = size_[a] + size_[b], root = std::min(a, b);
    sets_.unite(a, b);
    size_[root] = size;
    limit_[root] = weight + k_ / size;
  }

  Segmentation labels() {
    Segmentation result;
    result.label.resize(size_.size());
    for (std::uint32_t i = 0; i < size_.size(); ++i) {
      const std::uint32_t root = sets_.find(i);  // its first node
      result.label[i] = root == i ? result.count++ : result.label[root];
    }
    return result;
  }

 private:
  DisjointSets sets_;
  std::vector<std::uint32_t> size_;  // of those that stand for a component
  std::vector<double> limit_;        // Int(C) + k / |C|
  double k_;
};

/// Calls f(key, a, b) for each edge between two components, in the order of the keys, with those that stand
/// for the components. Mostly waits for memory, so what is needed soon is asked for.
template <class Edges, class F>
void for_edges_between(std::span<const std::uint64_t> keys, const Edges& edges, GrowingRegions& regions,
                       F&& f) {
  constexpr std::size_t kAhead = 24;
  for (std::size_t i = 0; i < keys.size(); ++i) {
    if (i + kAhead < keys.size()) {
      for (const std::uint32_t end : edges.ends(keys[i + kAhead])) regions.prefetch(end);
    }
    const auto [from, to] = edges.ends(keys[i]);
    const std::uint32_t a = regions.find(from), b = regions.find(to);
    if (a != b) f(keys[i], a, b);
  }
}

/// Both passes over edges in the order of their keys.
template <class Edges>
Segmentation segment(std::size_t node_count, Edges& edges, const SegmentOptions& options) {
  GrowingRegions regions(node_count, options.k);
  std::vector<std::uint64_t>& keys = edges.keys();
  std::size_t between = 0;  // edges that join nothing, moved to the front
  for_edges_between(keys, edges, regions, [&](std::uint64_t key, std::uint32_t a, std::uint32_t b) {
    const double weight = edges.weight(key);
    if (regions.may_join(a, b, weight)) {
      regions.join(a, b, weight);
    } else {
      keys[between++] = key;
    }
  });
  keys.resize(between);
  for_edges_between(keys, edges, regions, [&](std::uint64_t, std::uint32_t a, std::uint32_t b) {
    if (regions.smaller_size(a, b) < options.min_size) regions.join(a, b, 0);
  });
  return regions.labels();
}

}  // namespace

OptionList describe(SegmentOptions& o) {
  const double infinity = std::numeric_limits<double>::infinity();
  return {
      {"region-sigma",
       "Standard deviation of the Gaussian that smooths a texture before its regions are sought.", &o.sigma,
       "texels", 0, 100},
      {"region-k", "Contrast that keeps texture regions apart: higher makes them larger.", &o.k,
       "display values times texels", 0, infinity},
      {"region-min-size", "Smaller texture regions are joined to a neighbour.", &o.min_size, "texels", 0,
       infinity},
      {"region-texels", "Larger textures are reduced before their regions are sought.", &o.most_texels,
       "texels", 1, infinity},
  };
}

Segmentation segment_graph(std::size_t node_count, std::span<const WeightedEdge> edges,
                           const SegmentOptions& options, const Context& context) {
  SegmentOptions checked = options;
  check(describe(checked));
  if (std::max(node_count, edges.size()) > std::numeric_limits<std::uint32_t>::max())
    throw Error(ErrorKind::limit, "the graph is too large to be segmented");
  ListedEdges listed(edges, node_count, context);
  return segment(node_count, listed, options);
}

LabelMap segment_image(const Image8& image, const SegmentOptions& options, const Context& context) {
  SegmentOptions checked = options;
  check(describe(checked));
  const auto texels = static_cast<std::uint64_t>(image.width) * static_cast<std::uint64_t>(image.height);
  if (texels == 0) return {};
  if (static_cast<std::int64_t>(texels) > options.most_texels)
    return segment_image(fitted(image, options.most_texels, context), options, context);
  if (texels > kMostTexelsOfAll) throw Error(ErrorKind::limit, "the image is too large to be segmented");
  TexelEdges edges(image, options.sigma, context);
  Segmentation found = segment(texels, edges, options);
  return {image.width, image.height, std::move(found.label), found.count};
}

}  // namespace fovea
