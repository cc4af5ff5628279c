#include "fovea/simplify/metric_stage.h"

#include <gtest/gtest.h>

#include <algorithm>

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
  // The first part is that of quadrics alone.
  options.metric = Metric::quadric;
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
  Camera camera;
  model.cameras.push_back(camera);
  Node node;
  node.camera = 0;
  node.translation = Vec3d{0, 0, -5};  // behind the sheet
  model.nodes.push_back(node);
  model.scenes[0].nodes.push_back(1);
  SimplifyOptions options;
  options.ratio = 0.5;
  options.cull_hidden = true;
  options.views.set = ViewSet::cameras;
  EXPECT_THROW(run_stages(model, options), Error);
}

}  // namespace
}  // namespace fovea
