#pragma once

#include <span>
#include <string>
#include <vector>

#include "fovea/base/context.h"
#include "fovea/model/model.h"
#include "fovea/saliency/model_saliency.h"
#include "fovea/simplify/salient.h"
#include "fovea/simplify/simplify.h"

namespace fovea {

/// Weights that were tried.
struct SaliencyTrial {
  std::string name;  ///< "none", "geometry 0.5, color 0.25, entropy 0.25, strength 1".
  double geometry = 0, color = 0, entropy = 0, visibility = 0;  ///< Shares; 0 all for none.
  double strength = 0;
  double flip = 0;  ///< `small_picture_flips` of the simplified model; less is better.
};

struct AutoSaliency {
  Importance importance;  ///< Of the best trial; as `importance` was given if none was best.
  std::vector<SaliencyTrial> trials;
  std::size_t best = 0;
  double seconds = 0;  ///< What choosing cost.
};

/// Chooses the weights λ of geometry and texture, γ of colour and entropy (Yang et al. 2016 leave this open),
/// and the strength for one model by simplifying it under each and comparing small pictures with the
/// original (`small_picture_flips`). First which signal: none,
/// geometry, both, texture, visibility; then for a texture colour or entropy alone; then half and twice the
/// strength. Ties go to the earlier. Weighting is `yang`; `importance` multiplies every trial.
///
/// Cost: up to nine times `simplify` and pictures. Throws what `simplify` and `model_saliency` throw.
AutoSaliency choose_saliency(const Model& model, const SimplifyOptions& options, const Importance& importance,
                             const SaliencyOptions& saliency, Context& context);

/// [#tests] Mean FLIP of base colour and lit over the model's own pixels in 12 views (icosahedron) of 192².
std::vector<double> small_picture_flips(const Model& original, std::span<const Model> tests,
                                        Context& context);

}  // namespace fovea
