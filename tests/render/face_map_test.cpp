#include "fovea/render/face_map.h"

#include <gtest/gtest.h>

#include <set>

#include "fovea/base/srgb.h"
#include "support/meshes.h"
#include "support/reading.h"

namespace fovea {
namespace {

constexpr std::array<std::array<std::uint8_t, 3>, 2> kColors{{{255, 0, 0}, {0, 255, 0}}};

/// Two columns of triangles, the left ones 0, the right ones 1.
std::vector<FaceNumbers> halves(const TriMesh& grid) {
  FaceNumbers numbers(grid.face_count());
  for (std::size_t f = 0; f < grid.face_count(); ++f) {
    float x = 0;
    for (const VertexId v : grid.triangles[f]) x += grid.positions[v.index()].x / 3;
    numbers[FaceId{f}] = x > 0.5f;
  }
  return {numbers};
}

TEST(FaceMap, BordersAreCrisp) {
  const Model grid = test::model_of(test::grid(4, 3));
  const TriMesh& mesh = grid.meshes[0].surface;
  const std::vector<FaceNumbers> numbers = halves(mesh);
  const Model made = face_map(grid, numbers, kColors);
  const TriMesh& surface = made.meshes[0].surface;
  ASSERT_NO_THROW(check(surface));
  const AttributeLayer* colors = surface.find(Semantic::color);
  ASSERT_NE(colors, nullptr);
  EXPECT_EQ(colors->size(), mesh.vertex_count() + 4) << "the middle column has both";
  for (std::size_t c = 0; c < 3 * mesh.face_count(); ++c) {
    const float* value = colors->value(colors->corner_value[c]);
    const auto& expected = kColors[numbers[0][face_of(CornerId{c})]];
    for (std::size_t i = 0; i < 3; ++i) EXPECT_EQ(value[i], to_light(expected[i]));
  }
  EXPECT_EQ(made.materials.size(), 1u);
  EXPECT_EQ(surface.find(Semantic::uv), nullptr);
}

TEST(FaceMap, WithoutANumberItIsGrey) {
  const Model model = test::model_of(test::single_triangle());
  const Model made = face_map(model, {FaceNumbers(1, kInvalid)}, {});
  EXPECT_EQ(made.meshes[0].surface.find(Semantic::color)->values[0], to_light(128));
  EXPECT_EQ(
      with_face_attribute(model, {FaceNumbers(1, kInvalid)}, "_X").meshes[0].surface.layers.back().values[0],
      -1.0f);
}

TEST(FaceMap, AnAttributeLeavesTheRestAsItIs) {
  const Model grid = test::model_of(test::two_part_grid(4, 3));
  const std::vector<FaceNumbers> numbers = halves(grid.meshes[0].surface);
  const Model once = with_face_attribute(grid, numbers, "_CLUSTER");
  const Model twice = with_face_attribute(once, numbers, "_CLUSTER");
  const TriMesh& surface = twice.meshes[0].surface;
  ASSERT_NO_THROW(check(surface));
  EXPECT_EQ(surface.layers.size(), grid.meshes[0].surface.layers.size() + 1)
      << "one of that name is replaced";
  const AttributeLayer& layer = surface.layers.back();
  EXPECT_EQ(layer.name, "_CLUSTER");
  for (std::size_t c = 0; c < 3 * surface.face_count(); ++c)
    EXPECT_EQ(*layer.value(layer.corner_value[c]), static_cast<float>(numbers[0][face_of(CornerId{c})]));
}

TEST(FaceMap, NumbersMustFit) {
  const Model model = test::model_of(test::cube());
  test::expect_error([&] { face_map(model, {}, kColors); }, ErrorKind::usage, "", "another model");
  test::expect_error([&] { with_face_attribute(model, {FaceNumbers(3)}, "_X"); }, ErrorKind::usage, "",
                     "another model");
}

}  // namespace
}  // namespace fovea
