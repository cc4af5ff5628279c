#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "fovea/render/scene.h"
#include "fovea/render/view.h"
#include "fovea/simplify/simplify.h"
#include "fovea/surface/pose.h"

namespace fovea {

/// Which metric decides, and when: quadrics until few triangles are left, then what views see.
struct MetricStage {
  Metric metric = Metric::quadric;  ///< Never `automatic`.
  std::uint64_t from = 0;           ///< Of a metric by views: from so many triangles on,
  int view_size = 256;              ///< in pictures of so many pixels high.

  bool is_by_views() const { return metric != Metric::quadric && metric != Metric::visibility; }
  /// Whether what is seen counts more (`exposed_importance`).
  bool is_by_exposure() const { return metric == Metric::visibility || metric == Metric::image; }
};

/// What the options mean for `total` triangles of which `target` are to be left, 0 without a target.
///
/// `automatic` is the image, from twice the target on; but quadrics for targets of more than 12,000
/// triangles, of which each covers two or three pixels of a view, without a target, and for meshes one by
/// one. If the model's own cameras look, who may see a part of it alone, the image decides about any target,
/// from 12,000 triangles on at least. Views of the image are no larger than gives the mean triangle of the
/// target some 400 pixels over 20 views that a model half fills. Why twice and why 400:
/// docs/simplification.md.
MetricStage metric_stage(const SimplifyOptions& options, std::uint64_t target, std::uint64_t total);

/// A model at rest and what looks at it. Refers to the model.
struct ViewedModel {
  Pose pose;
  RenderScene scene;  ///< With base colours, metalness and roughness.
  std::vector<View> views;
};
/// Throws what `views_of` throws, and Error(limit) if a metric by views would hold too many pixels.
ViewedModel viewed_model(const Model& model, const ViewOptions& options, const MetricStage& stage,
                         Context& context);
/// Of all pictures.
double pixel_count(std::span<const View> views, int size);

/// [#meshes] Weights of vertices by how much of the surface around them views see (render/exposure.h), for
/// the metrics `visibility` and `image`. Nothing weighs less than a thousandth; for the image from all around
/// less than a fifth, and 1 is what a convex solid shows, as the rest is seen from elsewhere.
Importance exposed_importance(const Model& model, const ViewedModel& viewed, const SimplifyOptions& options,
                              const MetricStage& stage, const Context& context);

}  // namespace fovea
