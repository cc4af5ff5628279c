#pragma once

#include <cstdint>

#include "fovea/simplify/simplify.h"

namespace fovea {

/// Which metric decides, and when: quadrics until few triangles are left, then what views see.
struct MetricStage {
  Metric metric = Metric::quadric;  ///< Never `automatic`.
  std::uint64_t from = 0;           ///< Of a metric by views: from so many triangles on,
  int view_size = 256;              ///< in pictures of so many pixels square.

  bool is_by_views() const { return metric != Metric::quadric && metric != Metric::visibility; }
};

/// What the options mean for `total` triangles of which `target` are to be left, 0 without a target.
///
/// `automatic` is the image, from twice the target on; but quadrics for targets of more than 12,000
/// triangles, of which each covers two or three pixels of a view, without a target, and for meshes one by
/// one. Views of the image are no larger than gives the mean triangle of the target some 400 pixels over 20
/// views that a model half fills. Why twice and why 400: docs/simplification.md.
MetricStage metric_stage(const SimplifyOptions& options, std::uint64_t target, std::uint64_t total);

/// Weights of vertices by how much of the surface around them views see, for the metric `visibility`
/// (render/exposure.h), at rest; where none sees anything a thousandth. Throws what `views_of` throws.
Importance exposed_importance(const Model& model, const SimplifyOptions& options, Context& context);

}  // namespace fovea
