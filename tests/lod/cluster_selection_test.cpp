#include "fovea/lod/cluster_selection.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "fovea/base/error.h"
#include "fovea/lod/cluster_importance.h"
#include "fovea/lod/cut.h"
#include "fovea/lod/level_cracks.h"
#include "lod/leveled.h"
#include "support/meshes.h"

namespace fovea {
namespace {

using test::is_closed;
using test::Leveled;
using test::leveled;

/// A torus around z in sectors. With 64 the contractions that are dealt out run out before each has some, as
/// each gets 0.02 of the whole.
struct Sectors {
  Leveled model = leveled(test::model_of(test::shuffled(test::torus(64, 32))), 0);
  SceneSurface scene = scene_surface(model.original, rest_pose(model.original));
  VertexField saliency = VertexField(scene.surface.positions.size(), 0.5f);
  Clusters clusters;

  explicit Sectors(std::uint32_t count) {
    clusters.count = count;
    clusters.of_face = Field<FaceId, std::uint32_t>(scene.surface.triangles.size());
    for (std::size_t f = 0; f < scene.surface.triangles.size(); ++f) {
      const Vec3f p = scene.surface.positions[scene.surface.triangles[f][0]];
      const double turn = 0.5 + std::atan2(p.y, p.x) / (2 * std::numbers::pi);
      clusters.of_face[FaceId{f}] =
          std::min(count - 1, static_cast<std::uint32_t>(turn * static_cast<double>(count)));
    }
  }
  ClusterSelection selection(ClusterMatching matching = ClusterMatching::hold) const {
    return {scene, model.levels, clusters, cluster_properties(scene, saliency, clusters), {matching}};
  }
  Cut cut(ClusterSelection& selection, Vec3d eye, std::uint64_t triangles) const {
    selection.begin({view_from(eye, {}, 40), 600, 600}, {.triangles = triangles});
    selection.advance(selection.total_work());
    Cut cut(model.levels.step_count());
    for (std::size_t s = 0; s < cut.size(); ++s) cut[s] = selection.taken().has(s);
    return cut;
  }
  /// Triangles left on each side.
  std::pair<std::size_t, std::size_t> sides(const Cut& cut) const {
    const TriMesh mesh = level_of(model.original, model.levels, cut).meshes[0].surface;
    std::size_t below = 0;
    for (const auto& t : mesh.triangles) below += mesh.positions[t[0].index()].x < 0;
    return {below, mesh.face_count() - below};
  }
};

TEST(ClusterSelection, IsACutOfAtMostSoManyTriangles) {
  const Sectors it(64);
  Context context;
  const VertexHierarchy hierarchy = make_vertex_hierarchy(it.model.original, it.model.levels, context);
  const CrackFinder cracks(hierarchy);
  for (const ClusterMatching matching : {ClusterMatching::hold, ClusterMatching::raise}) {
    ClusterSelection selection = it.selection(matching);
    for (const std::uint64_t triangles : {300u, 1000u, 2500u}) {
      const Cut cut = it.cut(selection, {5, 1, 0}, triangles);
      EXPECT_TRUE(is_closed(it.model.levels, cut));
      const std::uint64_t left = triangles_of(it.model.levels, cut);
      EXPECT_LE(left, triangles);
      if (matching == ClusterMatching::hold) {
        EXPECT_GE(left, 0.9 * static_cast<double>(triangles));
      }
      EXPECT_EQ(cracks.count(selection.taken()), 0u);
    }
  }
}

TEST(ClusterSelection, WhatLooksImportantIsFiner) {
  Sectors it(64);
  // Near one side of two alike.
  ClusterSelection near = it.selection();
  const auto [far_side, near_side] = it.sides(it.cut(near, {2.5, 0, 0.1}, 1500));
  EXPECT_GT(near_side, 1.1 * static_cast<double>(far_side));
  // The salient one of two equally far.
  for (std::size_t v = 0; v < it.saliency.size(); ++v)
    it.saliency.values()[v] = it.scene.surface.positions[v].x < 0 ? 1.0f : 0.2f;
  ClusterSelection salient = it.selection();
  const auto [salient_side, dull_side] = it.sides(it.cut(salient, {0, 0, 5}, 1500));
  EXPECT_GT(salient_side, 1.1 * static_cast<double>(dull_side));
}

TEST(ClusterSelection, ImportanceIsThatOfTheThesis) {
  const Sectors it(2);
  ClusterSelection selection = it.selection();
  const Vec3d eye{4, 0.5, 1};
  it.cut(selection, eye, 1000);
  const auto properties = cluster_properties(it.scene, it.saliency, it.clusters);
  double total = 0;
  for (const ClusterProperties& p : properties) total += p.total_saliency;
  for (std::size_t c = 0; c < 2; ++c) {
    // Closed halves have normals in all directions: facing is 1.
    const ClusterProperties& p = properties[c];
    ASSERT_GT(p.peak_deviation, std::numbers::pi / 2);
    const double distance = length(eye - p.sphere.center) - p.sphere.radius;
    const double expected = p.area / distance * p.total_saliency * p.peak_saliency * p.mean_saliency / total;
    EXPECT_NEAR(selection.importance()[c], expected, 1e-9 * expected);
  }
}

TEST(ClusterSelection, InPiecesIsTheSame) {
  const Sectors it(2);
  ClusterSelection whole = it.selection(), pieces = it.selection();
  const Cut cut = it.cut(whole, {5, 1, 0}, 1000);
  pieces.begin({view_from({5, 1, 0}, {}, 40), 600, 600}, {.triangles = 1000});
  while (!pieces.advance(77)) {
  }
  EXPECT_EQ(pieces.taken(), whole.taken());
}

TEST(ClusterSelection, OtherClustersAreRefused) {
  const Sectors it(2);
  Clusters other;
  other.count = 1;
  other.of_face = Field<FaceId, std::uint32_t>(3);
  EXPECT_THROW(ClusterSelection(it.scene, it.model.levels, other, {{}}), Error);
}

TEST(ClusterImportance, KeepsWhatStandsOutWithinEachCluster) {
  Sectors it(2);
  // One side is salient throughout; on the other a spot stands out a little.
  const auto is_spot = [&](std::size_t v) { return it.scene.surface.positions[v].y > 1.2f; };
  for (std::size_t v = 0; v < it.saliency.size(); ++v) {
    const float y = it.scene.surface.positions[v].y;
    it.saliency.values()[v] = y < 0 ? 0.8f + 0.1f * y : is_spot(v) ? 0.3f : 0.1f;
  }
  Context context;
  const Importance importance =
      cluster_importance(it.model.original, it.scene, it.saliency, it.clusters, context);
  double spot = 0, rest = 0;
  std::size_t spots = 0, rests = 0;
  for (std::size_t v = 0; v < it.saliency.size(); ++v) {
    const float y = it.scene.surface.positions[v].y;
    if (is_spot(v)) {
      spot += importance[0].values()[v];
      ++spots;
    } else if (y > 0.1f && y < 1) {
      rest += importance[0].values()[v];
      ++rests;
    }
  }
  ASSERT_GT(spots, 0u);
  EXPECT_GT(spot / static_cast<double>(spots), 10 * rest / static_cast<double>(rests));
}

TEST(CrackFinder, FindsAnOpenEdge) {
  // A step that takes its triangles without moving the others' corners: half of what a collapse does.
  const Sectors it(2);
  Context context;
  VertexHierarchy hierarchy = make_vertex_hierarchy(it.model.original, it.model.levels, context);
  StepBits taken(it.model.levels.step_count());
  taken.set(0, true);
  EXPECT_EQ(CrackFinder(hierarchy).count(taken), 0u);
  for (std::uint32_t& step : hierarchy.step) step = step == 0 ? kInvalid : step;
  EXPECT_EQ(CrackFinder(hierarchy).count(taken), 4u);  // around the hole of two triangles
}

TEST(CrackFinder, BordersAreNone) {
  const Leveled model = leveled(test::model_of(test::shuffled(test::grid(20, 20))), 0);
  Context context;
  const VertexHierarchy hierarchy = make_vertex_hierarchy(model.original, model.levels, context);
  for (const std::size_t count : {std::size_t{0}, model.levels.step_count() / 2, model.levels.step_count()}) {
    StepBits taken(model.levels.step_count());
    for (std::size_t s = 0; s < count; ++s) taken.set(s, true);
    EXPECT_EQ(CrackFinder(hierarchy).count(taken), 0u);
  }
}

}  // namespace
}  // namespace fovea
