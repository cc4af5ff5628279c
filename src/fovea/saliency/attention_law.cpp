#include "fovea/saliency/attention_law.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "fovea/base/error.h"
#include "fovea/saliency/distance_transform.h"

namespace fovea {

namespace {

/// Degrees from the focus at which detail must be twice as coarse.
constexpr double kHalfAcuity = 2.5;

/// The tangent of the angle that a fifth of a pixel takes, near the middle of the picture.
double label_slope(const View& view, int view_size, const AttentionLawOptions& options) {
  const double half = options.viewing_distance > 0 ? 0.5 / options.viewing_distance : view.half_height;
  return 2 * half / view_size / kChamferEdge;
}

void check_law(const AttentionLawOptions& options, const View& view) {
  AttentionLawOptions checked = options;
  check(describe(checked));
  if (options.law != AttentionLaw::acuity) return;
  if (options.factor == 0) {
    throw Error(ErrorKind::usage, "acuity grows from the share at the focus, which is 0", "--factor",
                "give a share above 0, for example 0.05");
  }
  if (!view.perspective && options.viewing_distance == 0) {
    throw Error(ErrorKind::usage, "a parallel view has no angle", "--viewing-distance",
                "say from how many picture heights it is seen, for example 2.5");
  }
}

}  // namespace

OptionList describe(AttentionLawOptions& o) {
  return {
      {"law",
       "How the allowed error grows with the distance from a focus: all at once beyond a threshold, linearly "
       "up to it, or as the eye's acuity falls.",
       choice(o.law, {"threshold", "linear", "acuity"}), ""},
      {"threshold", "How far a focus reaches, in fifths of a pixel of the picture.", &o.threshold,
       "fifths of a pixel", 1e-3, 1e9},
      {"factor", "Share of the error that is allowed at a focus; 0 keeps its surroundings as they are.",
       &o.factor, "", 0, 1},
      {"neglect", "How much more error is allowed at a focus of neglect, one with a negative weight.",
       &o.neglect, "times", 1, 1e6},
      {"viewing-distance",
       "From how far the picture is seen, for acuity; 0: so that it fills the camera's angle of view.",
       &o.viewing_distance, "picture heights", 0, 1000}};
}

double attention_reach(const AttentionLawOptions& options, const View& view, int view_size) {
  if (options.law != AttentionLaw::acuity) return options.threshold;
  const double degrees = options.factor > 0 ? kHalfAcuity * (1 / options.factor - 1) : 180;
  if (degrees >= 89) return std::numeric_limits<double>::infinity();
  return std::max(options.threshold,
                  std::tan(degrees * std::numbers::pi / 180) / label_slope(view, view_size, options));
}

std::vector<VertexField> allowed_shares(const AttentionLabels& labels, const View& view, int view_size,
                                        const AttentionLawOptions& options) {
  check_law(options, view);
  const double slope = label_slope(view, view_size, options);
  const auto at_focus = [&](double label) {
    if (!std::isfinite(label)) return 1.0;
    switch (options.law) {
      case AttentionLaw::threshold: return label < options.threshold ? options.factor : 1.0;
      case AttentionLaw::linear:
        return options.factor + (1 - options.factor) * std::min(label / options.threshold, 1.0);
      case AttentionLaw::acuity: break;
    }
    const double degrees = std::atan(label * slope) * 180 / std::numbers::pi;
    return std::min(options.factor * (1 + degrees / kHalfAcuity), 1.0);
  };
  const auto neglected = [&](double label) {
    if (!(label < options.threshold)) return 1.0;
    if (options.law == AttentionLaw::threshold) return options.neglect;
    return options.neglect + (1 - options.neglect) * label / options.threshold;
  };
  std::vector<VertexField> shares;
  for (std::size_t m = 0; m < labels.attended.size(); ++m) {
    VertexField& share = shares.emplace_back(labels.attended[m].size());
    for (std::size_t v = 0; v < share.size(); ++v) {
      const double near = static_cast<double>(labels.attended[m].values()[v]);
      const double off = static_cast<double>(labels.neglected[m].values()[v]);
      share.values()[v] =
          static_cast<float>(off < near && off < options.threshold ? neglected(off) : at_focus(near));
    }
  }
  return shares;
}

std::vector<VertexField> importance_of(const std::vector<VertexField>& shares) {
  std::vector<VertexField> importance = shares;
  for (VertexField& field : importance) {
    for (float& x : field.values()) x = x > 0 ? 1 / (x * x) : std::numeric_limits<float>::infinity();
  }
  return importance;
}

}  // namespace fovea
