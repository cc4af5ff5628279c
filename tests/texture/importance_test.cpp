#include "fovea/texture/importance.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "fovea/base/error.h"
#include "support/meshes.h"
#include "support/reading.h"
#include "support/textured.h"

namespace fovea {
namespace {

constexpr int kSide = 64;

double at(const ImageF& map, double u, double v) {
  return static_cast<double>(*map.at(static_cast<int>(u * map.width), static_cast<int>(v * map.height)));
}

TextureImportance importance(const Model& model, const std::vector<VertexField>& field = {}) {
  Context context;
  return texture_importance(model, find_atlases(model).at(0), field, kSide, context);
}

/// A grid of two columns; the surface of the right one is stretched along x.
Model stretched(float factor) {
  TriMesh mesh = test::grid(2, 1);
  for (Vec3f& p : mesh.positions) {
    if (p.x > 0.5f) p.x = 0.5f + (p.x - 0.5f) * factor;
  }
  return test::textured(std::move(mesh), 1);
}

TEST(TextureImportance, CoverageIsSurfacePerTexture) {
  const TextureImportance maps = importance(stretched(3));
  EXPECT_NEAR(at(maps.coverage, 0.25, 0.5), 0.5, 1e-5);
  EXPECT_NEAR(at(maps.coverage, 0.75, 0.5), 1.5, 1e-5);
}

TEST(TextureImportance, DistortionIsTheSmallestSingularValueTurnedOver) {
  const TextureImportance maps = importance(stretched(3));
  // From the surface to the texture the right triangles have 1/3 and 1, the left ones 1 and 1.
  EXPECT_NEAR(at(maps.distortion, 0.005, 0.5), 1.0 / 3, 0.02);
  EXPECT_NEAR(at(maps.distortion, 0.995, 0.5), 1, 0.02);
  // Shared values have the mean by area: (1/3 + 3) / 4.
  EXPECT_NEAR(at(maps.distortion, 0.5, 0.5), (1.0 / 3 + 3) / 4, 0.05);
}

TEST(TextureImportance, LargestInstanceCounts) {
  Model model = stretched(1);
  model.meshes.push_back(model.meshes[0]);
  Node node;
  node.mesh = 1;
  node.scale = {2, 2, 2};
  model.nodes.push_back(node);
  model.scenes.at(0).nodes.push_back(static_cast<int>(model.nodes.size()) - 1);
  // Both lie on the same texels; the first is what is seen there.
  const TextureImportance maps = importance(model);
  EXPECT_NEAR(at(maps.coverage, 0.5, 0.5), 2.0 / 5, 1e-5);
}

TEST(TextureImportance, SaliencyIsTheFieldOverTriangles) {
  const Model model = stretched(1);
  const TriMesh& mesh = model.meshes[0].surface;
  VertexField field(mesh.vertex_count());
  for (std::size_t v = 0; v < field.size(); ++v) field[VertexId(v)] = mesh.positions[v].x;
  const TextureImportance maps = importance(model, {field});
  for (const double u : {0.1, 0.4, 0.9}) EXPECT_NEAR(at(maps.saliency, u, 0.3), u, 1.0 / kSide);
  EXPECT_EQ(at(importance(model).saliency, 0.4, 0.3), 1);
  const auto error = test::error_of([&] { importance(model, {field, field}); });
  ASSERT_TRUE(error);
  EXPECT_EQ(error->kind(), ErrorKind::usage);
}

TEST(TextureImportance, CombinesAsThePapersSay) {
  TextureImportance maps;
  const auto one = [](float x) {
    ImageF image(1, 1, 1, ColorEncoding::linear);
    image.pixels[0] = x;
    return image;
  };
  maps.saliency = one(0.5f), maps.distortion = one(0.25f), maps.coverage = one(2), maps.detail = one(0.0625f);
  EXPECT_FLOAT_EQ(saliency_importance(maps).pixels[0], 0.125f);
  EXPECT_FLOAT_EQ(frequency_importance(maps).pixels[0], 0.25f);
  EXPECT_FLOAT_EQ(balanced_importance(maps).pixels[0], 0.5f);
}

}  // namespace
}  // namespace fovea
