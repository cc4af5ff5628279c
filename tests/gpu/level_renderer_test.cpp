#include "fovea/gpu/level_renderer.h"

#include <gtest/gtest.h>

#include "fovea/lod/error_selection.h"
#include "fovea/lod/level_model.h"
#include "fovea/render/render.h"
#include "gpu/with_gpu.h"
#include "lod/leveled.h"
#include "support/meshes.h"

namespace fovea {
namespace {

constexpr int kSize = 128;

class LevelRendererTest : public test::WithGpu {};

std::size_t covered(const Image8& image) {
  std::size_t count = 0;
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) count += image.at(x, y)[0] != 128;
  }
  return count;
}

TEST_F(LevelRendererTest, DrawsTheSameFromBothSides) {
  for (const bool perspective : {true, false}) {
    const test::Leveled model = test::leveled(
        test::model_of({test::shuffled(test::torus(64, 32)), test::shuffled(test::torus(40, 30))}), 100);
    const VertexHierarchy hierarchy = make_vertex_hierarchy(model.original, model.levels, context_);
    ErrorSelection selection(model.original, model.levels);
    Contraction processor(hierarchy);
    GpuContraction card(hierarchy);
    LevelRenderer renderer(model.original, hierarchy, kSize, kSize);
    LevelCamera camera{view_from({2, 3, 2.5}, {}, perspective ? 40 : 0), kSize, kSize};
    if (!perspective) camera.view.half_height = 1.6;
    selection.begin(camera, {.triangles = 1500});
    selection.advance(selection.total_work());
    processor.begin(selection.taken());
    processor.advance(processor.total_work());
    card.begin(selection.taken());
    card.advance(card.total_work());
    renderer.draw(camera, processor.level());
    const Image8 from_processor = renderer.picture();
    renderer.draw(camera);
    const Image8 full = renderer.picture();
    renderer.draw(camera, card);
    EXPECT_EQ(renderer.picture().pixels, from_processor.pixels);
    EXPECT_NE(full.pixels, from_processor.pixels);
    EXPECT_GT(covered(full), 1000u);

    // The same places as the reference rasteriser covers, but for pixels on the edge and those of the surface
    // that are as grey as the background.
    const RenderScene scene = make_render_scene(model.original, rest_pose(model.original), context_);
    const VisibleSurface visible = visible_surface(scene, camera.view, kSize, kSize, context_);
    std::size_t different = 0;
    for (int y = 0; y < kSize; ++y) {
      for (int x = 0; x < kSize; ++x) {
        const bool is_covered = visible.triangle[static_cast<std::size_t>(y * kSize + x)] != kInvalid;
        different += is_covered != (full.at(x, y)[0] != 128);
      }
    }
    EXPECT_LT(different, 80u);
  }
}

TEST_F(LevelRendererTest, AModelOfTheLevelHasItsTriangles) {
  for (const auto& [name, mesh] : test::all_families()) {
    const test::Leveled model = test::leveled(test::model_of(mesh), 0);
    const VertexHierarchy hierarchy = make_vertex_hierarchy(model.original, model.levels, context_);
    ErrorSelection selection(model.original, model.levels);
    Contraction contraction(hierarchy);
    selection.begin({view_from({2, 3, 1.5}, {}, 40), 800, 600}, {.triangles = mesh.face_count() / 2});
    selection.advance(selection.total_work());
    contraction.begin(selection.taken());
    contraction.advance(contraction.total_work());
    const Model level = model_of_level(model.original, hierarchy, contraction.level());
    EXPECT_EQ(level.meshes[0].surface.face_count(), contraction.level().triangle_count()) << name;
    EXPECT_NO_THROW(check(level.meshes[0].surface)) << name;
  }
}

}  // namespace
}  // namespace fovea
