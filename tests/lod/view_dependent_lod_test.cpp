#include "fovea/lod/view_dependent_lod.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdlib>
#include <initializer_list>
#include <new>
#include <span>

#include "fovea/base/error.h"
#include "fovea/lod/cluster_selection.h"
#include "fovea/lod/error_selection.h"
#include "fovea/lod/uniform_selection.h"
#include "lod/leveled.h"
#include "support/meshes.h"

// Counts what is allocated while it is asked to. Sanitizers have allocators of their own.
#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
#define FOVEA_COUNTS_ALLOCATIONS
namespace {
std::atomic<std::size_t> allocations{0};
}
void* operator new(std::size_t bytes) {
  ++allocations;
  if (void* memory = std::malloc(bytes > 0 ? bytes : 1)) return memory;
  throw std::bad_alloc();
}
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wmismatched-new-delete"  // GCC sees one of the two only
void operator delete(void* memory) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }
#pragma GCC diagnostic pop
#endif

namespace fovea {
namespace {

using test::Leveled;
using test::leveled;

class ViewDependent : public testing::Test {
 protected:
  LevelCamera camera(double angle) const {
    return {view_from({3 * std::cos(angle), 1, 3 * std::sin(angle)}, {}, 40), 800, 600};
  }
  const Leveled model_ = leveled(test::model_of(test::shuffled(test::torus(48, 24))), 0);
  Context context_;
  const VertexHierarchy hierarchy_ = make_vertex_hierarchy(model_.original, model_.levels, context_);
  ErrorSelection selection_{model_.original, model_.levels};
  Contraction contraction_{hierarchy_};
  LevelBudget budget_{.triangles = 400};
};

TEST_F(ViewDependent, EachFrameOfOneHasItsLevel) {
  ViewDependentLod lod(selection_, contraction_);
  for (int i = 0; i < 4; ++i) {
    EXPECT_TRUE(lod.update(camera(i), budget_));
    EXPECT_LE(contraction_.level().triangle_count(), 400u);
    EXPECT_GE(contraction_.level().triangle_count(), 398u);
  }
}

TEST_F(ViewDependent, WorkIsSpreadOverFramesAndTheLevelBeforeStays) {
  ViewDependentLod lod(selection_, contraction_, 5);
  ASSERT_TRUE(lod.update(camera(0), budget_));  // the first is there at once
  const auto first = contraction_.level().indices;
  ErrorSelection again(model_.original, model_.levels);
  Contraction at_once(hierarchy_);
  ViewDependentLod one(again, at_once);
  one.update(camera(1), budget_);
  for (int frame = 0; frame < 4; ++frame) {
    EXPECT_FALSE(lod.update(camera(1 + frame), budget_));  // that of the first of them counts
    EXPECT_TRUE(std::ranges::equal(contraction_.level().of_part(hierarchy_, 0),
                                   std::span(first).first(3 * contraction_.level().triangles[0])));
  }
  EXPECT_TRUE(lod.update(camera(9), budget_));
  EXPECT_TRUE(std::ranges::equal(contraction_.level().of_part(hierarchy_, 0),
                                 at_once.level().of_part(hierarchy_, 0)));
}

#ifdef FOVEA_COUNTS_ALLOCATIONS
TEST_F(ViewDependent, NothingIsAllocatedInAFrame) {
  const SceneSurface scene = scene_surface(model_.original, rest_pose(model_.original));
  const VertexField saliency(scene.surface.positions.size(), 0.5f);
  Clusters clusters;
  clusters.count = 3;
  clusters.of_face = Field<FaceId, std::uint32_t>(scene.surface.triangles.size());
  for (std::size_t f = 0; f < scene.surface.triangles.size(); ++f)
    clusters.of_face[FaceId{f}] = static_cast<std::uint32_t>(f % 3);
  ClusterSelection by_cluster(scene, model_.levels, clusters, cluster_properties(scene, saliency, clusters));
  UniformSelection uniform(model_.levels);
  for (LevelSelection* selection :
       std::initializer_list<LevelSelection*>{&selection_, &by_cluster, &uniform}) {
    ViewDependentLod lod(*selection, contraction_, 2);
    const std::size_t before = allocations;
    for (int i = 0; i < 10; ++i) lod.update(camera(i), budget_);
    EXPECT_EQ(allocations, before);
  }
}
#endif

TEST_F(ViewDependent, NoFrameIsTooFew) { EXPECT_THROW(ViewDependentLod(selection_, contraction_, 0), Error); }

}  // namespace
}  // namespace fovea
