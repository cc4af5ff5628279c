#pragma once

#include <span>

namespace fovea {

struct AgreementOptions {
  /// Share of the area that was looked at which counts as fixated, (0, 1]: the part with the largest values.
  double fixated_area = 0.05;
};

/// How well a prediction agrees with where people looked, in the measures of the field (Bylinskii et al.
/// 2019). They all weigh by area: cutting an element into pieces with its values changes nothing.
struct Agreement {
  double correlation = 0;  ///< Pearson's (LCC or CC), −1 to 1; 0 if either map is constant.
  double spearman = 0;     ///< The same of ranks; equal values share the middle of their ranks.
  /// That what is fixated has a higher prediction than what is not (Judd's AUC); equal ones count half.
  /// 0 to 1; 0.5 if the prediction is constant or all is fixated.
  double auc = 0.5;
  /// Mean prediction where fixated, in standard deviations above its mean (Peters et al. 2005).
  double nss = 0;
  double kl = 0;  ///< Divergence of the prediction from the observation as densities, in nats; 0 is best.
  double similarity = 0;  ///< What the two densities share (SIM, histogram intersection), 0 to 1.
};

/// Compares two maps over the same elements, vertices or faces, which have `areas`. [#elements] each.
/// Elements without area count nowhere. Fixated are the elements with the largest observed values, down to
/// the value at which they make up `fixated_area` of the area where anything was observed; all that have that
/// value belong to them.
///
/// As a density a prediction with negative values begins at 0, and one that is 0 everywhere is uniform. The
/// divergence is Σ p log(ε + p / (q + ε)) over the area, with p observed, q predicted and ε = 2⁻⁵², as in the
/// MIT saliency benchmark.
///
/// Never NaN. Throws Error(usage) for sizes that differ, numbers that are not finite, negative areas or
/// observations, and observations that are 0 wherever there is area. O(n log n).
Agreement agreement(std::span<const float> predicted, std::span<const float> observed,
                    std::span<const float> areas, const AgreementOptions& options = {});

}  // namespace fovea
