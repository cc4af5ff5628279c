#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <vector>

#include "fovea/model/image.h"
#include "fovea/model/material.h"
#include "fovea/model/model.h"

namespace fovea {

/// What a material reads a texture for.
enum class TextureRole { base_color, metallic_roughness, normal, occlusion, emissive };
inline constexpr std::array kTextureRoles{TextureRole::base_color, TextureRole::metallic_roughness,
                                          TextureRole::normal, TextureRole::occlusion, TextureRole::emissive};

/// What the texels of a role mean.
ColorEncoding encoding(TextureRole role);

/// A material's texture of a role, if it has one.
const std::optional<TextureRef>& texture_ref(const Material& material, TextureRole role);

/// All textures of a material, in the order of roles.
struct RoleTexture {
  TextureRole role;
  TextureRef ref;
};
std::vector<RoleTexture> textures_of(const Material& material);

/// The material of a part; glTF's default one if it has none.
const Material& material_of(const Model& model, const Part& part);

/// A reference followed to its image.
struct TextureUse {
  int image = -1;  ///< Index into the model's images.
  Sampler sampler;
  int uv_set = 0;
  UvMatrixd matrix;  ///< From the mesh's texture coordinates to the image's, 0 … 1 from the top left.
};

/// None if the reference leads to no image. Indices must be in range or -1, as readers leave them.
std::optional<TextureUse> resolve(const Model& model, const std::optional<TextureRef>& ref);

/// Index of the image that a reference leads to, or -1.
int image_of(const Model& model, const std::optional<TextureRef>& ref);

/// A transform, and that of a reference (identity without one), as a matrix.
UvMatrixd matrix(const TextureTransform& transform);
UvMatrixd matrix(const TextureRef& ref);
/// In single precision.
UvMatrixf rounded(const UvMatrixd& matrix);

}  // namespace fovea
