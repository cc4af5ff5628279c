#include "fovea/simplify/auto_saliency.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>

#include "fovea/judge/compare.h"
#include "fovea/saliency/contrast.h"
#include "fovea/surface/scene_surface.h"

namespace fovea {

namespace {

/// The maps that trials are mixed from, on the scene.
class Mixer {
 public:
  Mixer(const Model& model, SaliencyOptions options, Context& context)
      : scene_(scene_surface(model, rest_pose(model))), adjacency_(scene_.surface, context) {
    options.preset = SaliencyPreset::yang;
    options.distance = DistanceKind::diffusion;  // the same ranks in a fraction of the time
    options.geometry = options.texture = 0.5;
    options.visibility = 1;
    const ModelSaliency found = model_saliency(model, options, context);
    textured_ = found.textured;
    for (const SaliencyMap& map : found.maps) {
      if (map.name == "geometry") geometry_ = promoted(map);
      if (map.name == "texture-color") color_ = joined(map.fields);
      if (map.name == "texture-entropy") entropy_ = joined(map.fields);
      if (map.name == "visibility") visibility_ = promoted(map);
    }
  }

  bool textured() const { return textured_; }

  /// 0 … 1, per mesh.
  std::vector<VertexField> mix(const SaliencyTrial& trial) const {
    VertexField sum(scene_.surface.positions.size());
    add(sum, geometry_, trial.geometry);
    add(sum, visibility_, trial.visibility);
    if (const double texture = trial.color + trial.entropy; textured_ && texture > 0) {
      VertexField both(sum.size());
      add(both, color_, trial.color / texture);
      add(both, entropy_, trial.entropy / texture);
      add(sum, promote_peaks(both, adjacency_), texture);
    }
    float high = 0;
    for (const float x : sum.values()) high = std::max(high, x);
    for (float& x : sum.values()) x = high > 0 ? x / high : 0.0f;
    return split(scene_, sum);
  }

 private:
  VertexField promoted(const SaliencyMap& map) const { return promote_peaks(joined(map.fields), adjacency_); }

  static void add(VertexField& sum, const VertexField& field, double weight) {
    if (field.empty() || weight == 0) return;
    for (std::size_t v = 0; v < sum.size(); ++v)
      sum.values()[v] += static_cast<float>(weight) * field.values()[v];
  }

  SceneSurface scene_;
  Adjacency adjacency_;
  bool textured_ = false;
  VertexField geometry_, color_, entropy_, visibility_;
};

std::string name_of(const SaliencyTrial& t) {
  if (t.strength == 0) return "none";
  std::string name;
  for (const auto& [part, weight] : {std::pair{"geometry", t.geometry},
                                     {"color", t.color},
                                     {"entropy", t.entropy},
                                     {"visibility", t.visibility}}) {
    if (weight > 0) name += fmt::format("{} {:g}, ", part, weight);
  }
  return name + fmt::format("strength {:g}", t.strength);
}

/// Tries weights, a few together so that the original is drawn once for them.
class Trials {
 public:
  Trials(const Model& model, const SimplifyOptions& options, const Importance& importance,
         const SaliencyOptions& saliency, Context& context)
      : model_(model),
        options_(options),
        importance_(importance),
        context_(context),
        mixer_(model, saliency, context) {}

  AutoSaliency run() {
    const auto start = std::chrono::steady_clock::now();
    std::vector<SaliencyTrial> signals(2);
    signals[1].geometry = 1;
    if (mixer_.textured()) {
      signals.push_back({"", 0.5, 0.25, 0.25});
      signals.push_back({"", 0, 0.5, 0.5});
    }
    signals.push_back({"", 0, 0, 0, 1});
    for (std::size_t i = 1; i < signals.size(); ++i) signals[i].strength = 1;
    attempt(std::move(signals), 0.1, 0.6);
    if (const SaliencyTrial& best = result_.trials[result_.best]; best.color > 0) {
      SaliencyTrial color = best, entropy = best;
      color.color = entropy.entropy = best.color + best.entropy;
      color.entropy = entropy.color = 0;
      attempt({color, entropy}, 0.6, 0.8);
    }
    if (const SaliencyTrial& best = result_.trials[result_.best]; best.strength > 0) {
      SaliencyTrial gentle = best, strong = best;
      gentle.strength = 0.5;
      strong.strength = 2;
      attempt({gentle, strong}, 0.8, 1);
    }
    result_.importance = importance_of(result_.trials[result_.best]);
    result_.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    return std::move(result_);
  }

 private:
  Importance importance_of(const SaliencyTrial& trial) const {
    if (trial.strength == 0) return importance_;
    return product(importance_, salient_importance(model_, mixer_.mix(trial),
                                                   {SaliencyWeighting::yang, trial.strength}, context_));
  }

  void attempt(std::vector<SaliencyTrial> trials, double from, double to) {
    std::vector<Model> models;
    for (SaliencyTrial& trial : trials) {
      context_.advance_or_throw("choose saliency", from + (to - from) * static_cast<double>(models.size()) /
                                                              static_cast<double>(trials.size()));
      trial.name = name_of(trial);
      models.push_back(simplify(model_, options_, importance_of(trial), context_).model);
    }
    const std::vector<double> flips = small_picture_flips(model_, models, context_);
    for (std::size_t i = 0; i < trials.size(); ++i) {
      trials[i].flip = flips[i];
      result_.trials.push_back(trials[i]);
      if (trials[i].flip < result_.trials[result_.best].flip) result_.best = result_.trials.size() - 1;
    }
  }

  const Model& model_;
  const SimplifyOptions& options_;
  const Importance& importance_;
  Context& context_;
  Mixer mixer_;
  AutoSaliency result_;
};

}  // namespace

std::vector<double> small_picture_flips(const Model& original, std::span<const Model> tests,
                                        Context& context) {
  std::vector<const Model*> pointers;
  for (const Model& model : tests) pointers.push_back(&model);
  CompareOptions options;
  options.size = 192;
  options.views.set = ViewSet::icosahedron;
  options.distance_samples = 0;
  std::vector<double> flips;
  for (const Comparison& found : compare(original, pointers, options, context)) {
    flips.push_back((found[JudgedPass::base_color].flip_foreground + found[JudgedPass::lit].flip_foreground) /
                    2);
  }
  return flips;
}

AutoSaliency choose_saliency(const Model& model, const SimplifyOptions& options, const Importance& importance,
                             const SaliencyOptions& saliency, Context& context) {
  return Trials(model, options, importance, saliency, context).run();
}

}  // namespace fovea
