#include "fovea/judge/compare.h"

#include <gtest/gtest.h>

#include <cmath>

#include "fovea/base/error.h"
#include "fovea/simplify/simplify.h"
#include "support/by_quadrics.h"
#include "support/meshes.h"

namespace fovea {
namespace {

CompareOptions quick() {
  CompareOptions options;
  options.views.set = ViewSet::octahedron;
  options.size = 96;
  options.distance_samples = 500;
  return options;
}

Model simplified(const Model& model, double ratio) {
  SimplifyOptions options = test::by_quadrics();
  options.ratio = ratio;
  Context context;
  return simplify(model, options, {}, context).model;
}

std::vector<Comparison> compared(const Model& reference, std::vector<const Model*> tests,
                                 const CompareOptions& options = quick()) {
  Context context;
  return compare(reference, tests, options, context);
}

TEST(Compare, AModelIsLikeItself) {
  const Model model = test::model_of(test::torus(32, 16));
  const Comparison same = compared(model, {&model})[0];
  ASSERT_EQ(same.views.size(), 6u);
  for (const JudgedPass pass : kJudgedPasses) {
    EXPECT_EQ(same[pass].flip, 0);
    EXPECT_EQ(same[pass].mse, 0);
    EXPECT_EQ(same[pass].psnr, INFINITY);
    EXPECT_NEAR(same[pass].ms_ssim, 1, 1e-6);
  }
  EXPECT_NEAR(same.silhouette_iou, 1, 1e-12);
  EXPECT_LT(same.distance->hausdorff(), 1e-6);
}

TEST(Compare, FewerTrianglesAreLessLikeIt) {
  const Model model = test::model_of(test::icosphere(4));
  const Model half = simplified(model, 0.3), few = simplified(model, 0.03), none = simplified(model, 0.005);
  const auto found = compared(model, {&half, &few, &none});
  for (std::size_t i = 1; i < found.size(); ++i) {
    const ImageScores &better = found[i - 1][JudgedPass::lit], &worse = found[i][JudgedPass::lit];
    EXPECT_LT(better.flip, worse.flip);
    EXPECT_GT(better.ms_ssim, worse.ms_ssim);
    EXPECT_GT(better.psnr, worse.psnr);
    EXPECT_GT(found[i - 1].silhouette_iou, found[i].silhouette_iou);
    EXPECT_LT(found[i - 1].distance->mean(), found[i].distance->mean());
  }
}

TEST(Compare, ScoresOfAllViewsAreTheirMeans) {
  const Model model = test::model_of(test::torus(32, 16)), small = simplified(model, 0.1);
  const Comparison c = compared(model, {&small})[0];
  double flip = 0, mse = 0;
  for (const ViewComparison& view : c.views) {
    flip += view.passes[1].flip / 6;
    mse += view.passes[1].mse / 6;
  }
  EXPECT_NEAR(c[JudgedPass::lit].flip, flip, 1e-12);
  EXPECT_NEAR(c[JudgedPass::lit].psnr, 10 * std::log10(255 * 255 / mse), 1e-9);
}

TEST(Compare, TheForegroundDoesNotDependOnTheMargin) {
  const Model model = test::model_of(test::icosphere(3)), small = simplified(model, 0.1);
  CompareOptions wide = quick();
  wide.views.margin = 1;  // the model takes a quarter of the picture
  wide.size = 192;
  const ImageScores tight = compared(model, {&small})[0][JudgedPass::lit],
                    loose = compared(model, {&small}, wide)[0][JudgedPass::lit];
  EXPECT_LT(loose.mse, 0.4 * tight.mse);
  EXPECT_NEAR(loose.mse_foreground, tight.mse_foreground, 0.15 * tight.mse_foreground);
}

TEST(Compare, PicturesOfACameraAreAsWideAsWhatItSees) {
  Model model = test::model_of(test::icosphere(2));
  model.cameras.emplace_back().aspect = 2;
  Node node;
  node.camera = 0;
  node.translation = {0, 0, 3};
  model.nodes.push_back(node);
  CompareOptions options = quick();
  options.views.set = ViewSet::cameras;
  options.size = 40;
  std::vector<std::array<int, 2>> sizes;
  CompareObserver observer;
  observer.pictures = [&](std::size_t, std::size_t, JudgedPass, const Picture& reference, const Picture& test,
                          const Plane& flip) {
    EXPECT_EQ(test.color.width, reference.color.width);
    EXPECT_EQ(flip.width, reference.color.width);
    sizes.push_back({reference.color.width, reference.color.height});
  };
  observer.distances = [&](std::size_t, std::size_t, const Picture& heat) {
    sizes.push_back({heat.color.width, heat.color.height});
  };
  const Model* const tests[] = {&model};
  Context context;
  compare(model, tests, options, context, observer);
  EXPECT_EQ(sizes, (std::vector<std::array<int, 2>>(3, {80, 40})));
}

TEST(Compare, TheSameForAnyThreads) {
  const Model model = test::model_of(test::torus(24, 12)), small = simplified(model, 0.2);
  Context one, three;
  one.threads = 1;
  three.threads = 3;
  const Model* const tests[] = {&small};
  const Comparison a = compare(model, tests, quick(), one)[0], b = compare(model, tests, quick(), three)[0];
  EXPECT_EQ(a[JudgedPass::lit].flip, b[JudgedPass::lit].flip);
  EXPECT_EQ(a[JudgedPass::base_color].ms_ssim, b[JudgedPass::base_color].ms_ssim);
  EXPECT_EQ(a.distance->forward.mean, b.distance->forward.mean);
}

TEST(Compare, AnEmptyModelIsNothingLikeIt) {
  const Model model = test::model_of(test::icosphere(2)), empty = test::model_of(test::empty_mesh());
  const Comparison c = compared(model, {&empty})[0];
  EXPECT_EQ(c.silhouette_iou, 0);
  EXPECT_EQ(c.distance->hausdorff(), INFINITY);
  EXPECT_THROW(compared(empty, {&model}), Error);
}

TEST(Compare, AnimationsAreComparedInTheirPose) {
  // The second model has lost its joints' turn: alike at rest, not in the pose.
  Model model = test::skinned_model(16), stiff = model;
  AnimationSampler sampler;
  sampler.input = Accessor::from_floats({0, 1}, 1);
  sampler.output = Accessor::from_floats({0, 0, 0, 1, 0, 0, 0.7071068f, 0.7071068f}, 4);
  Animation turn;
  turn.samplers = {sampler};
  turn.channels = {{0, 2, "rotation", {}}};
  model.animations = {turn};
  turn.channels.clear();
  stiff.animations = {turn};
  Context context;
  const Model* const tests[] = {&stiff};
  EXPECT_EQ(compare(model, tests, quick(), context)[0][JudgedPass::lit].flip, 0);
  CompareOptions options = quick();
  options.pose = {0, 1};
  EXPECT_GT(compare(model, tests, options, context)[0][JudgedPass::lit].flip, 0);
  options.pose = {5, 0};
  EXPECT_THROW(compare(model, tests, options, context), Error) << "it has no such animation";
  options.pose = {std::nullopt, 1};
  EXPECT_THROW(compare(model, tests, options, context), Error) << "a time of no animation";
}

}  // namespace
}  // namespace fovea
