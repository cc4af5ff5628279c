#pragma once

#include <vector>

#include "fovea/base/options.h"
#include "fovea/model/field.h"
#include "fovea/render/view.h"
#include "fovea/saliency/attention.h"

namespace fovea {

/// How the error that is allowed grows with the distance from a focus.
enum class AttentionLaw {
  threshold,  ///< The focus' share of it within the threshold, all beyond (paper 004).
  linear,     ///< From the one to the other, up to the threshold.
  acuity,     ///< As the finest detail that the eye can tell, see `AttentionLawOptions::factor`.
};

struct AttentionLawOptions {
  AttentionLaw law = AttentionLaw::threshold;
  double threshold = 60;  ///< In fifths of a pixel, as labels are; larger than 0.
  /// Share of the error that is allowed at a focus, 0 … 1; 0 keeps its surroundings as they are. With acuity
  /// more than 0: e degrees from the focus 1 + e / 2.5 times as much is allowed as there, but never more than
  /// elsewhere. (Detail that can just be told grows linearly with eccentricity, Weymouth 1958; it doubles
  /// every 2.5 degrees for gratings, Levi, Klein and Aitsebaomo 1985.)
  double factor = 0.05;
  /// Times as much error is allowed at a focus of neglect; falls to 1 at the threshold, at once or linearly
  /// as the law says (acuity: linearly). 1 or more.
  double neglect = 4;
  /// From how far the picture is seen, in its heights; 0: so that it fills the camera's angle of view.
  double viewing_distance = 0;
};
OptionList describe(AttentionLawOptions& options);

/// Labels from here on are all the same to the law.
double attention_reach(const AttentionLawOptions& options, const View& view, int view_size);

/// How much of an error is allowed at each vertex, for each mesh: 1 is all, 0 none, more where nobody looks.
/// What is nearer to a focus of neglect than to another is neglected. `view` and `view_size` are those of the
/// labels. Throws Error(usage) for acuity without a factor, or of a parallel view without a viewing distance.
std::vector<VertexField> allowed_shares(const AttentionLabels& labels, const View& view, int view_size,
                                        const AttentionLawOptions& options);

/// The importance of vertices at which shares of an error are allowed, for `simplify`: errors are distances,
/// importance multiplies their squares. Infinite, which locks, where nothing is allowed.
std::vector<VertexField> importance_of(const std::vector<VertexField>& shares);

}  // namespace fovea
