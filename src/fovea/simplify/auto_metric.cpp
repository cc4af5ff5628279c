#include "fovea/simplify/auto_metric.h"

#include <fmt/format.h>

#include <chrono>
#include <utility>

#include "fovea/base/error.h"
#include "fovea/simplify/auto_saliency.h"

namespace fovea {

namespace {

constexpr int kLargeView = 512;

std::vector<MetricTrial> metric_trials(const SimplifyOptions& options) {
  std::vector<MetricTrial> trials{{"quadric", options}};
  trials[0].options.metric = Metric::quadric;
  trials[0].options.metric_from = std::nullopt;
  const auto add_image = [&](std::string name, double from) -> SimplifyOptions& {
    MetricTrial& trial = trials.emplace_back(MetricTrial{std::move(name), options});
    trial.options.metric = Metric::image;
    trial.options.metric_from = from;
    trial.options.even_exposure = false;
    return trial.options;
  };
  for (const double from : {2.0, 4.0, 16.0})
    add_image(fmt::format("image from {:g} times the target", from), from);
  add_image("image, hidden as near", 2).even_exposure = true;
  if (!options.view_size) {
    add_image(fmt::format("image from 4 times the target, views of {}", kLargeView), 4).view_size =
        kLargeView;
  }
  return trials;
}

}  // namespace

AutoMetric choose_metric(const Model& model, const SimplifyOptions& options, const Importance& importance,
                         Context& context) {
  const auto start = std::chrono::steady_clock::now();
  AutoMetric result;
  std::vector<Model> models;
  const std::vector<MetricTrial> trials = metric_trials(options);
  for (std::size_t i = 0; i < trials.size(); ++i) {
    context.advance_or_throw("choose metric", static_cast<double>(i) / static_cast<double>(trials.size()));
    try {
      SimplifyResult simplified = simplify(model, trials[i].options, importance, context);
      if (simplified.stop == StopReason::cancelled) throw Error(ErrorKind::cancelled, "cancelled");
      models.push_back(std::move(simplified.model));
      result.trials.push_back(trials[i]);
    } catch (const Error& error) {
      // What is too much in large pictures may do in others.
      const bool is_large = trials[i].options.view_size != options.view_size;
      if (!is_large || error.kind() != ErrorKind::limit) throw;
    }
  }
  const std::vector<double> flips = small_picture_flips(model, models, context);
  for (std::size_t i = 0; i < flips.size(); ++i) {
    result.trials[i].flip = flips[i];
    if (flips[i] < result.trials[result.best].flip) result.best = i;
  }
  result.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return result;
}

}  // namespace fovea
