#pragma once

#include <string>
#include <vector>

#include "fovea/base/context.h"
#include "fovea/model/model.h"
#include "fovea/simplify/simplify.h"

namespace fovea {

/// A way that was tried.
struct MetricTrial {
  std::string name;  ///< "quadric", "image from 4 times the target".
  SimplifyOptions options;
  double flip = 0;  ///< `small_picture_flips` (auto_saliency.h) of the simplified model; less is better.
};

struct AutoMetric {
  std::vector<MetricTrial> trials;
  std::size_t best = 0;
  double seconds = 0;  ///< What choosing cost.
};

/// Chooses the metric for one model and target by simplifying it with quadrics, with pictures deciding from
/// 2, 4 and 16 times the target on, and from twice the target on with what is hidden kept as near as the rest
/// (`even_exposure`), and comparing small pictures with the original. Ties go to the earlier. `options` say
/// all else; what they say of the metric does not count.
///
/// Cost: five times `simplify`, most of it that from 16 times the target on, and pictures. Throws what
/// `simplify` throws, and Error(cancelled).
AutoMetric choose_metric(const Model& model, const SimplifyOptions& options, const Importance& importance,
                         Context& context);

}  // namespace fovea
