#include "fovea/simplify/auto_metric.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "fovea/simplify/auto_saliency.h"
#include "support/meshes.h"
#include "support/textured.h"

namespace fovea {
namespace {

TEST(AutoMetric, TakesTheTrialThatLooksBest) {
  const Model model = test::textured(test::shuffled(test::torus(48, 24)), 1);
  SimplifyOptions options;
  options.ratio = 0.1;
  options.view_size = 128;
  Context context;
  const AutoMetric found = choose_metric(model, options, {}, context);
  ASSERT_EQ(found.trials.size(), 5u);
  for (const MetricTrial& trial : found.trials) EXPECT_GE(trial.flip, found.trials[found.best].flip);
  // What is told is what the options give.
  const MetricTrial& best = found.trials[found.best];
  const Model again = simplify(model, best.options, {}, context).model;
  EXPECT_EQ(small_picture_flips(model, {&again, 1}, context)[0], best.flip);
}

TEST(AutoMetric, WhatWasSaidOfTheMetricDoesNotCount) {
  const Model model = test::model_of(test::torus(24, 12));
  SimplifyOptions options, other;
  options.triangles = other.triangles = 100;
  options.view_size = other.view_size = 64;
  other.metric = Metric::entropy;
  other.metric_from = 3;
  other.even_exposure = true;
  Context context;
  const AutoMetric a = choose_metric(model, options, {}, context),
                   b = choose_metric(model, other, {}, context);
  EXPECT_EQ(a.best, b.best);
  for (std::size_t i = 0; i < a.trials.size(); ++i) EXPECT_EQ(a.trials[i].flip, b.trials[i].flip);
}

TEST(AutoMetric, TriesLargePicturesWhereTheirSizeIsOpenAndTheyAreNotTooMany) {
  const Model model = test::model_of(test::torus(6, 3));
  SimplifyOptions options;
  options.triangles = 20;
  SimplifyOptions many = options;
  many.views = {.set = ViewSet::fibonacci, .count = 600};  // of 512² more pixels than a metric takes
  Context context;
  EXPECT_EQ(choose_metric(model, options, {}, context).trials.size(), 6u);
  EXPECT_EQ(choose_metric(model, many, {}, context).trials.size(), 5u);
}

}  // namespace
}  // namespace fovea
