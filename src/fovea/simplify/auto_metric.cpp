#include "fovea/simplify/auto_metric.h"

#include <fmt/format.h>

#include <chrono>
#include <utility>

#include "fovea/base/error.h"
#include "fovea/simplify/auto_saliency.h"

namespace fovea {

AutoMetric choose_metric(const Model& model, const SimplifyOptions& options, const Importance& importance,
                         Context& context) {
  const auto start = std::chrono::steady_clock::now();
  AutoMetric result;
  MetricTrial& quadric = result.trials.emplace_back(MetricTrial{"quadric", options});
  quadric.options.metric = Metric::quadric;
  quadric.options.metric_from = std::nullopt;
  for (const double from : {2.0, 4.0, 16.0}) {
    MetricTrial& trial = result.trials.emplace_back(
        MetricTrial{fmt::format("image from {:g} times the target", from), options});
    trial.options.metric = Metric::image;
    trial.options.metric_from = from;
    trial.options.even_exposure = false;
  }
  MetricTrial even = result.trials[1];
  even.name = "image, hidden as near";
  even.options.even_exposure = true;
  result.trials.push_back(std::move(even));
  std::vector<Model> models;
  for (const MetricTrial& trial : result.trials) {
    context.advance_or_throw("choose metric",
                             static_cast<double>(models.size()) / static_cast<double>(result.trials.size()));
    SimplifyResult simplified = simplify(model, trial.options, importance, context);
    if (simplified.stop == StopReason::cancelled) throw Error(ErrorKind::cancelled, "cancelled");
    models.push_back(std::move(simplified.model));
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
