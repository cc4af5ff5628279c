#include "fovea/lod/multi_tessellation.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "fovea/base/error.h"
#include "fovea/judge/surface_distance.h"
#include "fovea/lod/cut.h"
#include "fovea/surface/surface.h"
#include "lod/leveled.h"
#include "support/meshes.h"

namespace fovea {
namespace {

using test::Leveled;
using test::leveled;

TEST(MultiTessellation, AStepNeedsThoseThatMadeWhatItReplaces) {
  // A strip of quads that loses a vertex at each end: neither needs the other, as no triangle is common.
  const Leveled model = leveled(test::model_of(test::grid(12, 1)), 22);
  ASSERT_EQ(model.levels.step_count(), 2u);
  EXPECT_TRUE(model.levels.needs_of(0).empty());
  const CollapseRecord& record = model.levels.record;
  std::set<std::uint32_t> first, second;
  for (const std::uint32_t v : model.levels.corners_of(0)) first.insert(v);
  for (const std::uint32_t v : model.levels.corners_of(1)) second.insert(v);
  const bool apart =
      first.count(record.steps[1].removed.value) + first.count(record.steps[1].kept.value) == 0;
  EXPECT_EQ(model.levels.needs_of(1).empty(), apart);
}

TEST(MultiTessellation, NeedsComeBefore) {
  for (const auto& [name, mesh] : test::all_families()) {
    const Leveled model = leveled(test::model_of(mesh), 0);
    for (std::size_t s = 0; s < model.levels.step_count(); ++s) {
      const auto needs = model.levels.needs_of(s);
      EXPECT_TRUE(std::is_sorted(needs.begin(), needs.end())) << name;
      if (!needs.empty()) {
        EXPECT_LT(needs.back(), s) << name;
      }
      for (const std::uint32_t n : needs) EXPECT_GE(model.levels.error[s], model.levels.error[n]) << name;
    }
  }
}

TEST(MultiTessellation, ErrorsHoldAgainstTheOriginal) {
  // Measured with points of its own, and to points of surfaces rather than of triangles: up to rounding.
  for (const TriMesh& mesh : {test::icosphere(4), test::torus(48, 24), test::wavy_grid(40, 40, 0.05)}) {
    const Leveled model = leveled(test::model_of(mesh), 40);
    Context context;
    for (const double error : {0.002, 0.01, 0.05}) {
      const Cut cut = cut_at_error(model.levels, error);
      const Surface level = surface_of(level_of(model.original, model.levels, cut).meshes[0].surface);
      EXPECT_LE(surface_distance(surface_of(mesh), level, 50'000, context).hausdorff(), error);
    }
  }
}

TEST(MultiTessellation, FlatPartsLoseNothing) {
  const Leveled model = leveled(test::model_of(test::grid(16, 16)), 40);
  // Borders hold vertices only to about the root of what single precision leaves of a quadric.
  for (const float error : model.levels.error) EXPECT_LT(error, 3e-4f);
}

TEST(MultiTessellation, TrianglesThatAreUpsideDownAreOffByHalfTheirHeight) {
  // An edge inside the grid collapses. In its plane no point is off, wherever the vertex goes that is left:
  // to the other end, or across the triangles around it, which turns some that are about an eighth high.
  TriMesh mesh = test::grid(8, 8);
  mesh.layers.clear();
  const VertexId removed{40u}, kept{41u};
  CollapseRecord record;
  record.triangles_before = mesh.face_count();
  for (std::uint32_t f = 0; f < mesh.face_count(); ++f) {
    const auto& t = mesh.triangles[f];
    if (std::ranges::count(t, removed) + std::ranges::count(t, kept) == 2)
      record.removed_faces.push_back(FaceId{f});
  }
  ASSERT_EQ(record.removed_faces.size(), 2u);
  CollapseStep& step = record.steps.emplace_back();
  step.removed = removed;
  step.kept = kept;
  step.faces_end = 2;
  const Model model = test::model_of(mesh);
  Context context;
  EXPECT_LT(make_multi_tessellation(model, record, context).error[0], 1e-6f);
  step.moved = true;
  step.position = Vec3f(0.82f, 0.55f, 0);
  EXPECT_GT(make_multi_tessellation(model, record, context).error[0], 1.0f / 32);
}

TEST(MultiTessellation, ErrorsAreOfTheLargestInstance) {
  Model model = test::model_of(test::wavy_grid(20, 20, 0.1));
  const Leveled small = leveled(model, 100);
  for (Node& node : model.nodes) node.scale = {3, 3, 3};
  const Leveled large = leveled(model, 100);
  ASSERT_EQ(small.levels.step_count(), large.levels.step_count());
  for (std::size_t s = 0; s < small.levels.step_count(); ++s)
    EXPECT_NEAR(large.levels.error[s], 3 * small.levels.error[s], 1e-5) << s;
}

TEST(MultiTessellation, WhatVanishesCountsWithItsSize) {
  const Leveled model = leveled(test::model_of(test::tetrahedra(4)), 4);
  float largest = 0;
  for (std::size_t s = 0; s < model.levels.step_count(); ++s) {
    if (model.levels.record.steps[s].kind == StepKind::vanish)
      largest = std::max(largest, model.levels.error[s]);
  }
  EXPECT_GT(largest,
            0.25f);  // of the second largest of sizes 1, 1/2, 1/4 and 1/8, which is as large as it is wide
}

TEST(MultiTessellation, IsTheSameForAnyNumberOfThreads) {
  const Model model = test::model_of(test::torus(60, 30));
  const Leveled one = leveled(model, 100, 1), two = leveled(model, 100, 2);
  EXPECT_EQ(one.levels.needs, two.levels.needs);
  EXPECT_EQ(one.levels.corners, two.levels.corners);
  EXPECT_EQ(one.levels.error, two.levels.error);
}

TEST(MultiTessellation, ForeignRecordsAreRefused) {
  const Leveled model = leveled(test::model_of(test::torus(24, 12)), 100);
  Context context;
  EXPECT_THROW(make_multi_tessellation(test::model_of(test::grid(4, 4)), model.levels.record, context),
               Error);
  CollapseRecord wrong = model.levels.record;
  wrong.steps[3].kept = VertexId{100'000};
  EXPECT_THROW(make_multi_tessellation(model.original, wrong, context), Error);
  wrong = model.levels.record;
  wrong.removed_faces[0] = FaceId{100'000};
  EXPECT_THROW(make_multi_tessellation(model.original, wrong, context), Error);
}

TEST(MultiTessellation, CanBeCancelled) {
  Leveled model = leveled(test::model_of(test::torus(24, 12)), 100);
  Context context;
  context.cancel();
  EXPECT_THROW(make_multi_tessellation(model.original, model.levels.record, context), Error);
}

}  // namespace
}  // namespace fovea
