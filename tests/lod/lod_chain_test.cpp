#include "fovea/lod/lod_chain.h"

#include <gtest/gtest.h>

#include <string>

#include "fovea/base/error.h"
#include "fovea/base/random.h"
#include "fovea/io/image_codec.h"
#include "fovea/io/read.h"
#include "fovea/judge/surface_distance.h"
#include "fovea/sample/sample.h"
#include "fovea/surface/pose.h"
#include "lod_chains.h"
#include "support/meshes.h"
#include "support/reading.h"
#include "support/textured.h"

namespace fovea {
namespace {

using test::quick_chain;

LodChain chain_of(const Model& model, const LodChainOptions& options, Context& context) {
  return make_lod_chain(model, options, {}, context);
}
LodChain chain_of(const Model& model, const LodChainOptions& options) {
  Context context;
  return chain_of(model, options, context);
}

void expect_same(const Model& a, const Model& b, const std::string& name) {
  ASSERT_EQ(a.meshes.size(), b.meshes.size());
  for (std::size_t m = 0; m < a.meshes.size(); ++m) {
    EXPECT_EQ(a.meshes[m].surface.positions, b.meshes[m].surface.positions) << name;
    EXPECT_EQ(a.meshes[m].surface.triangles, b.meshes[m].surface.triangles) << name;
  }
}

Model simplified(const Model& model, Metric metric, std::int64_t triangles) {
  SimplifyOptions options;
  options.metric = metric;
  options.triangles = triangles;
  Context context;
  return simplify(model, options, {}, context).model;
}

TEST(LodChain, CountsFollowFromTheRatio) {
  const Model model = test::model_of(test::icosphere(3));  // 1280
  const LodChain chain = chain_of(model, quick_chain());
  ASSERT_EQ(chain.levels.size(), 4U);
  EXPECT_TRUE(chain.reached);
  const std::uint64_t expected[] = {1280, 640, 320, 160};
  for (std::size_t i = 0; i < 4; ++i) EXPECT_EQ(chain.levels[i].triangles, expected[i]);
  expect_same(chain.levels[0].model, model, "level 0");
  EXPECT_NEAR(chain.sphere.radius, 1, 1e-5);
}

TEST(LodChain, EveryLevelIsWhatSimplifyingToItGives) {
  const Model model = test::model_of({test::torus(24, 16), test::wavy_grid(16, 16, 0.2)});
  LodChainOptions options = quick_chain();
  options.triangles = {700, 311, 90};
  const LodChain chain = chain_of(model, options);
  ASSERT_EQ(chain.levels.size(), 4U);
  for (std::size_t i = 1; i < 4; ++i) {
    expect_same(chain.levels[i].model, simplified(model, Metric::quadric, options.triangles[i - 1]),
                std::to_string(i));
  }
}

TEST(LodChain, PicturesDecideAboutTheCoarsestLevelAlone) {
  const Model model = test::model_of(test::wavy_grid(24, 24, 0.2));
  LodChainOptions options = quick_chain();
  options.simplify.metric = Metric::automatic;
  options.triangles = {500, 150, 100};
  const LodChain chain = chain_of(model, options);
  ASSERT_EQ(chain.levels.size(), 4U);
  EXPECT_EQ(chain.metric, Metric::image);
  EXPECT_EQ(chain.metric_from, 150U) << "not from 200 on, as for that target alone";
  for (std::size_t i = 1; i < 3; ++i)
    expect_same(chain.levels[i].model, simplified(model, Metric::quadric, options.triangles[i - 1]),
                "quadric");
}

TEST(LodChain, TrianglesFallAndErrorsRise) {
  for (const Model& model :
       {test::model_of(test::icosphere(3)), test::model_of(test::torus(32, 16)), test::skinned_model(64),
        test::model_of(test::wavy_grid(20, 20, 0.3)), test::model_of(test::morph_strip(60))}) {
    LodChainOptions options = quick_chain();
    options.levels = 7;
    const LodChain chain = chain_of(model, options);
    ASSERT_GE(chain.levels.size(), 2U);
    for (std::size_t i = 1; i < chain.levels.size(); ++i) {
      const LodLevel &level = chain.levels[i], &before = chain.levels[i - 1];
      EXPECT_LT(level.triangles, before.triangles);
      if (i > 1) {
        EXPECT_GT(level.error.max, before.error.max);
        EXPECT_GT(level.distance, before.distance);
        EXPECT_LT(level.coverage, before.coverage);
      }
      EXPECT_LE(level.error.mean, level.error.max);
      EXPECT_EQ(level.triangles, counts(level.model).triangles);
    }
  }
}

TEST(LodChain, LevelsOfCountsComeInWhereTheirErrorIsAPixel) {
  LodChainOptions options = quick_chain();
  options.screen.pixel_error = 2;
  const LodChain chain = chain_of(test::model_of(test::icosphere(3)), options);
  for (std::size_t i = 1; i < chain.levels.size(); ++i) {
    const LodLevel& level = chain.levels[i];
    EXPECT_NEAR(level.pixels, 2, 1e-9);
    EXPECT_NEAR(level.distance, switch_distance(level.error.max, chain.sphere.radius, options.screen), 1e-12);
    EXPECT_NEAR(level.coverage, coverage_at(level.distance, chain.sphere.radius, options.screen), 1e-12);
  }
}

TEST(LodChain, LevelsOfTheScreenAreAsSimpleAsItAllows) {
  const Model model = test::model_of(test::torus(64, 32));
  LodChainOptions options = quick_chain();
  options.distance_samples = 50000;
  options.coverages = {0.5, 0.2, 0.05};
  const LodChain chain = chain_of(model, options);
  ASSERT_EQ(chain.levels.size(), 4U);
  for (std::size_t i = 1; i < 4; ++i) {
    const LodLevel& level = chain.levels[i];
    EXPECT_NEAR(level.coverage, options.coverages[i - 1], 1e-12);
    EXPECT_LE(level.pixels, 1);
    // With a fifth fewer triangles it would be too far off.
    const Model simpler =
        simplified(model, Metric::quadric, static_cast<std::int64_t>(level.triangles * 4 / 5));
    Context context;
    const SurfaceDistance distance = surface_distance(surface_of(model.meshes[0].surface),
                                                      surface_of(simpler.meshes[0].surface), 50000, context);
    EXPECT_GT(pixels_at(level.distance, distance.hausdorff(), chain.sphere.radius, options.screen), 1) << i;
  }
  LodChainOptions same = quick_chain();
  for (const LodLevel& level : chain.levels)
    if (level.distance > 0) same.distances.push_back(level.distance);
  const LodChain again = chain_of(model, same);
  ASSERT_EQ(again.levels.size(), 4U);
  for (std::size_t i = 1; i < 4; ++i) EXPECT_EQ(again.levels[i].triangles, chain.levels[i].triangles);
}

TEST(LodChain, WhatIsNoFartherThanTheNextIsLeftOut) {
  Context context;
  LodChainOptions options = quick_chain();
  options.simplify.placement = Placement::half_edge;
  // Flat: all levels are as near as the original.
  const LodChain chain = chain_of(test::model_of(test::grid(16, 16)), options, context);
  ASSERT_EQ(chain.levels.size(), 2U);
  EXPECT_LE(chain.levels[1].triangles, 64U);
  EXPECT_EQ(test::told(context, "lod-not-nearer"), 2U);
}

TEST(LodChain, WhatCannotBeReachedIsToldOnce) {
  LodChainOptions options = quick_chain();
  options.simplify.lock_boundary = true;
  options.triangles = {300, 10, 4, 2};
  Context context;
  const LodChain chain = chain_of(test::model_of(test::wavy_grid(16, 16, 0.2)), options, context);
  EXPECT_FALSE(chain.reached);
  EXPECT_EQ(chain.levels.size(), 3U);
  EXPECT_EQ(test::told(context, "lod-not-fewer"), 2U);
}

Surface posed(const Model& model, const Pose& pose) {
  Surface all;
  for (const Instance& instance : instances(model, pose))
    append(all, model.meshes[instance.mesh].surface, posed_surface(model, pose, instance).positions);
  return all;
}

/// At so many moments of all animations that nobody has chosen, but for `slack` that comes of samples.
void expect_errors_hold(const Model& model, const LodChain& chain, int moments, double slack,
                        const std::string& name) {
  Random random(1);
  for (int i = 0; i < moments; ++i) {
    const std::size_t animation = random.below(static_cast<std::uint32_t>(model.animations.size()));
    const double time = random.uniform() * duration_s(model.animations[animation]);
    const Pose pose = pose_at(model, animation, time);
    const Surface original = posed(model, pose);
    for (std::size_t l = 1; l < chain.levels.size(); ++l) {
      const LodLevel& level = chain.levels[l];
      Context context;
      const double error = surface_distance(original, posed(level.model, pose), 2000, context).hausdorff();
      EXPECT_LE(error, (1 + slack) * level.error.max + 1e-6)
          << name << ", level " << l << ", animation " << animation << " at " << time;
    }
  }
}

TEST(LodChain, ErrorsHoldInAllPoses) {
  const Model strip = test::skinned_model(64);
  expect_errors_hold(strip, chain_of(strip, quick_chain()), 20, 0.05, "strip");
  Context context;
  const Model arm = make_sample("arm", 0.1, context);
  expect_errors_hold(arm, chain_of(arm, quick_chain()), 20, 0.05, "arm");
}

TEST(LodChain, ErrorsHoldWhileRealModelsMove) {
  for (const char* name : {"CesiumMan", "Fox", "KayKitKnight", "RiggedFigure", "RecursiveSkeletons"}) {
    const auto path = test::corpus_file(std::string("animated/") + name + ".glb");
    if (!path) GTEST_SKIP() << "FOVEA_DATA is not set";
    Context context;
    const Model model = read_model(*path, {}, context);
    expect_errors_hold(model, chain_of(model, quick_chain()), 40, 0, name);
  }
}

TEST(LodChain, WhatIsSimpleEnoughForTheScreenIsSoInAllPoses) {
  const Model model = test::skinned_model(64);
  LodChainOptions options = quick_chain();
  options.coverages = {0.5, 0.1};
  options.screen.height = 200;
  const LodChain chain = chain_of(model, options);
  ASSERT_GE(chain.levels.size(), 2U);
  for (std::size_t l = 1; l < chain.levels.size(); ++l) EXPECT_LE(chain.levels[l].pixels, 1);
  expect_errors_hold(model, chain, 20, 0.05, "strip");
}

TEST(LodChain, WithoutKeyPosesErrorsAreThoseAtRest) {
  const Model model = test::skinned_model(64);
  LodChainOptions options = quick_chain();
  const LodChain moved = chain_of(model, options);
  options.key_poses = 0;
  const LodChain rest = chain_of(model, options);
  Context context;
  const Pose pose = rest_pose(model);
  ASSERT_GE(rest.levels.size(), 2U);
  for (std::size_t l = 1; l < rest.levels.size(); ++l) {
    EXPECT_LE(rest.levels[l].error.max, moved.levels[l].error.max);
    const SurfaceDistance distance =
        surface_distance(posed(model, pose), posed(rest.levels[l].model, pose), 2000, context);
    EXPECT_NEAR(rest.levels[l].error.max, distance.hausdorff(), 1e-6);
    EXPECT_NEAR(rest.levels[l].error.mean, distance.mean(), 1e-6);
  }
}

TEST(LodChain, ImagesFollowTheSizeOnTheScreen) {
  const Model model = test::textured(test::icosphere(3), 1);
  LodChainOptions options = quick_chain();
  options.screen.height = 64;
  options.coverages = {0.9, 0.2};
  options.screen.pixel_error = 4;
  const auto width = [](const LodLevel& level) { return image_info(level.model.images[0].bytes).width; };
  Model flat = test::textured(test::wavy_grid(16, 16, 0.1), 1);
  const LodChain follow = chain_of(flat, options);
  ASSERT_EQ(follow.levels.size(), 3U);
  EXPECT_EQ(width(follow.levels[0]), 64);
  EXPECT_LT(width(follow.levels[2]), width(follow.levels[1]) + (width(follow.levels[1]) < 64 ? 0 : 1));
  EXPECT_LT(width(follow.levels[2]), 64);
  options.textures_follow = false;
  const LodChain keep = chain_of(flat, options);
  for (const LodLevel& level : keep.levels) EXPECT_EQ(level.model.images, flat.images);
}

TEST(LodChain, PicturesAreAsLargeAsTheLevel) {
  LodChainOptions options = quick_chain();
  options.pictures = true;
  options.coverages = {0.1};
  const LodChain chain = chain_of(test::model_of(test::icosphere(3)), options);
  ASSERT_EQ(chain.levels.size(), 2U);
  EXPECT_EQ(chain.levels[0].picture_size, 0);
  EXPECT_EQ(chain.levels[1].picture_size, 108);
  EXPECT_GT(chain.levels[1].pictures[1].flip, 0);
  EXPECT_LT(chain.levels[1].pictures[1].flip, 0.1);
}

TEST(LodChain, IsTheSameForAnyNumberOfThreads) {
  const Model model = test::textured(test::wavy_grid(16, 16, 0.2), 2);
  LodChainOptions options = quick_chain();
  options.pictures = true;
  options.coverages = {0.3, 0.1};
  Context one, two;
  one.threads = 1;
  two.threads = 2;
  const LodChain a = chain_of(model, options, one), b = chain_of(model, options, two);
  ASSERT_EQ(a.levels.size(), b.levels.size());
  for (std::size_t i = 0; i < a.levels.size(); ++i) {
    EXPECT_EQ(a.levels[i].error.max, b.levels[i].error.max);
    EXPECT_EQ(a.levels[i].pictures[0].flip, b.levels[i].pictures[0].flip);
    EXPECT_EQ(a.levels[i].model.images, b.levels[i].model.images);
  }
}

TEST(LodChain, RefusesWhatMakesNoChain) {
  const Model sphere = test::model_of(test::icosphere(2));
  const auto refuse = [&](const auto& change, const std::string& place) {
    LodChainOptions options = quick_chain();
    change(options);
    test::expect_error([&] { chain_of(sphere, options); }, ErrorKind::usage, place);
  };
  refuse([](auto& o) { o.triangles = {10, 20}; }, "--triangles");
  refuse([](auto& o) { o.triangles = {10, 10}; }, "--triangles");
  refuse([](auto& o) { o.triangles = {10, 0}; }, "--triangles");
  refuse([](auto& o) { o.coverages = {0.1, 0.5}; }, "--coverage");
  refuse([](auto& o) { o.coverages = {-0.1}; }, "--coverage");
  refuse([](auto& o) { o.coverages = {3}; }, "distance");
  refuse([](auto& o) { o.distances = {5, 4}; }, "--distances");
  refuse([](auto& o) { o.distances = {0.5, 4}; }, "distance");
  refuse([](auto& o) { o.simplify.per_mesh = true; }, "--per-mesh");
  refuse([](auto& o) { o.levels = 1; }, "");
  refuse([](auto& o) { o.ratio = 1; }, "");
  refuse([](auto& o) { o.screen.pixel_error = 0; }, "");
  Model lods = sphere;
  lods.extensions_used = {"MSFT_lod"};
  test::expect_error([&] { chain_of(lods, quick_chain()); }, ErrorKind::unsupported, "");
  test::expect_error([&] { chain_of(test::model_of(test::empty_mesh()), quick_chain()); },
                     ErrorKind::unsupported, "");
}

TEST(LodChain, CanBeCancelled) {
  Context context;
  context.cancel();
  test::expect_error([&] { chain_of(test::model_of(test::icosphere(3)), quick_chain(), context); },
                     ErrorKind::cancelled, "");
}

}  // namespace
}  // namespace fovea
