#include "fovea/simplify/salient.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "fovea/base/random.h"
#include "fovea/io/image_codec.h"
#include "fovea/sample/sample.h"
#include "fovea/simplify/auto_saliency.h"
#include "oracle/saliency_oracle.h"
#include "support/by_quadrics.h"
#include "support/meshes.h"
#include "support/reading.h"

namespace fovea {
namespace {

using test::expect_error;

constexpr SaliencyWeighting kWeightings[] = {SaliencyWeighting::yang, SaliencyWeighting::lee,
                                             SaliencyWeighting::munaretti};

Importance importance(const Model& model, const std::vector<VertexField>& saliency,
                      const SalientOptions& options = {}) {
  return salient_importance(model, saliency, options, Context());
}

std::vector<VertexField> random_saliency(const Model& model) {
  Random random(2);
  std::vector<VertexField> fields;
  for (const Mesh& mesh : model.meshes) {
    VertexField& field = fields.emplace_back(mesh.surface.vertex_count());
    for (float& x : field.values()) x = static_cast<float>(random.below(10001)) / 10000;
  }
  return fields;
}

/// A third of the area around each vertex, in doubles.
std::vector<double> areas(const TriMesh& mesh) {
  std::vector<double> result(mesh.vertex_count(), 0);
  for (const auto& t : mesh.triangles) {
    const auto p = [&](std::size_t k) { return Vec3d(mesh.positions[t[k].index()]); };
    for (const VertexId v : t) result[v.index()] += length(cross(p(1) - p(0), p(2) - p(0))) / 6;
  }
  return result;
}

TEST(Salient, WeightsAreThoseOfThePapers) {
  // Areas are added up as floats there and in doubles here, so that weights agree to some 1e-7 × #V; no
  // vertex of these fields lies so near the percentile that it could fall on its other side.
  for (const TriMesh& mesh : {test::wavy_grid(14, 10, 0.2), test::torus(20, 10)}) {
    const Model model = test::model_of(mesh);
    const auto saliency = random_saliency(model);
    for (const SaliencyWeighting weighting : kWeightings) {
      for (const double strength : {0.5, 1.0, 2.0}) {
        const SalientOptions options{weighting, strength};
        const auto expected = test::salient_weights(saliency[0], surface_of(mesh), options);
        const Importance found = importance(model, saliency, options);
        ASSERT_EQ(found.size(), 1u);
        ASSERT_EQ(found[0].size(), expected.size());
        for (std::size_t v = 0; v < expected.size(); ++v)
          EXPECT_NEAR(found[0].values()[v], expected[v], 2e-5 * expected[v] + 1e-6);
      }
    }
  }
}

TEST(Salient, TheMeanOverTheSceneIsOne) {
  // Two meshes, one of them shown ten times as large: it has a hundred times the area.
  Model model = test::model_of({test::torus(20, 10), test::icosphere(2)});
  model.nodes[0].scale = {10, 10, 10};
  const auto saliency = random_saliency(model);
  for (const SaliencyWeighting weighting : kWeightings) {
    const Importance found = importance(model, saliency, {weighting, 1});
    double sum = 0, area = 0;
    for (std::size_t m = 0; m < 2; ++m) {
      const std::vector<double> own = areas(model.meshes[m].surface);
      for (std::size_t v = 0; v < own.size(); ++v) {
        const double a = own[v] * (m == 0 ? 100 : 1);
        sum += a * static_cast<double>(found[m].values()[v]);
        area += a;
      }
    }
    EXPECT_NEAR(sum / area, 1, 1e-5);
  }
}

TEST(Salient, YangIsGentleAndLeeIsNot) {
  const Model model = test::model_of(test::torus(20, 10));
  const auto saliency = random_saliency(model);
  const auto spread = [&](SaliencyWeighting weighting) {
    const Importance found = importance(model, saliency, {weighting, 1});
    const auto [low, high] = std::minmax_element(found[0].values().begin(), found[0].values().end());
    return static_cast<double>(*high / *low);
  };
  EXPECT_LE(spread(SaliencyWeighting::yang), 2 + 1e-6);
  EXPECT_GT(spread(SaliencyWeighting::lee), 300) << "100 times 1 against 0.3 at most";
}

TEST(Salient, MunarettiAmplifiesThePeaksAlone) {
  const Model model = test::model_of(test::torus(20, 10));
  std::vector<VertexField> saliency{VertexField(model.meshes[0].surface.vertex_count(), 0.5f)};
  saliency[0].values()[3] = 0.9f;
  saliency[0].values()[4] = 0.64f;
  saliency[0].values()[5] = 0.62f;  // 0.7 times the greatest is 0.63
  const Importance found = importance(model, saliency, {SaliencyWeighting::munaretti, 1});
  const float rest = found[0].values()[0];
  EXPECT_NEAR(found[0].values()[3] / rest, 100 * 0.9 / 0.5, 1e-3);
  EXPECT_NEAR(found[0].values()[4] / rest, 100 * 0.64 / 0.5, 1e-3);
  EXPECT_NEAR(found[0].values()[5] / rest, 0.62 / 0.5, 1e-5);
}

TEST(Salient, IsTheSameInAnyUnit) {
  const Model model = test::model_of(test::torus(20, 10));
  const auto saliency = random_saliency(model);
  for (const float unit : {std::ldexp(1.0f, 100), std::ldexp(1.0f, -100)}) {
    Model other = model;
    for (Vec3f& p : other.meshes[0].surface.positions) p = p * unit;
    EXPECT_EQ(importance(model, saliency), importance(other, saliency));
  }
}

TEST(Salient, WithoutStrengthAllAreAlike) {
  const Model model = test::model_of({test::torus(20, 10), test::cube()});
  for (const SaliencyWeighting weighting : kWeightings) {
    for (const VertexField& field : importance(model, random_saliency(model), {weighting, 0})) {
      for (const float w : field.values()) EXPECT_EQ(w, 1);
    }
  }
}

TEST(Salient, EqualSaliencyIsNone) {
  const Model model = test::model_of(test::torus(20, 10));
  for (const float s : {0.0f, 0.4f, 1.0f}) {
    const auto found = importance(model, {VertexField(model.meshes[0].surface.vertex_count(), s)});
    for (const float w : found[0].values()) EXPECT_NEAR(w, 1, 1e-6);
  }
}

TEST(Salient, TheStrongestWeightsAreStillNumbers) {
  const Model model = test::model_of(test::torus(20, 10));
  auto saliency = random_saliency(model);
  std::fill_n(saliency[0].values().begin(), 20, 0.0f);  // below the percentile
  SimplifyOptions options = test::by_quadrics();
  options.ratio = 0.3;
  for (const SaliencyWeighting weighting : kWeightings) {
    const Importance found = importance(model, saliency, {weighting, 10});
    for (const float w : found[0].values()) EXPECT_TRUE(w > 0 && std::isfinite(w)) << w;
    Context context;
    const SimplifyResult result = simplify(model, options, found, context);
    EXPECT_EQ(result.stop, StopReason::target);
    check(result.model.meshes[0].surface);
  }
}

TEST(Salient, AModelOfNothing) {
  EXPECT_TRUE(importance(Model{}, {}).empty());
  EXPECT_TRUE(importance(test::model_of(test::empty_mesh()), {VertexField()})[0].empty());
  Model hidden = test::model_of(test::cube());
  hidden.scenes[0].nodes.clear();
  const Importance found = importance(hidden, random_saliency(hidden));
  for (const float w : found[0].values()) EXPECT_TRUE(std::isfinite(w));
}

TEST(Salient, OtherSizesAreRefused) {
  const Model model = test::model_of({test::cube(), test::torus(12, 8)});
  const auto saliency = random_saliency(model);
  expect_error([&] { importance(model, {}); }, ErrorKind::usage, "", "2 meshes");
  // As many values in all, but of the wrong meshes.
  expect_error([&] { importance(model, {saliency[1], saliency[0]}); }, ErrorKind::usage, "", "mesh 0");
}

TEST(Product, OfWeights) {
  const auto field = [](std::vector<float> values) { return VertexField(std::move(values)); };
  const float infinite = std::numeric_limits<float>::infinity();
  const Importance a{field({1, 2, infinite}), field({}), field({3})},
      b{field({4, 0.5f, 0.1f}), field({5, 6}), field({})};
  EXPECT_EQ(product(a, b), (Importance{field({4, 1, infinite}), field({5, 6}), field({3})}));
  EXPECT_EQ(product(b, a), product(a, b));
  EXPECT_EQ(product(a, {}), a);
  EXPECT_EQ(product({}, b), b);
  EXPECT_TRUE(product({}, {}).empty());
  expect_error([&] { product(a, {field({1, 2, 3})}); }, ErrorKind::usage, "");
  expect_error([&] { product(a, {field({1}), field({}), field({})}); }, ErrorKind::usage, "");
}

TEST(Salient, KeepsTrianglesWherePeopleLook) {
  // A wavy sheet alike on both sides; saliency says that its right half is looked at.
  const Model model = test::model_of(test::wavy_grid(40, 40, 0.05));
  const TriMesh& mesh = model.meshes[0].surface;
  std::vector<VertexField> saliency{VertexField(mesh.vertex_count())};
  for (std::size_t v = 0; v < mesh.vertex_count(); ++v) saliency[0].values()[v] = mesh.positions[v].x > 0.5f;
  SimplifyOptions options = test::by_quadrics();
  options.ratio = 0.1;
  const auto share_right = [&](const Importance& weights) {
    Context context;
    const TriMesh result = simplify(model, options, weights, context).model.meshes[0].surface;
    std::size_t right = 0;
    for (const auto& t : result.triangles) {
      float x = 0;
      for (const VertexId v : t) x += result.positions[v.index()].x / 3;
      right += x > 0.5f;
    }
    return static_cast<double>(right) / static_cast<double>(result.face_count());
  };
  const double none = share_right({}), yang = share_right(importance(model, saliency)),
               strong = share_right(importance(model, saliency, {SaliencyWeighting::yang, 4})),
               lee = share_right(importance(model, saliency, {SaliencyWeighting::lee, 1}));
  EXPECT_NEAR(none, 0.5, 0.05) << "the sheet is alike on both sides";
  // Errors are squares of lengths and the error of n triangles falls as 1 / n, its square as 1 / n²: twice
  // the weight is worth about 2^(1/3) the triangles where both sides cost the same at the margin.
  EXPECT_GT(yang, 0.53);
  EXPECT_GT(strong, yang);
  EXPECT_GT(lee, 0.8);
}

// --- Chosen by pictures ----------------------------------------------------------------------------

/// A vase of a few hundred triangles, with its texture.
Model small_vase() {
  Context context;
  return make_sample("vase", 0.01, context);
}

AutoSaliency chosen(const Model& model, double ratio, const Importance& own = {}, int threads = 1) {
  SimplifyOptions options = test::by_quadrics();
  options.ratio = ratio;
  Context context;
  context.threads = threads;
  return choose_saliency(model, options, own, {}, context);
}

std::vector<std::string> names(const AutoSaliency& found) {
  std::vector<std::string> list;
  for (const SaliencyTrial& trial : found.trials) list.push_back(trial.name);
  return list;
}

TEST(AutoSaliency, IsNeverWorseThanNoneAndSaysWhatItTried) {
  const Model model = small_vase();
  const AutoSaliency found = chosen(model, 0.3);
  ASSERT_GE(found.trials.size(), 5u);
  EXPECT_LE(found.trials.size(), 9u) << "what the header promises of the cost";
  EXPECT_EQ(names(found)[0], "none");
  EXPECT_EQ(names(found)[1], "geometry 1, strength 1");
  EXPECT_EQ(names(found)[2], "geometry 0.5, color 0.25, entropy 0.25, strength 1");
  EXPECT_EQ(names(found)[4], "visibility 1, strength 1");
  for (const SaliencyTrial& trial : found.trials) {
    EXPECT_GT(trial.flip, 0) << trial.name;
    EXPECT_LE(found.trials[found.best].flip, trial.flip) << trial.name;
  }
  EXPECT_GT(found.seconds, 0);
  // The importance is that of the best trial.
  if (found.best == 0) {
    EXPECT_TRUE(found.importance.empty());
  } else {
    ASSERT_EQ(found.importance.size(), model.meshes.size());
    EXPECT_EQ(found.importance[0].size(), model.meshes[0].surface.vertex_count());
  }
}

TEST(AutoSaliency, TheSameForAnyNumberOfThreads) {
  const Model model = small_vase();
  const AutoSaliency one = chosen(model, 0.2, {}, 1), three = chosen(model, 0.2, {}, 3);
  EXPECT_EQ(names(one), names(three));
  EXPECT_EQ(one.best, three.best);
  EXPECT_EQ(one.importance, three.importance);
  for (std::size_t i = 0; i < one.trials.size(); ++i) EXPECT_EQ(one.trials[i].flip, three.trials[i].flip);
}

TEST(AutoSaliency, WithoutATextureOnlyShapeIsTried) {
  const AutoSaliency found = chosen(test::model_of(test::torus(24, 12)), 0.5);
  for (const std::string& name : names(found)) {
    EXPECT_EQ(name.find("color"), std::string::npos) << name;
    EXPECT_EQ(name.find("entropy"), std::string::npos) << name;
  }
}

TEST(AutoSaliency, WhatIsGivenPassesThroughWhereNothingIsBetter) {
  // A flat sheet looks the same under any weights, and ties go to the first.
  const Model model = test::model_of(test::grid(12, 12));
  Importance own{VertexField(model.meshes[0].surface.vertex_count(), 1)};
  own[0].values()[5] = 7;
  const AutoSaliency found = chosen(model, 0.9, own);
  EXPECT_EQ(found.best, 0u) << names(found)[found.best];
  EXPECT_EQ(found.importance, own);
  EXPECT_TRUE(chosen(model, 0.9).importance.empty());
}

TEST(AutoSaliency, WhatIsGivenCountsInEveryTrial) {
  // Locked altogether, nothing can be taken away: all trials are the model itself.
  const Model model = test::model_of(test::torus(24, 12));
  const Importance locked{
      VertexField(model.meshes[0].surface.vertex_count(), std::numeric_limits<float>::infinity())};
  const AutoSaliency found = chosen(model, 0.5, locked);
  for (const SaliencyTrial& trial : found.trials) EXPECT_EQ(trial.flip, 0) << trial.name;
  EXPECT_EQ(found.importance, locked);
}

TEST(AutoSaliency, CanBeCancelled) {
  Context context;
  context.progress = [](std::string_view phase, double) { return phase != "choose saliency"; };
  SimplifyOptions options = test::by_quadrics();
  options.ratio = 0.5;
  const Model model = test::model_of(test::torus(24, 12));
  expect_error([&] { choose_saliency(model, options, {}, {}, context); }, ErrorKind::cancelled, "");
}

TEST(AutoSaliency, AModelOfNothingIsRefused) {
  expect_error([] { chosen(Model{}, 0.5); }, ErrorKind::unsupported, "");
  expect_error([] { chosen(test::model_of(test::empty_mesh()), 0.5); }, ErrorKind::unsupported, "");
}

}  // namespace
}  // namespace fovea
