#include "fovea/model/texture_use.h"

#include <gtest/gtest.h>

#include <numbers>

namespace fovea {
namespace {

/// Texture 0 shows image 1 through sampler 0, texture 1 image 0 without one, texture 2 nothing.
Model model_with_textures() {
  Model model;
  model.images.resize(2);
  model.samplers.resize(1);
  model.samplers[0].wrap_u = Wrap::mirror;
  model.samplers[0].wrap_v = Wrap::clamp;
  model.textures.resize(3);
  model.textures[0].image = 1;
  model.textures[0].sampler = 0;
  model.textures[1].image = 0;
  return model;
}

TEST(TextureUse, FollowsAReferenceToItsImage) {
  const Model model = model_with_textures();
  TextureRef ref{0, 3, {}};
  ref.transform = TextureTransform{{0.25, 0.5}, 0, {2, 4}};
  const auto use = resolve(model, ref);
  ASSERT_TRUE(use);
  EXPECT_EQ(use->image, 1);
  EXPECT_EQ(use->uv_set, 3);
  EXPECT_EQ(use->sampler.wrap_u, Wrap::mirror);
  EXPECT_EQ(use->sampler.wrap_v, Wrap::clamp);
  EXPECT_EQ(use->matrix({1, 1}), (Vec2d{2.25, 4.5}));
  EXPECT_EQ(image_of(model, ref), 1);
}

TEST(TextureUse, WithoutASamplerTexturesRepeat) {
  const auto use = resolve(model_with_textures(), TextureRef{1, 0, {}});
  ASSERT_TRUE(use);
  EXPECT_EQ(use->image, 0);
  EXPECT_EQ(use->sampler.wrap_u, Wrap::repeat);
  EXPECT_EQ(use->matrix, UvMatrixd{});
}

TEST(TextureUse, NoneWithoutAnImage) {
  const Model model = model_with_textures();
  EXPECT_FALSE(resolve(model, std::nullopt));
  EXPECT_FALSE(resolve(model, TextureRef{-1, 0, {}}));
  EXPECT_FALSE(resolve(model, TextureRef{2, 0, {}}));
  EXPECT_EQ(image_of(model, TextureRef{2, 0, {}}), -1);
}

TEST(TextureUse, KnowsEachRole) {
  Material material;
  material.base_color = TextureRef{0, 0, {}};
  material.metallic_roughness = TextureRef{1, 0, {}};
  material.normal = TextureRef{2, 0, {}};
  material.occlusion = TextureRef{3, 0, {}};
  material.emissive = TextureRef{4, 0, {}};
  const auto textures = textures_of(material);
  ASSERT_EQ(textures.size(), kTextureRoles.size());
  for (std::size_t i = 0; i < textures.size(); ++i) {
    EXPECT_EQ(textures[i].role, kTextureRoles[i]);
    EXPECT_EQ(textures[i].ref.texture, static_cast<int>(i));
    EXPECT_EQ(texture_ref(material, kTextureRoles[i]), textures[i].ref);
  }
  material.normal.reset();
  EXPECT_EQ(textures_of(material).size(), kTextureRoles.size() - 1);
  EXPECT_EQ(encoding(TextureRole::base_color), ColorEncoding::srgb);
  EXPECT_EQ(encoding(TextureRole::emissive), ColorEncoding::srgb);
  EXPECT_EQ(encoding(TextureRole::normal), ColorEncoding::linear);
}

TEST(TextureUse, PartsWithoutAMaterialHaveTheDefaultOne) {
  Model model;
  model.materials.resize(1);
  model.materials[0].roughness_factor = 0.5;
  Part part;
  EXPECT_EQ(material_of(model, part).roughness_factor, 1);
  part.material = 0;
  EXPECT_EQ(&material_of(model, part), &model.materials[0]);
}

// KHR_texture_transform: scaled, then turned counter-clockwise as u runs right and v down, then moved.
TEST(TextureUse, AMatrixIsItsTransform) {
  const TextureTransform transform{{1, 2}, std::numbers::pi / 2, {3, 5}};
  const UvMatrixd m = matrix(transform);
  const Vec2d at = m({1, 0});
  EXPECT_NEAR(at.x, 1, 1e-15);
  EXPECT_NEAR(at.y, 2 - 3, 1e-15);
  const Vec2d down = m.direction({0, 1});
  EXPECT_NEAR(down.x, 5, 1e-15);
  EXPECT_NEAR(down.y, 0, 1e-15);
  const Vec2f single = rounded(m)({1, 0});
  EXPECT_NEAR(single.y, -1, 1e-6);
}

}  // namespace
}  // namespace fovea
