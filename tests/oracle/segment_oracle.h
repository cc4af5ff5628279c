#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "fovea/model/image.h"
#include "fovea/texture/felzenszwalb.h"

namespace fovea::test {

struct PlainEdge {
  std::uint32_t a = 0, b = 0;
  double weight = 0;
};

/// Felzenszwalb and Huttenlocher's algorithm 1 as it is written, with "less" for "at most", and the joining
/// of small components after it. Int(C) is looked for among the edges that joined C, |C| is counted.
/// O(#nodes · #edges).
std::vector<std::uint32_t> literal_segments(std::size_t node_count, std::vector<PlainEdge> edges, double k,
                                            std::size_t min_size);

/// The same for the texels of an image, smoothed by adding up the whole square of a two-dimensional
/// Gaussian around each. O(#texels²).
std::vector<std::uint32_t> literal_segments(const Image8& image, const SegmentOptions& options);

}  // namespace fovea::test
