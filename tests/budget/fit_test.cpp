#include "fovea/budget/fit.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "fovea/base/error.h"
#include "fovea/base/random.h"
#include "fovea/budget/picture_loss.h"
#include "fovea/io/gltf_write.h"
#include "fovea/io/image_codec.h"
#include "fovea/simplify/simplify.h"
#include "fovea/texture/shrink.h"
#include "support/meshes.h"
#include "support/pictures.h"
#include "support/textured.h"

namespace fovea {
namespace {

/// A hilly sheet of 3,200 triangles under a picture of 256² texels.
Model hills() {
  TriMesh mesh = test::grid(40, 40);
  const Box box = bounds(mesh);
  const double size = std::max(box.high.x - box.low.x, box.high.y - box.low.y);
  for (Vec3f& p : mesh.positions) {
    const double x = (static_cast<double>(p.x) - box.low.x) / size,
                 y = (static_cast<double>(p.y) - box.low.y) / size;
    p.z = static_cast<float>(size * (0.1 * std::sin(9 * x) * std::cos(7 * y) + 0.02 * std::sin(40 * x * y)));
  }
  Model model = test::textured(test::shuffled(mesh), 1);
  model.images[0].bytes = encode_png(test::pattern(256, 256));
  return model;
}

std::uint64_t file_bytes(const Model& model, const FitOptions& options = {}) {
  Context context;
  return write_gltf(model, options.form.binary, "model", options.form.write, context).files[0].bytes.size();
}

std::uint64_t images_of(const Model& model) {
  std::uint64_t sum = 0;
  for (const EncodedImage& image : model.images) sum += image.bytes.size();
  return sum;
}

/// Small pictures, so that tests are quick.
FitOptions quick() {
  FitOptions options;
  options.view_size = 96;
  options.views.set = ViewSet::octahedron;
  return options;
}

TEST(Fit, KeepsToTheBytesAndSpendsThem) {
  const Model model = hills();
  const std::uint64_t whole = file_bytes(model);
  for (const double share : {0.5, 0.2, 0.08}) {
    const auto bytes = static_cast<std::uint64_t>(share * static_cast<double>(whole));
    Context context;
    const FitOptions options = quick();
    const FitResult result = BudgetFit(model, options, context).within(bytes);
    EXPECT_TRUE(result.reached);
    const std::uint64_t used = file_bytes(result.model, options);
    EXPECT_EQ(result.chosen.bytes, used);
    EXPECT_LE(used, bytes);
    EXPECT_GT(static_cast<double>(used), 0.9 * static_cast<double>(bytes)) << share;
    EXPECT_EQ(result.chosen.triangles, counts(result.model).triangles);
    EXPECT_EQ(result.chosen.image_bytes, images_of(result.model));
  }
}

TEST(Fit, SpendsBytesWhereCamerasLook) {
  Model model = hills();
  const Box box = bounds(model);
  const double side = box.high.x - box.low.x;
  model.cameras.emplace_back().yfov_rad = 0.6;
  Node node;
  node.camera = 0;
  node.translation = Vec3d{box.low.x + side / 3, box.low.y + side / 3, box.high.z + side / 2};
  model.nodes.push_back(node);
  model.scenes[0].nodes.push_back(1);
  const std::uint64_t bytes = file_bytes(model) / 20;
  FitOptions around = quick(), cameras;
  around.format = TextureOutput::jpeg;
  cameras = around;
  cameras.views.set = ViewSet::cameras;
  Context context;
  PictureLoss loss(model, cameras.views, 96, Distortion::mse, context);
  const auto lost = [&](const FitOptions& options) {
    const FitResult result = BudgetFit(model, options, context).within(bytes);
    EXPECT_TRUE(result.reached);
    EXPECT_LE(result.chosen.bytes, bytes);
    return loss.of(result.model).value;
  };
  EXPECT_LT(1.5 * lost(cameras), lost(around)) << "that sees a tenth of the land";
}

TEST(Fit, IsNoWorseThanAnyFixedSplit) {
  const Model model = hills();
  Context context;
  const std::uint64_t bytes = file_bytes(model) / 6;
  const FitOptions options = quick();
  PictureLoss loss(model, options.views, static_cast<int>(options.view_size), Distortion::mse, context);
  const double fitted = loss.of(BudgetFit(model, options, context).within(bytes).model).squared;
  int tried = 0;
  for (const double ratio : {0.5, 0.25, 0.1, 0.05}) {
    SimplifyOptions simplify_options;
    simplify_options.ratio = ratio;
    simplify_options.metric = Metric::quadric;
    const Model fewer = simplify(model, simplify_options, {}, context).model;
    const std::uint64_t geometry = file_bytes(fewer, options) - images_of(fewer);
    if (geometry + 2000 > bytes) continue;
    ShrinkOptions shrink;
    shrink.max_bytes = static_cast<std::int64_t>(bytes - geometry);
    const Model split = shrink_textures(fewer, shrink, {}, context).model;
    // To a thousandth: the split is sought with the view in mind, not the bytes to the last.
    EXPECT_LE(fitted, 1.001 * loss.of(split).squared) << ratio;
    ++tried;
  }
  EXPECT_GE(tried, 2);
}

TEST(Fit, ThePathIsTheChoiceForAnyBudget) {
  const Model model = hills();
  Context context;
  const FitResult result = BudgetFit(model, quick(), context).within(file_bytes(model) / 10);
  ASSERT_GT(result.path.size(), 4u);
  for (std::size_t i = 1; i < result.path.size(); ++i) {
    EXPECT_LT(result.path[i].bytes, result.path[i - 1].bytes);
    EXPECT_GT(result.path[i].loss, result.path[i - 1].loss);
  }
  EXPECT_LT(result.pictures, 3 * result.path.size() + 16);  // no search of all pairs
  EXPECT_TRUE(std::isinf(result.path[0].psnr_db));
}

TEST(Fit, WithoutTexturesTrianglesAloneGiveWay) {
  const Model model = test::model_of(test::shuffled(test::torus(64, 32)));
  Context context;
  const std::uint64_t bytes = file_bytes(model) / 4;
  const FitOptions options = quick();
  const FitResult result = BudgetFit(model, options, context).within(bytes);
  EXPECT_LE(file_bytes(result.model, options), bytes);
  EXPECT_GT(static_cast<double>(file_bytes(result.model, options)), 0.95 * static_cast<double>(bytes));
  EXPECT_EQ(result.chosen.image_bytes, 0u);
}

TEST(Fit, WhatFitsStaysWhole) {
  const Model model = hills();
  Context context;
  const FitResult result = BudgetFit(model, quick(), context).within(10 * file_bytes(model));
  EXPECT_EQ(result.path.size(), 1u);
  EXPECT_EQ(counts(result.model).triangles, counts(model).triangles);
  EXPECT_EQ(images_of(result.model), images_of(model));
}

TEST(Fit, TooFewBytesAreSaid) {
  const Model model = hills();
  Context context;
  const FitResult result = BudgetFit(model, quick(), context).within(300);
  EXPECT_FALSE(result.reached);
  EXPECT_GT(result.chosen.bytes, 300u);
  EXPECT_LE(result.chosen.bytes, result.path.back().bytes);
}

TEST(Fit, ImagesGoDownToTheFewestBytesThereAre) {
  Model model = hills();
  Image8 noise(256, 256, 3, ColorEncoding::srgb);
  Random random(3);
  for (std::uint8_t& value : noise.pixels) value = static_cast<std::uint8_t>(255 * random.uniform());
  model.images[0].bytes = encode_png(noise);
  Context context;
  const FitOptions options = quick();
  BudgetFit fit(model, options, context);
  const FitResult smallest = fit.within(1);
  EXPECT_FALSE(smallest.reached);
  EXPECT_LT(images_of(smallest.model) * 500, images_of(model));
  // That much is reached, also after a larger budget.
  EXPECT_TRUE(fit.within(file_bytes(model) / 2).reached);
  EXPECT_TRUE(fit.within(smallest.chosen.bytes).reached);
}

TEST(Fit, MatchesALikeness) {
  const Model model = hills();
  Context context;
  const FitOptions options = quick();
  BudgetFit fit(model, options, context);
  PictureLoss loss(model, options.views, static_cast<int>(options.view_size), Distortion::mse, context);
  std::uint64_t last = file_bytes(model);
  for (const double likeness : {30.0, 25.0, 20.0}) {
    const FitResult result = fit.like(FitMetric::psnr, likeness);
    EXPECT_TRUE(result.reached);
    for (const ImageScores& s : loss.scores(result.model).passes) EXPECT_GE(s.psnr_foreground, likeness);
    EXPECT_LT(result.chosen.bytes, last);
    last = result.chosen.bytes;
    // An eighth fewer bytes do not do.
    bool is_like = true;
    for (const ImageScores& s : loss.scores(fit.within(last - last / 8).model).passes)
      is_like &= s.psnr_foreground >= likeness;
    EXPECT_FALSE(is_like) << likeness;
  }
}

TEST(Fit, IsTheSameForAnyNumberOfThreads) {
  const Model model = hills();
  const std::uint64_t bytes = file_bytes(model) / 8;
  Context one, two;
  one.threads = 1;
  two.threads = 2;
  const FitResult a = BudgetFit(model, quick(), one).within(bytes),
                  b = BudgetFit(model, quick(), two).within(bytes);
  EXPECT_EQ(a.chosen.bytes, b.chosen.bytes);
  EXPECT_EQ(a.chosen.psnr_db, b.chosen.psnr_db);
  ASSERT_EQ(a.model.images.size(), b.model.images.size());
  for (std::size_t i = 0; i < a.model.images.size(); ++i)
    EXPECT_EQ(a.model.images[i].bytes, b.model.images[i].bytes);
  EXPECT_EQ(a.model.meshes[0].surface.positions, b.model.meshes[0].surface.positions);
}

TEST(Fit, AnimatedModelsStayAnimated) {
  const Model model = test::skinned_model(400);
  Context context;
  const FitResult result = BudgetFit(model, quick(), context).within(file_bytes(model) / 2);
  EXPECT_TRUE(result.reached);
  EXPECT_EQ(result.model.animations.size(), model.animations.size());
  EXPECT_EQ(result.model.skins.size(), model.skins.size());
}

TEST(Fit, OneFitAnswersForManyBudgets) {
  const Model model = hills();
  const std::uint64_t whole = file_bytes(model);
  Context context;
  BudgetFit fit(model, quick(), context);
  for (const std::uint64_t bytes : {whole / 20, whole / 3, whole / 8}) {
    const FitResult again = fit.within(bytes), alone = BudgetFit(model, quick(), context).within(bytes);
    EXPECT_LE(again.chosen.bytes, bytes);
    // Qualities that were tried for another budget are there for this one too.
    EXPECT_LE(again.chosen.loss, 1.02 * alone.chosen.loss);
  }
  // What the walk draws is known by now; some models are tried anew beside its end.
  const FitResult before = fit.within(whole / 20), after = fit.within(whole / 20);
  EXPECT_LT(after.pictures - before.pictures, before.path.size());
}

TEST(Fit, AllPairsAreNoBetterThanPruningByMuch) {
  const Model model = hills();
  Context context;
  FitOptions options = quick();
  options.ladders = FitLadderSet::joint;
  BudgetFit pruned(model, options, context);
  options.search = FitSearch::exhaustive;
  BudgetFit all(model, options, context);
  const std::uint64_t bytes = file_bytes(model) / 8;
  const FitResult best = all.within(bytes);
  EXPECT_TRUE(pruned.all().empty());
  const std::vector<FitPoint> pairs = all.all();
  ASSERT_GT(pairs.size(), 50u);
  // Each point of the way is within 0.3 dB of the best pair of no more bytes (Horbelt et al. 2001, figure 6).
  for (const FitPoint& point : pruned.way()) {
    double most = 0;
    for (const FitPoint& pair : pairs)
      if (pair.bytes <= point.bytes) most = std::max(most, pair.psnr_db);
    if (std::isfinite(point.psnr_db)) {
      EXPECT_GT(point.psnr_db, most - 0.3) << point.bytes;
    }
  }
  EXPECT_GE(best.chosen.psnr_db, pruned.within(bytes).chosen.psnr_db - 0.1);
}

TEST(Fit, TheWayIsConvex) {
  const Model model = hills();
  Context context;
  FitOptions options = quick();
  for (const std::int64_t fineness : {1, 3}) {
    options.fineness = fineness;
    const std::vector<FitPoint> way = BudgetFit(model, options, context).way();
    ASSERT_GT(way.size(), 4u);
    EXPECT_EQ(way.front().triangles, counts(model).triangles);
    double before = 0;
    for (std::size_t i = 1; i < way.size(); ++i) {
      ASSERT_LT(way[i].bytes, way[i - 1].bytes);
      const double slope =
          (way[i].loss - way[i - 1].loss) / static_cast<double>(way[i - 1].bytes - way[i].bytes);
      EXPECT_GE(slope, before) << fineness << ' ' << i;
      before = slope;
    }
  }
}

TEST(Fit, GrowingEndsAtTheBudgetToo) {
  const Model model = hills();
  Context context;
  FitOptions options = quick();
  options.search = FitSearch::grow;
  const std::uint64_t bytes = file_bytes(model) / 8;
  const FitResult result = BudgetFit(model, options, context).within(bytes);
  EXPECT_TRUE(result.reached);
  EXPECT_LE(result.chosen.bytes, bytes);
  EXPECT_GT(result.chosen.psnr_db, BudgetFit(model, quick(), context).within(bytes).chosen.psnr_db - 0.5);
}

TEST(Fit, FinerLaddersHaveMoreRungsAndDoNoWorse) {
  const Model model = hills();
  Context context;
  FitOptions options = quick();
  BudgetFit usual(model, options, context);
  options.fineness = 3;
  BudgetFit finer(model, options, context);
  EXPECT_GT(finer.way().size(), usual.way().size());
  const std::uint64_t bytes = file_bytes(model) / 8;
  // Neither search tries all, so one may end a little ahead of the other; but what is refined from more
  // rungs must not be behind what lies on the way of fewer.
  double on_the_way = 0;
  for (const FitPoint& point : usual.way())
    if (point.bytes <= bytes) on_the_way = std::max(on_the_way, point.psnr_db);
  EXPECT_GT(on_the_way, 0);
  EXPECT_GE(finer.within(bytes).chosen.psnr_db, on_the_way);
}

TEST(Fit, WhatIsLostDecides) {
  const Model model = hills();
  Context context;
  const std::uint64_t bytes = file_bytes(model) / 10;
  const FitOptions plain = quick();
  FitOptions options = plain;
  const FitResult by_mse = BudgetFit(model, plain, context).within(bytes);
  for (const Distortion distortion : {Distortion::ms_ssim, Distortion::flip}) {
    options.distortion = distortion;
    PictureLoss loss(model, plain.views, static_cast<int>(plain.view_size), distortion, context);
    const FitResult result = BudgetFit(model, options, context).within(bytes);
    EXPECT_DOUBLE_EQ(result.chosen.loss, loss.of(result.model).value);
    // Searches may end a triangle or two of 218 apart, a hundredth; less is lost about in that proportion.
    EXPECT_LE(result.chosen.loss, 1.02 * loss.of(by_mse.model).value);
  }
}

TEST(Fit, OnlyTrianglesOrOnlyTexelsGiveWay) {
  const Model model = hills();
  Context context;
  FitOptions options = quick();
  options.gives = FitGives::triangles;
  const FitResult fewer = BudgetFit(model, options, context).within(images_of(model) + 20000);
  EXPECT_TRUE(fewer.reached);
  EXPECT_EQ(images_of(fewer.model), images_of(model));
  EXPECT_LT(counts(fewer.model).triangles, counts(model).triangles);
  options.gives = FitGives::texels;
  const std::uint64_t rest = file_bytes(model) - images_of(model);
  const FitResult smaller = BudgetFit(model, options, context).within(rest + 20000);
  EXPECT_TRUE(smaller.reached);
  EXPECT_LT(images_of(smaller.model), 20000u);
  EXPECT_EQ(counts(smaller.model).triangles, counts(model).triangles);
}

/// Two sheets side by side, one of them much smaller, each with an image of its own.
Model two_sheets() {
  Model model = hills(), other = hills();
  model.images.push_back(other.images[0]);
  model.textures.push_back(model.textures[0]);
  model.textures[1].image = 1;
  model.materials.push_back(model.materials[0]);
  model.materials[1].base_color->texture = 1;
  Mesh mesh = other.meshes[0];
  for (Vec3f& p : mesh.surface.positions) p = 0.1f * p + Vec3f{60, 0, 0};
  for (Part& part : mesh.surface.parts) part.material = 1;
  model.meshes.push_back(mesh);
  Node node = model.nodes[0];
  node.mesh = 1;
  model.nodes.push_back(node);
  model.scenes[0].nodes.push_back(1);
  return model;
}

TEST(Fit, WhatIsSeenSmallGivesWayFirst) {
  const Model model = two_sheets();
  Context context;
  FitOptions options = quick();
  options.view_size = 256;
  const FitResult result = BudgetFit(model, options, context).within(file_bytes(model) / 6);
  EXPECT_TRUE(result.reached);
  EXPECT_LT(2 * result.model.meshes[1].surface.face_count(), result.model.meshes[0].surface.face_count());
  EXPECT_LT(2 * result.model.images[1].bytes.size(), result.model.images[0].bytes.size());
}

TEST(Fit, CancelledItHasTheBestSoFar) {
  const Model model = hills();
  const std::uint64_t bytes = file_bytes(model) / 8;
  int heard = 0;
  for (const int enough : {1, 4, 30}) {
    Context context;
    BudgetFit fit(model, quick(), context);
    int told = 0;
    context.progress = [&](std::string_view, double) { return ++told < enough; };
    const FitResult result = fit.within(bytes);
    if (!result.cancelled) continue;
    ++heard;
    EXPECT_LE(file_bytes(result.model), bytes);
    EXPECT_GT(result.chosen.triangles, 0u);
  }
  EXPECT_GE(heard, 2);
}

TEST(Fit, WhatCannotBeIsRefused) {
  const Model model = hills();
  Context context;
  EXPECT_THROW(BudgetFit(Model(), quick(), context), Error);
  FitOptions none = quick();
  none.triangles = 0;
  EXPECT_THROW(BudgetFit(model, none, context), Error);
  EXPECT_THROW(BudgetFit(model, quick(), context).like(FitMetric::flip, 1.5), Error);
}

}  // namespace
}  // namespace fovea
