#include "fovea/gpu/gpu_contraction.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <string>

#include "fovea/base/error.h"
#include "fovea/gpu/gpu_context.h"
#include "fovea/lod/cut.h"
#include "fovea/lod/error_selection.h"
#include "fovea/lod/view_dependent_lod.h"
#include "gpu/with_gpu.h"
#include "lod/leveled.h"
#include "support/meshes.h"

namespace fovea {
namespace {

using test::Leveled;
using test::leveled;

class GpuContractionTest : public test::WithGpu {};

void expect_same(const LevelIndices& a, const LevelIndices& b, const VertexHierarchy& hierarchy,
                 const std::string& name) {
  ASSERT_EQ(a.triangles, b.triangles) << name;
  for (std::size_t p = 0; p < hierarchy.parts.size(); ++p)
    EXPECT_TRUE(std::ranges::equal(a.of_part(hierarchy, p), b.of_part(hierarchy, p))) << name << " " << p;
}

TEST_F(GpuContractionTest, HasTheBitsOfTheProcessor) {
  for (const auto& [name, mesh] : test::all_families()) {
    const Leveled model = leveled(test::model_of(mesh), 0);
    const VertexHierarchy hierarchy = make_vertex_hierarchy(model.original, model.levels, context_);
    ErrorSelection selection(model.original, model.levels);
    Contraction processor(hierarchy);
    GpuContraction card(hierarchy);
    for (const double share : {0.0, 0.05, 0.35, 0.6, 1.0}) {
      LevelBudget budget;
      budget.triangles = static_cast<std::uint64_t>(share * static_cast<double>(model.levels.triangles));
      selection.begin({view_from({2, 3, 1.5}, {}, 40), 800, 600}, budget);
      selection.advance(selection.total_work());
      processor.begin(selection.taken());
      processor.advance(processor.total_work());
      card.begin(selection.taken());
      EXPECT_TRUE(card.advance(card.total_work()));
      expect_same(card.read_back(), processor.level(), hierarchy, name);
    }
  }
}

TEST_F(GpuContractionTest, OfManyBlocksAndParts) {
  // More than a group adds up at once: 256 blocks of 256 triangles.
  Model model = test::model_of({test::shuffled(test::torus(300, 120)), test::shuffled(test::torus(40, 30))});
  TriMesh& first = model.meshes[0].surface;
  first.parts.push_back(first.parts[0]);
  for (std::size_t f = 0; f < first.face_count(); f += 5) first.face_part[f] = 1;
  const Leveled many = leveled(std::move(model), 1000);
  const VertexHierarchy hierarchy = make_vertex_hierarchy(many.original, many.levels, context_);
  ErrorSelection selection(many.original, many.levels);
  Contraction processor(hierarchy);
  GpuContraction card(hierarchy);
  for (const std::uint64_t triangles : {2000u, 30000u, 70000u}) {
    selection.begin({view_from({2, 3, 1.5}, {}, 40), 800, 600}, {.triangles = triangles});
    selection.advance(selection.total_work());
    processor.begin(selection.taken());
    processor.advance(processor.total_work());
    card.begin(selection.taken());
    int pieces = 1;
    while (!card.advance(10'000)) ++pieces;
    EXPECT_GT(pieces, 10);
    expect_same(card.read_back(), processor.level(), hierarchy, std::to_string(triangles));
  }
}

TEST_F(GpuContractionTest, TheLevelBeforeStaysUntilTheNextIsDone) {
  const Leveled model = leveled(test::model_of(test::shuffled(test::torus(48, 24))), 0);
  const VertexHierarchy hierarchy = make_vertex_hierarchy(model.original, model.levels, context_);
  ErrorSelection selection(model.original, model.levels);
  GpuContraction card(hierarchy);
  ViewDependentLod lod(selection, card, 4);
  ASSERT_TRUE(lod.update({view_from({2, 3, 1.5}, {}, 40), 800, 600}, {.triangles = 300}));
  const LevelIndices before = card.read_back();
  for (int frame = 0; frame < 3; ++frame) {
    EXPECT_FALSE(lod.update({view_from({-2, 3, 1.5}, {}, 40), 800, 600}, {.triangles = 900}));
    expect_same(card.read_back(), before, hierarchy, "before");
  }
  EXPECT_TRUE(lod.update({view_from({-2, 3, 1.5}, {}, 40), 800, 600}, {.triangles = 900}));
  EXPECT_GT(card.read_back().triangle_count(), 890u);
}

TEST(GpuContext, WithoutOneItIsSaidSo) {
  const Leveled model = leveled(test::model_of(test::torus(24, 12)), 0);
  Context context;
  const VertexHierarchy hierarchy = make_vertex_hierarchy(model.original, model.levels, context);
  bool has_driver = true;
  try {
    const GpuContext gpu;
    EXPECT_FALSE(gpu.device().empty());
  } catch (const Error&) {
    has_driver = false;
  }
  if (!has_driver) GTEST_SKIP() << "no driver";
  EXPECT_THROW(GpuContraction{hierarchy}, Error);  // none is current any more
}

}  // namespace
}  // namespace fovea
