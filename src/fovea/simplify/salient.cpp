#include "fovea/simplify/salient.h"

#include <algorithm>
#include <cmath>

#include "fovea/base/error.h"
#include "fovea/model/check_fields.h"
#include "fovea/surface/curvature.h"
#include "fovea/surface/pose.h"
#include "fovea/surface/scene_surface.h"
#include "fovea/surface/statistics.h"

namespace fovea {

namespace {

constexpr double kThreshold = 0.3;      // η, α: percentile
constexpr float kHighThreshold = 0.7f;  // α of Munaretti: part of the maximum
constexpr double kYangAmplifier = 20;   // κ
constexpr double kYangExponent = 3;     // ζ
constexpr double kAmplifier = 100;      // λ of Lee et al. and Munaretti
constexpr double kLeastSaliency = 1e-3;
constexpr double kLeastWeight = 1e-6;  // strong powers would fall below what floats hold

/// The paper's weights, before they are scaled.
std::vector<double> weights(std::span<const float> saliency, float threshold, SaliencyWeighting weighting) {
  const bool yang = weighting == SaliencyWeighting::yang;
  const double amplifier = yang ? kYangAmplifier : kAmplifier;
  std::vector<double> amplified;
  double highest = 0;
  for (const float s : saliency) {
    const double x = std::max(static_cast<double>(s), kLeastSaliency);
    amplified.push_back(s >= threshold ? amplifier * x : x);
    highest = std::max(highest, amplified.back());
  }
  if (yang) {
    for (double& w : amplified) w = 1 + std::pow(w / highest, kYangExponent);
  }
  return amplified;
}

/// From where on saliency is amplified: η, α.
float threshold_of(const VertexField& saliency, const VertexField& areas, SaliencyWeighting weighting) {
  if (weighting == SaliencyWeighting::munaretti) {
    float most = 0;
    for (const float s : saliency.values()) most = std::max(most, s);
    return kHighThreshold * most;
  }
  const double share[] = {kThreshold};
  return percentiles(saliency.values(), areas.values(), share)[0];
}

}  // namespace

OptionList describe(SalientOptions& o) {
  return {
      {"saliency-weighting",
       "How saliency weighs errors: gently and at the peaks (Yang et al.), all but the dullest third a "
       "hundred times (Lee et al.), or that only from 0.7 of the greatest up (Munaretti, for several poses).",
       choice(o.weighting, {"yang", "lee", "munaretti"}), ""},
      {"saliency-strength", "Power that these weights are raised to.", &o.strength, "", 0, 10}};
}

Importance salient_importance(const Model& model, const std::vector<VertexField>& saliency,
                              const SalientOptions& options, const Context& context) {
  check_fields(model, saliency);
  SceneSurface scene = scene_surface(model, rest_pose(model));
  scale(scene.surface, unit_scale(scene.surface));  // areas are floats
  const VertexField all = joined(saliency);
  const VertexField areas = vertex_areas(scene.surface, Adjacency(scene.surface, context), context);
  const std::vector<double> raw =
      weights(all.values(), threshold_of(all, areas, options.weighting), options.weighting);
  std::vector<double> powers;
  double sum = 0, area = 0;
  for (std::size_t v = 0; v < raw.size(); ++v) {
    const auto a = static_cast<double>(areas.values()[v]);
    powers.push_back(std::pow(raw[v], options.strength));
    sum += a * powers[v];
    area += a;
  }
  const double scale = sum > 0 ? area / sum : 1;
  VertexField field(all.size());
  for (std::size_t v = 0; v < powers.size(); ++v)
    field.values()[v] = static_cast<float>(std::max(scale * powers[v], kLeastWeight));
  return split(scene, field);
}

Importance product(const Importance& a, const Importance& b) {
  if (a.empty() || b.empty()) return a.empty() ? b : a;
  const auto refuse = [] { throw Error(ErrorKind::usage, "weights of different models are multiplied"); };
  if (a.size() != b.size()) refuse();
  Importance result = a;
  for (std::size_t m = 0; m < result.size(); ++m) {
    if (b[m].empty()) continue;
    if (result[m].empty()) {
      result[m] = b[m];
      continue;
    }
    if (result[m].size() != b[m].size()) refuse();
    for (std::size_t v = 0; v < result[m].size(); ++v) result[m].values()[v] *= b[m].values()[v];
  }
  return result;
}

}  // namespace fovea
