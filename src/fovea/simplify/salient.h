#pragma once

#include <vector>

#include "fovea/base/context.h"
#include "fovea/base/options.h"
#include "fovea/model/field.h"
#include "fovea/model/model.h"
#include "fovea/simplify/simplify.h"

namespace fovea {

/// How saliency S (0 … 1) becomes what a vertex's error is multiplied with.
enum class SaliencyWeighting {
  yang,  ///< 1 + (ω / max ω)³ with ω = 20 S from the 30th percentile up, S below (Yang et al. 2016, eq.
         ///< 10–11).
  lee,   ///< 100 S from the 30th percentile up, S below (Lee et al. 2005, section 5).
  munaretti,  ///< 100 S from 0.7 of the greatest up, S below: what several poses have to say (Munaretti
              ///< 2007, section 4.1).
};

struct SalientOptions {
  SaliencyWeighting weighting = SaliencyWeighting::yang;
  double strength = 1;  ///< Power that the weights are raised to: 0 leaves all vertices alike.
};
OptionList describe(SalientOptions& options);

/// Weights of vertices by their saliency, [#meshes][#V], scaled so that their mean over the surface is 1 and
/// errors keep their meaning. Percentiles are by area over the whole scene, at rest. Saliency below 0.001
/// counts as that, as a weight of 0 would let triangles degenerate. Throws Error(usage) for saliency of
/// another model. O(#V log #V + #F).
Importance salient_importance(const Model& model, const std::vector<VertexField>& saliency,
                              const SalientOptions& options, const Context& context);

/// Both, multiplied; either may be empty, or have empty fields. Throws Error(usage) if they are of different
/// models.
Importance product(const Importance& a, const Importance& b);

}  // namespace fovea
