#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "fovea/model/image.h"
#include "fovea/model/material.h"
#include "fovea/model/model.h"
#include "fovea/saliency/texture_signals.h"

namespace fovea::test {

/// Red, green and blue of a texel of the image smoothed by 1 2 1 both ways, as display values 0 … 1.
std::array<double, 3> smooth_color(const Image8& image, const Sampler& sampler, int x, int y);

/// Entropy of greys around a texel by counting all of its window.
double counted_entropy(const Image8& image, const Sampler& sampler, const TextureSignalOptions& options,
                       int x, int y);

/// The inverse mapping of Yang et al. (2016), steps 1 to 4 and equation 6, with r' as the text of the paper
/// wants it (as printed weights would be constant): from a vertex V the texels of the triangles that have a
/// corner in the sphere of radius r or touch V, each with the weight exp(−‖TE − TE_V‖² / 2r'²). r' is the
/// distance from TE_V, along the direction of TE, to the ellipse that the triangle's affine map makes of the
/// sphere; texels beyond it do not count. V has a place TE_V in each of its charts; texels of a chart in
/// which it has none are as far as their points on the surface are from V. O(#F + #texels) for each vertex.
class TexelGather {
 public:
  /// For a mesh whose parts all use this texture of a material. Coordinates outside of [0, 1] repeat.
  TexelGather(const TriMesh& mesh, const TextureRef& ref, int width, int height);

  /// Averages of the three signals; none where no texel is in reach.
  std::optional<std::array<double, 3>> average(const TextureSignals& signals, std::uint32_t vertex,
                                               double radius) const;

 private:
  const TriMesh& mesh_;
  int width_, height_;
  std::vector<Vec2d> corner_texel_;          // [#F × 3], in texels
  std::vector<std::uint32_t> corner_chart_;  // [#F × 3]
  std::vector<std::vector<std::uint32_t>> vertex_corners_;
};

/// Spearman's coefficient: that of the ranks, equal values sharing theirs.
double rank_correlation(const std::vector<double>& a, const std::vector<double>& b);

}  // namespace fovea::test
