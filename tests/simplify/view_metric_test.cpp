#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "fovea/base/error.h"
#include "fovea/judge/compare.h"
#include "fovea/sample/sample.h"
#include "fovea/simplify/simplify.h"
#include "support/meshes.h"

namespace fovea {
namespace {

constexpr Metric kViewMetrics[] = {Metric::image, Metric::entropy, Metric::polygon_entropy};

SimplifyResult run_by(const Model& model, const SimplifyOptions& options, const Importance& importance = {},
                      int threads = 2) {
  Context context;
  context.threads = threads;
  SimplifyResult result = simplify(model, options, importance, context);
  for (const Mesh& mesh : result.model.meshes) check(mesh.surface);
  return result;
}

SimplifyOptions by(Metric metric, double ratio) {
  SimplifyOptions options;
  options.metric = metric;
  options.ratio = ratio;
  options.views.set = ViewSet::octahedron;
  options.view_size = 64;
  options.regions.most_texels = 128 * 128;
  return options;
}

Model sample(const std::string& name, double detail) {
  Context context;
  return make_sample(name, detail, context);
}

TEST(ViewMetric, EveryMetricReachesItsTargetInItsOwnWay) {
  const Model vase = sample("vase", 0.02);
  std::vector<std::vector<Vec3f>> found{
      run_by(vase, by(Metric::quadric, 0.3)).model.meshes[0].surface.positions};
  for (const Metric metric : kViewMetrics) {
    for (const Placement placement : {Placement::optimal, Placement::half_edge}) {
      SimplifyOptions options = by(metric, 0.3);
      options.placement = placement;
      const SimplifyResult result = run_by(vase, options);
      EXPECT_EQ(result.stop, StopReason::target);
      EXPECT_LE(result.triangles_after, result.triangles_target);
      EXPECT_GT(result.error_rel, 0);
      EXPECT_EQ(std::count(found.begin(), found.end(), result.model.meshes[0].surface.positions), 0);
      found.push_back(result.model.meshes[0].surface.positions);
    }
  }
}

TEST(ViewMetric, IsTheSameForAnyNumberOfThreads) {
  const Model arm = sample("arm", 0.02);
  for (const Metric metric : kViewMetrics) {
    const SimplifyResult one = run_by(arm, by(metric, 0.3), {}, 1), two = run_by(arm, by(metric, 0.3), {}, 2);
    EXPECT_EQ(one.model.meshes[0].surface.positions, two.model.meshes[0].surface.positions);
    EXPECT_EQ(one.model.meshes[0].surface.triangles, two.model.meshes[0].surface.triangles);
  }
}

TEST(ViewMetric, WhatNoViewSeesGoesFirst) {
  const auto share_outside = [](Metric metric) {
    const SimplifyResult result = run_by(
        test::model_of({test::icosphere(3), test::scaled(test::icosphere(3), 0.5f)}), by(metric, 0.55));
    return static_cast<double>(result.model.meshes[0].surface.face_count()) /
           static_cast<double>(result.triangles_after);
  };
  // 1408 triangles are left. By quadrics the larger ball has more of them, as it bulges more; by entropy all
  // of its 1280.
  EXPECT_LT(share_outside(Metric::quadric), 0.8);
  EXPECT_GT(share_outside(Metric::polygon_entropy), 0.9);
}

TEST(ViewMetric, ImportanceMultipliesWhatIsLost) {
  // A wavy sheet, of which one half matters a thousand times as much.
  const Model model = test::model_of(test::wavy_grid(30, 30, 0.05));
  const TriMesh& before = model.meshes[0].surface;
  VertexField field(before.vertex_count(), 1.0f);
  for (std::size_t v = 0; v < before.vertex_count(); ++v) {
    if (before.positions[v].x > 0.5f) field.values()[v] = 1000;
  }
  const auto in_right_half = [](const TriMesh& mesh) {
    return std::count_if(mesh.triangles.begin(), mesh.triangles.end(), [&](const auto& t) {
      float x = 0;
      for (const VertexId v : t) x += mesh.positions[v.index()].x / 3;
      return x > 0.5f;
    });
  };
  const auto with = in_right_half(run_by(model, by(Metric::image, 0.3), {field}).model.meshes[0].surface);
  const auto without = in_right_half(run_by(model, by(Metric::image, 0.3)).model.meshes[0].surface);
  EXPECT_GT(with, without + without / 4);
}

TEST(ViewMetric, PicturesAreNearerThanByQuadrics) {
  const Model vase = sample("vase", 0.05);
  SimplifyOptions options = by(Metric::image, 0.1);
  options.views.set = ViewSet::dodecahedron;
  options.view_size = 128;
  const SimplifyResult ours = run_by(vase, options), quadric = run_by(vase, by(Metric::quadric, 0.1));
  CompareOptions judge;
  judge.size = 128;
  judge.distance_samples = 0;
  judge.views.set = ViewSet::fibonacci;  // none of the views that it looked at
  judge.views.count = 11;
  Context context;
  const Model* const tests[] = {&ours.model, &quadric.model};
  const std::vector<Comparison> found = compare(vase, tests, judge, context);
  for (std::size_t pass = 0; pass < 2; ++pass)
    EXPECT_GT(found[0].passes[pass].psnr, found[1].passes[pass].psnr + 0.5) << pass;
}

TEST(ViewMetric, AModelThatNothingShowsIsSimplifiedByQuadrics) {
  Model model = test::model_of(test::icosphere(3));
  model.nodes.clear();
  model.scenes.clear();
  model.default_scene = -1;
  EXPECT_EQ(run_by(model, by(Metric::image, 0.5)).stop, StopReason::target);
}

TEST(ViewMetric, RefusesViewsThatCannotBe) {
  const Model model = test::model_of(test::icosphere(1));
  SimplifyOptions cameras = by(Metric::image, 0.5);
  cameras.views.set = ViewSet::cameras;
  EXPECT_THROW(run_by(model, cameras), Error);
  SimplifyOptions many = by(Metric::image, 0.5);
  many.views.set = ViewSet::fibonacci;
  many.views.count = 4096;
  many.view_size = 2048;
  EXPECT_THROW(run_by(model, many), Error);
}

}  // namespace
}  // namespace fovea
