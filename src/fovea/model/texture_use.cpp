#include "fovea/model/texture_use.h"

#include <cmath>

namespace fovea {

ColorEncoding encoding(TextureRole role) {
  return role == TextureRole::base_color || role == TextureRole::emissive ? ColorEncoding::srgb
                                                                          : ColorEncoding::linear;
}

const std::optional<TextureRef>& texture_ref(const Material& material, TextureRole role) {
  switch (role) {
    case TextureRole::base_color: return material.base_color;
    case TextureRole::metallic_roughness: return material.metallic_roughness;
    case TextureRole::normal: return material.normal;
    case TextureRole::occlusion: return material.occlusion;
    case TextureRole::emissive: return material.emissive;
  }
  return material.base_color;
}

std::vector<RoleTexture> textures_of(const Material& material) {
  std::vector<RoleTexture> textures;
  for (const TextureRole role : kTextureRoles) {
    if (const auto& ref = texture_ref(material, role)) textures.push_back({role, *ref});
  }
  return textures;
}

const Material& material_of(const Model& model, const Part& part) {
  static const Material kDefault;
  return part.material < 0 ? kDefault : model.materials[static_cast<std::size_t>(part.material)];
}

std::optional<TextureUse> resolve(const Model& model, const std::optional<TextureRef>& ref) {
  const int image = image_of(model, ref);
  if (image < 0) return {};
  const int sampler = model.textures[static_cast<std::size_t>(ref->texture)].sampler;
  return TextureUse{image, sampler < 0 ? Sampler{} : model.samplers[static_cast<std::size_t>(sampler)],
                    ref->uv_set, matrix(*ref)};
}

int image_of(const Model& model, const std::optional<TextureRef>& ref) {
  return ref && ref->texture >= 0 ? model.textures[static_cast<std::size_t>(ref->texture)].image : -1;
}

UvMatrixd matrix(const TextureTransform& t) {
  const double c = std::cos(t.rotation_rad), s = std::sin(t.rotation_rad);
  return {{c * t.scale.x, -s * t.scale.x}, {s * t.scale.y, c * t.scale.y}, t.offset};
}

UvMatrixd matrix(const TextureRef& ref) { return ref.transform ? matrix(*ref.transform) : UvMatrixd{}; }

UvMatrixf rounded(const UvMatrixd& m) {
  const auto f = [](Vec2d x) { return Vec2f{static_cast<float>(x.x), static_cast<float>(x.y)}; };
  return {f(m.u), f(m.v), f(m.offset)};
}

}  // namespace fovea
