#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "fovea/surface/surface.h"

namespace fovea::test {

/// Growth of clusters as Munaretti 2007, section 5.1, has it, with floors of 0.3 under the factors of
/// equation 5.1 and means weighted by area: after each triangle all ways from taken triangles to free ones
/// are compared, and all means added up anew. Seeds share no triangles. `saliency` [#V], 0 … 1. For surfaces
/// that are connected through edges and about 1 large. O(#F²).
std::vector<std::uint32_t> literal_growth(const Surface& surface, std::span<const float> saliency,
                                          std::span<const std::uint32_t> seeds);

/// Re-seeding as it is written there, with a floor of 0.01 under what saliency shares: the most salient
/// vertex of the triangle whose shortest way from the cluster's border is longest, by Bellman and Ford.
/// O(#F²).
std::vector<std::uint32_t> literal_inner_seeds(const Surface& surface, std::span<const float> saliency,
                                               const std::vector<std::uint32_t>& of_face,
                                               std::uint32_t count);

}  // namespace fovea::test
