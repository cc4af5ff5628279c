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

/// Chooses the metric for one model and target by simplifying it in several ways and comparing small pictures
/// with the original: with quadrics; with pictures deciding from 2, 4 and 16 times the target on; from twice
/// the target on with what is hidden kept as near as the rest (`even_exposure`); and, if `options` leave
/// their size open, from 4 times on by pictures of 512² (left out where these are more than a metric looks
/// at). Ties go to the earlier. `options` say all else; what they say of the metric does not count.
///
/// Cost: six times `simplify`, most of it with large pictures or from 16 times the target on, and pictures.
/// Throws what `simplify` throws, and Error(cancelled).
AutoMetric choose_metric(const Model& model, const SimplifyOptions& options, const Importance& importance,
                         Context& context);

}  // namespace fovea
