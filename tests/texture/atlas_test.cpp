#include "fovea/texture/atlas.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

#include "fovea/io/image_codec.h"
#include "support/meshes.h"
#include "support/pictures.h"
#include "support/textured.h"

namespace fovea {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

/// Moves all texture coordinates of a mesh.
void shift(TriMesh& mesh, float u, float v) {
  AttributeLayer& layer = *mesh.find(Semantic::uv);
  for (std::size_t i = 0; i < layer.values.size(); i += 2) layer.values[i] += u, layer.values[i + 1] += v;
}

std::string why_fixed(const Model& model) { return find_atlases(model).at(0).fixed_because; }

TEST(FindAtlases, ImagesOfOneMaterialAreTogether) {
  const std::vector<Atlas> atlases = find_atlases(test::textured(test::grid(2, 2), 2));
  ASSERT_EQ(atlases.size(), 1u);
  EXPECT_THAT(atlases[0].images, ElementsAre(0, 1));
  EXPECT_THAT(atlases[0].parts, ElementsAre(AtlasPart{0, 0, 0}));
  EXPECT_THAT(atlases[0].fixed_because, IsEmpty());
}

TEST(FindAtlases, MaterialsOfOtherPartsAreApartUnlessTheyShareAnImage) {
  Model model = test::textured(test::two_part_grid(2, 1), 1);
  model.images.push_back(model.images[0]);
  model.textures.push_back({1, -1, "", ""});
  model.materials[1] = model.materials[0];
  model.materials[1].base_color->texture = 1;
  std::vector<Atlas> atlases = find_atlases(model);
  ASSERT_EQ(atlases.size(), 2u);
  EXPECT_THAT(atlases[1].images, ElementsAre(1));
  EXPECT_THAT(atlases[1].parts, ElementsAre(AtlasPart{0, 1, 0}));
  model.materials[1].normal = TextureRef{0, 0, {}};
  atlases = find_atlases(model);
  ASSERT_EQ(atlases.size(), 1u);
  EXPECT_THAT(atlases[0].images, ElementsAre(0, 1));
  EXPECT_EQ(atlases[0].parts.size(), 2u);
}

TEST(FindAtlases, VariantsJoinTheirImages) {
  Model model = test::textured(test::grid(2, 2), 1);
  model.images.push_back(model.images[0]);
  model.textures.push_back({1, -1, "", ""});
  model.materials.push_back(model.materials[0]);
  model.materials[1].base_color->texture = 1;
  // Nothing shows the second material: somebody may yet, by other coordinates.
  EXPECT_THAT(find_atlases(model).at(1).fixed_because, HasSubstr("nothing shows"));
  model.meshes[0].surface.parts[0].json =
      R"({"extensions": {"KHR_materials_variants": {"mappings": [{"material": 1, "variants": [0]}]}}})";
  const std::vector<Atlas> atlases = find_atlases(model);
  ASSERT_EQ(atlases.size(), 1u);
  EXPECT_THAT(atlases[0].images, ElementsAre(0, 1));
  EXPECT_THAT(atlases[0].fixed_because, IsEmpty());
}

TEST(FindAtlases, SaysWhyTexelsCannotMove) {
  const Model good = test::textured(test::grid(2, 2), 1);
  Model model = good;
  model.images[0].bytes = {1, 2, 3};
  EXPECT_THAT(why_fixed(model), HasSubstr("cannot be decoded"));
  model = good;
  model.materials[0].normal = model.materials[0].base_color;
  EXPECT_THAT(why_fixed(model), HasSubstr("different ways"));
  model = good;
  model.materials[0].base_color->transform = TextureTransform{{0, 0}, 0, {2, 2}};
  EXPECT_THAT(why_fixed(model), HasSubstr("transform"));
  model.materials[0].base_color->transform = TextureTransform{};
  EXPECT_THAT(why_fixed(model), IsEmpty());
  model = good;
  model.materials[0].base_color->uv_set = 1;
  EXPECT_THAT(why_fixed(model), HasSubstr("no texture coordinates"));
  model = good;
  model.meshes[0].surface.find(Semantic::uv)->values[0] = std::numeric_limits<float>::quiet_NaN();
  EXPECT_THAT(why_fixed(model), HasSubstr("not a number"));
  model = good;
  shift(model.meshes[0].surface, 0.5f, 0);
  EXPECT_THAT(why_fixed(model), HasSubstr("tiled"));
  model.samplers = {{Wrap::clamp, Wrap::clamp, {}, {}, ""}};
  model.textures[0].sampler = 0;
  EXPECT_THAT(why_fixed(model), HasSubstr("does not repeat"));
}

TEST(FindAtlases, ChartsInOtherRepeatsAreInsideTheImage) {
  Model model = test::textured(test::grid(2, 2), 1);
  shift(model.meshes[0].surface, 3, -2);
  EXPECT_THAT(why_fixed(model), IsEmpty());
  for (const AtlasFace& face : atlas_faces(model, find_atlases(model)[0])) {
    for (const Vec2d uv : face.uv) EXPECT_TRUE(uv.x >= 0 && uv.x <= 1 && uv.y >= 0 && uv.y <= 1);
  }
}

TEST(AtlasFaces, ShareValuesAsTheLayerDoes) {
  const Model model = test::textured(test::cube(), 1);
  const std::vector<AtlasFace> faces = atlas_faces(model, find_atlases(model)[0]);
  ASSERT_EQ(faces.size(), 12u);
  std::vector<std::uint32_t> values;
  for (const AtlasFace& face : faces) values.insert(values.end(), face.value.begin(), face.value.end());
  std::ranges::sort(values);
  values.erase(std::unique(values.begin(), values.end()), values.end());
  EXPECT_EQ(values.size(), 24u);  // six charts of four
}

Model moved(const Model& model, const Atlas& atlas, const std::function<Vec2d(Vec2d)>& f) {
  const std::vector<AtlasFace> from = atlas_faces(model, atlas);
  std::vector<AtlasFace> to = from;
  for (AtlasFace& face : to)
    for (Vec2d& uv : face.uv) uv = f(uv);
  return with_moved_coordinates(model, atlas, from, to);
}

TEST(WithMovedCoordinates, MovesAllCornersAndKeepsRepeats) {
  Model model = test::textured(test::grid(2, 2), 1);
  shift(model.meshes[0].surface, 1, 0);
  const Atlas atlas = find_atlases(model)[0];
  const Model after_all = moved(model, atlas, [](Vec2d uv) { return Vec2d{uv.x * uv.x, uv.y / 2}; });
  check(after_all.meshes[0].surface);
  const AttributeLayer &before = *model.meshes[0].surface.find(Semantic::uv),
                       &after = *after_all.meshes[0].surface.find(Semantic::uv);
  ASSERT_EQ(before.values.size(), after.values.size());
  for (std::size_t i = 0; i < before.values.size(); i += 2) {
    EXPECT_FLOAT_EQ(after.values[i], 1 + (before.values[i] - 1) * (before.values[i] - 1));
    EXPECT_FLOAT_EQ(after.values[i + 1], before.values[i + 1] / 2);
  }
}

TEST(WithMovedCoordinates, LeavesWhatOtherPartsUse) {
  // Both parts use the values along their border; the second's material has no texture.
  const Model model = test::textured(test::two_part_grid(2, 1), 1);
  const Atlas atlas = find_atlases(model)[0];
  ASSERT_THAT(atlas.parts, ElementsAre(AtlasPart{0, 0, 0}));
  const Model after = moved(model, atlas, [](Vec2d) { return Vec2d{0.25, 0.75}; });
  const TriMesh& mesh = after.meshes[0].surface;
  check(mesh);
  const AttributeLayer &layer = *mesh.find(Semantic::uv),
                       &before = *model.meshes[0].surface.find(Semantic::uv);
  for (std::size_t c = 0; c < layer.corner_value.size(); ++c) {
    const float* uv = layer.value(layer.corner_value[c]);
    const float* was = before.value(before.corner_value[c]);
    if (mesh.face_part[c / 3] == 0) {
      EXPECT_EQ(uv[0], 0.25f);
    } else {
      EXPECT_EQ(uv[0], was[0]);
    }
  }
}

}  // namespace
}  // namespace fovea
