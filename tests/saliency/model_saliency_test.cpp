#include "fovea/saliency/model_saliency.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "fovea/base/error.h"
#include "fovea/saliency/contrast.h"
#include "fovea/saliency/mesh_saliency.h"
#include "fovea/saliency/surface_signals.h"
#include "fovea/sample/sample.h"
#include "fovea/surface/curvature.h"
#include "oracle/saliency_oracle.h"
#include "support/meshes.h"
#include "support/reading.h"

namespace fovea {
namespace {

constexpr SaliencyPreset kPresets[] = {SaliencyPreset::fovea, SaliencyPreset::yang, SaliencyPreset::lee,
                                       SaliencyPreset::munaretti};

SaliencyOptions with(SaliencyPreset preset) {
  SaliencyOptions options;
  options.preset = preset;
  return options;
}

ModelSaliency found(const Model& model, const SaliencyOptions& options = {}, int threads = 1) {
  Context context;
  context.threads = threads;
  return model_saliency(model, options, context);
}

const std::vector<VertexField>& map(const ModelSaliency& saliency, const std::string& name) {
  const auto at = std::find_if(saliency.maps.begin(), saliency.maps.end(),
                               [&](const SaliencyMap& m) { return m.name == name; });
  EXPECT_NE(at, saliency.maps.end()) << name;
  return at->fields;
}

Model vase(double detail = 0.02) {
  Context context;
  return make_sample("vase", detail, context);
}

/// On the vase's outside, where the figure and its ground are painted.
bool on_body(Vec3f p) { return p.y > 0.55f && p.y < 0.85f && std::hypot(p.x, p.z) > 0.433f; }

TEST(ModelSaliency, LeeIsMeshSaliencyOfTheScene) {
  const Model model = test::model_of(test::torus(60, 30));
  const VertexField expected =
      mesh_saliency(surface_of(model.meshes[0].surface), kLeeSaliency, Context()).saliency;
  const ModelSaliency lee = found(model, with(SaliencyPreset::lee));
  EXPECT_EQ(map(lee, "geometry")[0], expected);
  const auto [low, high] = std::minmax_element(expected.values().begin(), expected.values().end());
  for (std::size_t v = 0; v < expected.size(); ++v)
    EXPECT_NEAR(lee.saliency[0].values()[v], (expected.values()[v] - *low) / (*high - *low), 1e-5);
}

TEST(ModelSaliency, YangIsTheSumOfBothMapsWithTheirPeaksPromoted) {
  const Model model = vase();
  SaliencyOptions options = with(SaliencyPreset::yang);
  options.texture = 0.75, options.geometry = 0.25;
  const ModelSaliency yang = found(model, options);
  ASSERT_TRUE(yang.textured);
  ASSERT_EQ(model.meshes.size(), 1u);
  const Adjacency adjacency(surface_of(model.meshes[0].surface), Context());
  const VertexField t = promote_peaks(map(yang, "texture")[0], adjacency),
                    g = promote_peaks(map(yang, "geometry")[0], adjacency);
  std::vector<float> expected;
  for (std::size_t v = 0; v < t.size(); ++v)
    expected.push_back(0.75f * t.values()[v] + 0.25f * g.values()[v]);
  const auto [low, high] = std::minmax_element(expected.begin(), expected.end());
  for (std::size_t v = 0; v < t.size(); ++v)
    EXPECT_NEAR(yang.saliency[0].values()[v], (expected[v] - *low) / (*high - *low), 1e-5);
}

TEST(ModelSaliency, YangEqualsTheFormulas) {
  const Model model = vase(0.005);
  Context context;
  const Surface surface = surface_of(model.meshes[0].surface);
  const SurfaceSignals read = surface_signals(model, 0, {}, context);
  const test::TexturedSignals signals{mean_curvature(surface, Adjacency(surface, context), context),
                                      read.intensity, read.opponency, read.entropy, read.texels};
  for (const auto& [texture, entropy] : {std::pair{0.5, 0.5}, {0.3, 0.8}}) {
    SaliencyOptions options = with(SaliencyPreset::yang);
    options.texture = texture, options.geometry = 1 - texture;
    options.entropy_share = entropy;
    const VertexField saliency = found(model, options).saliency[0],
                      expected = test::textured_saliency(signals, surface, texture, entropy);
    ASSERT_EQ(saliency.size(), expected.size());
    for (std::size_t v = 0; v < saliency.size(); ++v)
      EXPECT_NEAR(saliency.values()[v], expected.values()[v], 1e-4) << v;
  }
}

TEST(ModelSaliency, YangCountsVerticesInShapeAndTexelsInTextures) {
  const Model model = vase();
  const ModelSaliency yang = found(model, with(SaliencyPreset::yang));
  Context context;
  const SurfaceSignals signals = surface_signals(model, 0, {}, context);
  const Surface surface = surface_of(model.meshes[0].surface);
  const Adjacency adjacency(surface, context);
  const VertexField areas = vertex_areas(surface, adjacency, context);
  double area = 0;
  for (const float a : areas.values()) area += static_cast<double>(a);
  const double radius =
      std::sqrt(4 * area / static_cast<double>(surface.triangles.size()) / (3 * std::sqrt(3.0)));
  const ScalePair pairs[] = {{2 * radius, 4 * radius}};
  const Neighborhood window{DistanceKind::window, 1, VertexWeight::one};
  const auto contrast = [&](const VertexField& signal, std::span<const VertexField> weights) {
    return center_surround(surface, adjacency, {&signal, 1}, pairs, window, context, weights)[0][0];
  };
  const auto expect_near = [](const VertexField& a, const VertexField& b) {
    // Sums in another order of vertices, of values of up to a few bits or tens of curvature.
    for (std::size_t v = 0; v < a.size(); ++v)
      EXPECT_NEAR(a.values()[v], b.values()[v], 1e-4 * (1 + std::abs(b.values()[v])));
  };
  expect_near(map(yang, "entropy-contrast-1")[0], contrast(signals.entropy, {&signals.texels, 1}));
  expect_near(map(yang, "curvature-contrast-1")[0], contrast(map(yang, "curvature")[0], {}));
  EXPECT_NE(contrast(signals.entropy, {&signals.texels, 1}), contrast(signals.entropy, {}));
}

TEST(ModelSaliency, YangsTextureWeighsColorAgainstEntropy) {
  const Model model = vase();
  SaliencyOptions options = with(SaliencyPreset::yang);
  const auto texture = [&](double share) {
    options.entropy_share = share;
    return map(found(model, options), "texture")[0];
  };
  const VertexField color = texture(0), entropy = texture(1), both = texture(0.5);
  EXPECT_NE(color, entropy);
  for (std::size_t v = 0; v < both.size(); ++v)
    EXPECT_NEAR(both.values()[v], 0.5f * (color.values()[v] + entropy.values()[v]), 1e-5);
}

TEST(ModelSaliency, WithoutTextureShapeCountsAlone) {
  const Model model = test::model_of(test::torus(60, 30));
  const ModelSaliency yang = found(model, with(SaliencyPreset::yang));
  EXPECT_FALSE(yang.textured);
  SaliencyOptions shape = with(SaliencyPreset::yang);
  shape.texture = 0;
  EXPECT_EQ(yang.saliency, found(model, shape).saliency);
}

TEST(ModelSaliency, EveryPartCanBeSwitchedOffAndStandsAlone) {
  const Model model = vase();
  using Weight = std::optional<double> SaliencyOptions::*;
  const std::pair<const char*, Weight> parts[] = {{"geometry", &SaliencyOptions::geometry},
                                                  {"texture", &SaliencyOptions::texture},
                                                  {"height", &SaliencyOptions::height},
                                                  {"extremity", &SaliencyOptions::extremity},
                                                  {"visibility", &SaliencyOptions::visibility}};
  for (const auto& [name, weight] : parts) {
    SaliencyOptions without, alone;
    without.*weight = 0;
    for (const auto& [other, its] : parts) alone.*its = other == name ? 1 : 0;
    const ModelSaliency rest = found(model, without), single = found(model, alone);
    const auto has = [](const ModelSaliency& s, const char* map_name) {
      return std::any_of(s.maps.begin(), s.maps.end(),
                         [&](const SaliencyMap& m) { return m.name == map_name; });
    };
    EXPECT_FALSE(has(rest, name));
    EXPECT_TRUE(has(single, name));
    EXPECT_NE(rest.saliency, single.saliency);
    const auto [low, high] =
        std::minmax_element(single.saliency[0].values().begin(), single.saliency[0].values().end());
    EXPECT_EQ(*low, 0) << name;
    EXPECT_EQ(*high, 1) << name;
  }
}

TEST(ModelSaliency, NothingThatCountsIsRefused) {
  SaliencyOptions options = with(SaliencyPreset::lee);
  options.geometry = 0;
  EXPECT_THROW(found(test::model_of(test::cube()), options), Error);
  SaliencyOptions even;
  even.entropy_window = 8;
  EXPECT_THROW(found(test::model_of(test::cube()), even), Error);
  SaliencyOptions moment;
  moment.pose.animation = 0;
  moment.key_poses = 3;
  EXPECT_THROW(found(test::skinned_model(8), moment), Error);
  SaliencyOptions negative;
  negative.height = -1;
  EXPECT_THROW(found(test::model_of(test::cube()), negative), Error);
}

TEST(ModelSaliency, IsANumberBetweenZeroAndOneOnEveryMesh) {
  for (const test::NamedMesh& named : test::all_families()) {
    const Model model = test::model_of(named.mesh);
    for (const SaliencyPreset preset : kPresets) {
      const ModelSaliency s = found(model, with(preset));
      ASSERT_EQ(s.saliency.size(), 1u) << named.name;
      ASSERT_EQ(s.saliency[0].size(), named.mesh.vertex_count()) << named.name;
      for (const float x : s.saliency[0].values()) EXPECT_TRUE(x >= 0 && x <= 1) << named.name;
      for (const SaliencyMap& m : s.maps) {
        for (const float x : m.fields[0].values()) EXPECT_TRUE(std::isfinite(x)) << named.name << m.name;
      }
    }
  }
  const ModelSaliency none = found(Model());
  EXPECT_TRUE(none.saliency.empty());
}

TEST(ModelSaliency, SaysWhenNothingStandsOut) {
  const auto told = [](const TriMesh& mesh, SaliencyPreset preset) {
    Context context;
    const Model model = test::model_of(mesh);
    const VertexField saliency = model_saliency(model, with(preset), context).saliency[0];
    const std::size_t count = test::told(context, "even-saliency");
    EXPECT_EQ(count == 1, saliency == VertexField(mesh.vertex_count()));
    return count;
  };
  EXPECT_EQ(told(test::torus(12, 6), SaliencyPreset::munaretti), 1u)
      << "edges are longer than neighbourhoods";
  EXPECT_EQ(told(test::torus(12, 6), SaliencyPreset::fovea), 0u);
  EXPECT_EQ(told(test::grid(4, 4), SaliencyPreset::lee), 1u);
}

TEST(ModelSaliency, IsTheSameInAnyUnit) {
  const Model model = test::model_of(test::torus(40, 20));
  for (const float unit : {std::ldexp(1.0f, 100), std::ldexp(1.0f, -100)}) {  // squares are no floats
    Model other = model;
    for (Vec3f& p : other.meshes[0].surface.positions) p = p * unit;
    for (const SaliencyPreset preset : kPresets) {
      const ModelSaliency a = found(model, with(preset)), b = found(other, with(preset));
      EXPECT_EQ(a.saliency, b.saliency);
      EXPECT_EQ(map(a, "geometry"), map(b, "geometry"));
      // Maps of lengths stay in the model's own.
      for (std::size_t v = 0; v < a.saliency[0].size(); ++v) {
        EXPECT_FLOAT_EQ(map(a, "curvature")[0].values()[v], map(b, "curvature")[0].values()[v] * unit);
        if (preset == SaliencyPreset::fovea) {
          EXPECT_FLOAT_EQ(map(a, "height")[0].values()[v], map(b, "height")[0].values()[v] / unit);
        }
      }
    }
  }
}

TEST(ModelSaliency, BeyondFloatsIsRefused) {
  Model model = test::model_of(test::torus(8, 6));
  for (Vec3f& p : model.meshes[0].surface.positions) p = p * 1e30f;
  model.nodes[0].scale = {1e30, 1e30, 1e30};
  test::expect_error([&] { found(model); }, ErrorKind::unsupported, "", "floats");
}

TEST(ModelSaliency, SeesTheWholeScene) {
  // A ball and one a tenth of its size: what is contrast on the small one is judged by the scene's scale,
  // and both are in one range.
  Model model = test::model_of({test::icosphere(4), test::torus(40, 20)});
  model.nodes[1].scale = {0.1, 0.1, 0.1};
  model.nodes[1].translation = {2, 0, 0};
  const ModelSaliency s = found(model, with(SaliencyPreset::lee));
  ASSERT_EQ(s.saliency.size(), 2u);
  const auto mean = [](const VertexField& field) {
    double sum = 0;
    for (const float x : field.values()) sum += static_cast<double>(x);
    return sum / static_cast<double>(field.size());
  };
  EXPECT_GT(mean(s.saliency[1]), 3 * mean(s.saliency[0]));  // the ball has no contrast but of its mesh
}

TEST(ModelSaliency, TheSameBitsForAnyNumberOfThreads) {
  const Model model = vase();
  for (const SaliencyPreset preset : kPresets)
    EXPECT_EQ(found(model, with(preset), 1).saliency, found(model, with(preset), 3).saliency);
}

TEST(ModelSaliency, KeyPosesOfTheArmMakeItsElbowStandOut) {
  // Munaretti 2007, figure 4.3: where poses differ there is more to see than in any one of them.
  Context context;
  const Model arm = make_sample("arm", 0.05, context);
  SaliencyOptions options = with(SaliencyPreset::munaretti);
  options.distance = DistanceKind::diffusion;
  const ModelSaliency single = found(arm, options);
  options.key_poses = 4;
  const ModelSaliency poses = found(arm, options);
  EXPECT_EQ(single.poses, std::vector<std::string>{"rest"});
  EXPECT_GT(poses.poses.size(), 1u);
  EXPECT_LE(poses.poses.size(), 4u);
  EXPECT_EQ(map(poses, "geometry-pose-2").size(), arm.meshes.size());
  // How salient the elbow is beside the whole arm.
  const TriMesh& mesh = arm.meshes[0].surface;
  const auto elbow = [&](const ModelSaliency& s) {
    double near = 0, all = 0, count = 0;
    for (std::size_t v = 0; v < mesh.vertex_count(); ++v) {
      const double x = s.saliency[0].values()[v];
      all += x;
      if (std::abs(mesh.positions[v].x - 1.3f) > 0.15f) continue;
      near += x;
      ++count;
    }
    return near / count / (all / static_cast<double>(mesh.vertex_count()));
  };
  EXPECT_LT(elbow(single), 1);
  EXPECT_GT(elbow(poses), 2 * elbow(single));
}

TEST(ModelSaliency, PosesCanBeFiles) {
  const Model model = test::model_of(test::torus(60, 30));
  Model bent = model;
  for (Vec3f& p : bent.meshes[0].surface.positions) p.z += 0.3f * p.x * p.x;
  Context context;
  const ModelSaliency s = model_saliency(model, with(SaliencyPreset::lee), context, {&bent, 1});
  EXPECT_EQ(s.poses, (std::vector<std::string>{"file 1", "file 2"}));
  const VertexField a = map(s, "geometry-pose-1")[0], b = map(s, "geometry-pose-2")[0],
                    both = map(s, "geometry")[0];
  for (std::size_t v = 0; v < a.size(); ++v) {
    const float base = std::min(a.values()[v], b.values()[v]);
    EXPECT_NEAR(both.values()[v], base + (a.values()[v] - base) + (b.values()[v] - base), 1e-5);
  }
  const Model other = test::model_of(test::cube());
  EXPECT_THROW(model_saliency(model, with(SaliencyPreset::lee), context, {&other, 1}), Error);
}

TEST(ModelSaliency, EntropyFindsThePlainFigureOnTheBusyGround) {
  // Yang et al. 2016, figure 4: the vase has a plain figure on a ground full of detail.
  const Model model = vase(0.3);
  SaliencyOptions options = with(SaliencyPreset::yang);
  options.geometry = 0;
  options.entropy_share = 1;
  const ModelSaliency s = found(model, options);
  EXPECT_TRUE(s.textured);
  // On the body the figure's texels are plain, those around it busy; the plain ones stand out, by entropy and
  // not by shape.
  const VertexField& entropy = map(s, "entropy")[0];
  const TriMesh& mesh = model.meshes[0].surface;
  const auto plain_over_busy = [&](const VertexField& field) {
    double sum[2] = {0, 0}, count[2] = {0, 0};
    for (std::size_t v = 0; v < mesh.vertex_count(); ++v) {
      const float bits = entropy.values()[v];
      if (!on_body(mesh.positions[v]) || (bits > 1 && bits < 2.5f)) continue;
      sum[bits > 1] += static_cast<double>(field.values()[v]);
      ++count[bits > 1];
    }
    EXPECT_GT(std::min(count[0], count[1]), 20);
    return sum[0] / count[0] / (sum[1] / count[1]);
  };
  EXPECT_GT(plain_over_busy(s.saliency[0]), 1.5);
}

}  // namespace
}  // namespace fovea
