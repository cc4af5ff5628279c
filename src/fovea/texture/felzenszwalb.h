#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "fovea/base/context.h"
#include "fovea/base/options.h"
#include "fovea/model/image.h"

namespace fovea {

// Segmentation of graphs and images: Felzenszwalb and Huttenlocher, "Efficient graph-based image
// segmentation" (IJCV 2004). In the order of their weights, edges join the two components at their ends if
// the weight is less than Int(C) + k / |C| of both, where Int(C) is the largest weight that joined C and |C|
// the number of its nodes. (Less, as in scikit-image; the paper lets equal weights join.) Then, in the same
// order, every edge joins its components if one has fewer nodes than the minimum.

/// How images are segmented.
struct SegmentOptions {
  /// Standard deviation of the Gaussian that smooths an image first, in texels: 0 … 100. 0.8 takes away what
  /// quantisation and compression leave and keeps edges (the authors' value).
  double sigma = 0.8;
  /// The scale k, in display values (0 … 255) times texels, 0 or more: a region of n texels needs k / n more
  /// contrast at its border than within. 300 is the authors' value for photographs; González et al. give
  /// none.
  double k = 300;
  /// Regions of fewer texels are joined to a neighbour. The paper gives none. Of a million texels on a view
  /// of some hundred pixels a square, 100 are a few pixels: letters remain, specks of dust do not.
  std::int64_t min_size = 100;
  /// Larger images are reduced first by the smallest whole factor that leaves no more texels: views of a
  /// model show few more, and k and the minimum mean about the same for all sizes.
  std::int64_t most_texels = std::int64_t{1024} * 1024;
};
OptionList describe(SegmentOptions& options);

/// An edge of a graph. Direction does not matter.
struct WeightedEdge {
  std::uint32_t a = 0, b = 0;  ///< Nodes.
  float weight = 0;            ///< Difference of the two; 0 or more.
};

/// Which component each node of a graph is in.
struct Segmentation {
  std::vector<std::uint32_t> label;  ///< [#nodes], counted from 0 in the order of each one's first node.
  std::uint32_t count = 0;
};

/// The components of a graph by `options.k` (in units of the weights, times nodes) and `options.min_size`
/// (nodes). Edges of equal weight go in their order in `edges`, which matters for small components only.
/// Nodes that no edges connect stay apart. O(#nodes + #edges · α), 16 bytes per edge and 20 per node.
///
/// Throws Error(usage) for ends that are no nodes, weights that are not 0 or more and options out of range,
/// Error(limit) for 2³² edges or nodes.
Segmentation segment_graph(std::size_t node_count, std::span<const WeightedEdge> edges,
                           const SegmentOptions& options, const Context& context);

/// Which region each texel of an image is in.
struct LabelMap {
  int width = 0, height = 0;          ///< Those of the image as it was segmented.
  std::vector<std::uint32_t> labels;  ///< [height × width], counted from 0 in scan order.
  std::uint32_t count = 0;
};

/// The regions of an image. Nodes are texels; edges join the 8 neighbours of each (without wrapping around);
/// weights are distances of display values (grey images: differences of one value; alpha is left out).
///
/// With `k`, `sigma` and `min_size` as the scale, sigma and min_size of scikit-image's
/// segmentation.felzenszwalb (its defaults are 1, 0.8, 20) the regions are the same ones, but for what
/// rounding decides. (1) The order of equal weights matters only where a small region is equally near to two
/// neighbours: here scan order decides, there an unstable sort. (2) Weights are rounded to 2⁻³⁵ in display
/// values here (2⁻³¹ for 2048² texels: 64 bits hold them and the number of the edge), and thresholds to
/// single precision there; weights that differ less can change places.
///
/// O(#texels · σ), parallel but for the joining; 64 bytes per texel on the way, 4 in the result. The same
/// regions for any number of threads. Throws Error(usage) for options out of range, Error(limit) beyond 2³⁰
/// texels.
LabelMap segment_image(const Image8& image, const SegmentOptions& options, const Context& context);

}  // namespace fovea
