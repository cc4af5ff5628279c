#pragma once

#include "fovea/base/context.h"
#include "fovea/cluster/clusters.h"
#include "fovea/model/model.h"
#include "fovea/simplify/simplify.h"

namespace fovea {

/// Weights for one simplification of a whole model that keeps what stands out within each cluster (Munaretti
/// 2007, section 5.3): saliency local to clusters (cluster_properties.h), smoothed, amplified as by Lee et
/// al. (salient.h). So that clusters which have nothing that stands out in the whole keep a choice of levels
/// too, and borders fit. Smoothing is over 0.006 of the scene's diagonal, the finest scale of saliency; the
/// thesis does not say. `scene` is the model's at rest, `saliency` [#V of the scene]. Throws Error(usage) for
/// those of others.
Importance cluster_importance(const Model& model, const SceneSurface& scene, const VertexField& saliency,
                              const Clusters& clusters, const Context& context);

}  // namespace fovea
