#include "fovea/simplify/metric_stage.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <utility>
#include <vector>

#include "fovea/base/error.h"
#include "support/meshes.h"

namespace fovea {
namespace {

MetricStage stage(Metric metric, std::uint64_t target, std::uint64_t total) {
  SimplifyOptions options;
  options.metric = metric;
  return metric_stage(options, target, total);
}

TEST(MetricStage, AutomaticIsTheImageFromTwiceTheTargetOn) {
  const MetricStage found = stage(Metric::automatic, 1000, 10000);
  EXPECT_EQ(found.metric, Metric::image);
  EXPECT_EQ(found.from, 2000u);
  EXPECT_EQ(stage(Metric::automatic, 6000, 10000).from, 10000u) << "from the beginning";
}

TEST(MetricStage, AutomaticIsQuadricWherePicturesSayLittle) {
  EXPECT_EQ(stage(Metric::automatic, 0, 10000).metric, Metric::quadric) << "no count is asked for";
  EXPECT_EQ(stage(Metric::automatic, 12001, 100000).metric, Metric::quadric) << "a few pixels each";
  SimplifyOptions apart;
  apart.per_mesh = true;
  EXPECT_EQ(metric_stage(apart, 1000, 10000).metric, Metric::quadric);
}

TEST(MetricStage, EntropiesDecideFromTheBeginningUnlessTold) {
  EXPECT_EQ(stage(Metric::entropy, 1000, 10000).from, 10000u);
  SimplifyOptions options;
  options.metric = Metric::entropy;
  options.metric_from = 4;
  EXPECT_EQ(metric_stage(options, 1000, 10000).from, 4000u);
  EXPECT_EQ(metric_stage(options, 0, 10000).from, 10000u);
}

TEST(MetricStage, ViewsOfTheImageGrowWithTheTarget) {
  EXPECT_EQ(stage(Metric::image, 10, 10000).view_size, 64);
  EXPECT_EQ(stage(Metric::image, 420, 10000).view_size, 160);
  EXPECT_EQ(stage(Metric::image, 5000, 20000).view_size, 256);
  EXPECT_EQ(stage(Metric::image, 0, 10000).view_size, 256);
  EXPECT_EQ(stage(Metric::entropy, 10, 10000).view_size, 256) << "as its paper";
  SimplifyOptions options;
  options.view_size = 100;
  EXPECT_EQ(metric_stage(options, 10, 10000).view_size, 100);
}

TEST(MetricStage, CamerasMaySeeAPartAlone) {
  SimplifyOptions options;
  options.views.set = ViewSet::cameras;
  const MetricStage large = metric_stage(options, 20000, 100000);
  EXPECT_EQ(large.metric, Metric::image);
  EXPECT_EQ(large.from, 40000u);
  EXPECT_EQ(metric_stage(options, 1000, 100000).from, 12000u);
  EXPECT_EQ(metric_stage(options, 0, 100000).metric, Metric::quadric) << "no count is asked for";
}

// --- What it does --------------------------------------------------------------------------------------

SimplifyResult run_stages(const Model& model, const SimplifyOptions& options) {
  Context context;
  context.threads = 2;
  return simplify(model, options, {}, context);
}

/// A ball of 1280 triangles and the same at half its size inside.
Model ball_in_ball() { return test::model_of({test::icosphere(3), test::scaled(test::icosphere(3), 0.5f)}); }

TEST(MetricStage, TheRecordGoesOnFromQuadricsToViews) {
  const Model model = test::model_of(test::icosphere(4));
  SimplifyOptions options;
  options.ratio = 0.1;
  options.view_size = 64;
  const SimplifyResult result = run_stages(model, options);
  EXPECT_EQ(result.metric, Metric::image);
  EXPECT_EQ(result.metric_from, 1024u);
  EXPECT_EQ(result.stop, StopReason::target);
  EXPECT_LE(result.triangles_after, 512u);
  const TriMesh* const sources[] = {&model.meshes[0].surface};
  const auto level = replay(sources, result.record, result.record.steps.size());
  EXPECT_EQ(level[0].positions, result.model.meshes[0].surface.positions);
  EXPECT_TRUE(
      std::is_sorted(result.record.steps.begin(), result.record.steps.end(),
                     [](const CollapseStep& a, const CollapseStep& b) { return a.error_rel < b.error_rel; }));
  // The first part is that of quadrics by what is seen, which is half of a ball everywhere.
  options.metric = Metric::visibility;
  const SimplifyResult quadric = run_stages(model, options);
  std::size_t same = 0;
  while (same < quadric.record.steps.size() &&
         quadric.record.steps[same].removed == result.record.steps[same].removed)
    ++same;
  EXPECT_GE(quadric.record.triangles_before - quadric.record.steps[same - 1].faces_end, 1024u - 2u);
  EXPECT_LT(same, quadric.record.steps.size());
}

TEST(MetricStage, ByVisibilityWhatNoViewSeesGoesFirst) {
  SimplifyOptions options;
  options.metric = Metric::visibility;
  options.ratio = 0.6;
  const SimplifyResult result = run_stages(ball_in_ball(), options);
  EXPECT_EQ(result.metric, Metric::visibility);
  EXPECT_GE(result.model.meshes[0].surface.face_count(), 1200u) << "of 1280; the target is 1536";
}

/// The least and the largest weight of each mesh.
std::vector<std::pair<float, float>> weights(Metric metric, const Model& model, ViewSet set) {
  Context context;
  SimplifyOptions options;
  options.metric = metric;
  options.views.set = set;
  const MetricStage stage = metric_stage(options, 0, 0);
  const ViewedModel viewed = viewed_model(model, options.views, stage, context);
  std::vector<std::pair<float, float>> found;
  for (const VertexField& field : exposed_importance(model, viewed, options, stage, context)) {
    const auto [least, most] = std::ranges::minmax(field.values());
    found.emplace_back(least, most);
  }
  return found;
}

/// A camera at `eye` that looks along −z.
void add_camera(Model& model, Vec3d eye, double yfov_rad) {
  model.cameras.emplace_back().yfov_rad = yfov_rad;
  Node node;
  node.camera = static_cast<int>(model.cameras.size()) - 1;
  node.translation = eye;
  model.nodes.push_back(node);
  model.scenes[0].nodes.push_back(static_cast<int>(model.nodes.size()) - 1);
}

TEST(MetricStage, WhatIsSeenWeighsMore) {
  Model model = ball_in_ball();
  const auto image = weights(Metric::image, model, ViewSet::dodecahedron);
  EXPECT_FLOAT_EQ(image[1].first, 0.2f);
  EXPECT_FLOAT_EQ(image[1].second, 0.2f) << "hidden";
  EXPECT_GT(image[0].first, 0.8f) << "convex";
  EXPECT_LT(image[0].second, 1.2f);
  const auto visibility = weights(Metric::visibility, model, ViewSet::dodecahedron);
  EXPECT_FLOAT_EQ(visibility[1].second, 0.001f);
  EXPECT_FLOAT_EQ(visibility[0].first, image[0].first / 2);
  // A camera does not see the other side.
  add_camera(model, {0, 0, 5}, 0.5);
  const auto camera = weights(Metric::image, model, ViewSet::cameras);
  EXPECT_FLOAT_EQ(camera[0].first, 0.001f);
  EXPECT_FLOAT_EQ(camera[0].second, 1);
  EXPECT_FLOAT_EQ(camera[1].second, 0.001f);
}

TEST(MetricStage, TrianglesGoWhereACameraLooks) {
  // Two balls, one of them in the picture.
  Model model = test::model_of({test::icosphere(4), test::icosphere(4)});
  model.nodes[1].translation = Vec3d{10, 0, 0};
  add_camera(model, {10, 0, 5}, 0.6);
  SimplifyOptions options;
  options.ratio = 0.2;
  options.views.set = ViewSet::cameras;
  const SimplifyResult result = run_stages(model, options);
  EXPECT_EQ(result.stop, StopReason::target);
  EXPECT_GT(result.model.meshes[1].surface.face_count(), 0.8 * 2048) << "of a target of 2048";
  options.views.set = ViewSet::dodecahedron;
  EXPECT_LT(run_stages(model, options).model.meshes[1].surface.face_count(), 0.6 * 2048);
}

TEST(MetricStage, EvenExposureIsQuadricsAloneAtFirst) {
  SimplifyOptions options;
  options.ratio = 0.3;
  options.metric_from = 2;
  options.even_exposure = true;
  const Model model = ball_in_ball();
  const SimplifyResult even = run_stages(model, options);
  EXPECT_EQ(even.metric, Metric::image);
  options.metric = Metric::quadric;
  options.metric_from.reset();
  options.ratio = 0.61;
  const SimplifyResult quadric = run_stages(model, options);
  ASSERT_GT(quadric.record.steps.size(), 200u);
  for (std::size_t i = 0; i < quadric.record.steps.size(); ++i)
    EXPECT_EQ(even.record.steps[i].removed, quadric.record.steps[i].removed) << i;
}

TEST(MetricStage, HiddenTrianglesAreDroppedFirstAndTheRecordSaysSo) {
  const Model model = ball_in_ball();
  SimplifyOptions options;
  options.metric = Metric::quadric;
  options.ratio = 0.3;
  options.cull_hidden = true;
  const SimplifyResult result = run_stages(model, options);
  EXPECT_EQ(result.triangles_hidden, 1280u);
  EXPECT_EQ(result.model.meshes[1].surface.face_count(), 0u);
  EXPECT_LE(result.triangles_after, 768u);
  EXPECT_GT(result.triangles_after, 700u);
  ASSERT_FALSE(result.record.steps.empty());
  EXPECT_EQ(result.record.steps[0].kind, StepKind::vanish);
  EXPECT_EQ(result.record.steps[0].mesh, 1u);
  EXPECT_EQ(result.record.triangles_after(1), 1280u);
  const TriMesh* const sources[] = {&model.meshes[0].surface, &model.meshes[1].surface};
  const auto level = replay(sources, result.record, result.record.steps.size());
  EXPECT_EQ(level[0].positions, result.model.meshes[0].surface.positions);
}

TEST(MetricStage, HiddenTrianglesAreDroppedWhateverDecides) {
  for (const Metric metric : {Metric::image, Metric::visibility, Metric::entropy}) {
    SimplifyOptions options;
    options.metric = metric;
    options.ratio = 0.2;
    options.view_size = 48;
    options.cull_hidden = true;
    const SimplifyResult result = run_stages(ball_in_ball(), options);
    EXPECT_EQ(result.triangles_hidden, 1280u);
    EXPECT_EQ(result.stop, StopReason::target) << to_string(metric);
  }
}

TEST(MetricStage, AModelOfWhichNothingIsSeenIsRefused) {
  Model model = test::model_of(test::grid(2, 2));
  add_camera(model, {0, 0, -5}, 0.8);  // behind the sheet
  SimplifyOptions options;
  options.ratio = 0.5;
  options.cull_hidden = true;
  options.views.set = ViewSet::cameras;
  EXPECT_THROW(run_stages(model, options), Error);
}

}  // namespace
}  // namespace fovea
