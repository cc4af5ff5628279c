#pragma once

#include <span>

#include "fovea/saliency/agreement.h"

namespace fovea::test {

/// The measures of agreement by their words: ranks and the area under the curve over all pairs. O(n²).
Agreement agreement_by_pairs(std::span<const float> predicted, std::span<const float> observed,
                             std::span<const float> areas, double fixated_area);

}  // namespace fovea::test
