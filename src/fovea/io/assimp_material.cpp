#include <assimp/GltfMaterial.h>

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>

#include "fovea/base/error.h"
#include "fovea/io/assimp_scene.h"
#include "fovea/io/image_codec.h"
#include "fovea/io/mtl_read.h"

namespace fovea {

namespace {

Wrap wrap_of(aiTextureMapMode mode) {
  if (mode == aiTextureMapMode_Clamp || mode == aiTextureMapMode_Decal) return Wrap::clamp;
  if (mode == aiTextureMapMode_Mirror) return Wrap::mirror;
  return Wrap::repeat;
}

/// The encoded file, or the raw pixels as PNG; empty if it is damaged.
std::vector<std::uint8_t> encoded_bytes(const aiTexture& texture) {
  if (!texture.pcData || texture.mWidth == 0) return {};
  const auto* data = reinterpret_cast<const std::uint8_t*>(texture.pcData);
  if (texture.mHeight == 0) return {data, data + texture.mWidth};
  if (texture.mWidth > 65536 || texture.mHeight > 65536) return {};
  Image8 image(static_cast<int>(texture.mWidth), static_cast<int>(texture.mHeight), 4, ColorEncoding::srgb);
  for (std::size_t i = 0; i < image.pixels.size() / 4; ++i) {
    const aiTexel& t = texture.pcData[i];
    image.pixels[4 * i] = t.r;
    image.pixels[4 * i + 1] = t.g;
    image.pixels[4 * i + 2] = t.b;
    image.pixels[4 * i + 3] = t.a;
  }
  return encode_png(image);
}

class MaterialConverter {
 public:
  MaterialConverter(const aiScene& scene, const aiMaterial& from, TextureLoader& textures,
                    const std::string& place, Context& context)
      : scene_(scene), from_(from), textures_(textures), place_(place), context_(context) {}

  Material run() {
    to_.name = from_.GetName().C_Str();
    set_textures();
    set_colors();
    set_surface();
    return std::move(to_);
  }

 private:
  void set_textures();
  void set_colors();
  void set_surface();
  std::optional<TextureRef> texture(std::initializer_list<aiTextureType> types);
  std::optional<double> number(const char* key, unsigned type, unsigned index) const {
    float value = 0;
    if (from_.Get(key, type, index, value) != aiReturn_SUCCESS || !std::isfinite(value)) return {};
    return static_cast<double>(value);
  }
  template <std::size_t N>
  bool color(const char* key, unsigned type, unsigned index, std::array<double, N>& to) const {
    aiColor4D value;
    if (from_.Get(key, type, index, value) != aiReturn_SUCCESS) return false;
    const float rgb[3] = {value.r, value.g, value.b};
    for (std::size_t k = 0; k < 3; ++k)
      to[k] = std::isfinite(rgb[k]) ? std::clamp(static_cast<double>(rgb[k]), 0.0, 1.0) : 1;
    return true;
  }

  const aiScene& scene_;
  const aiMaterial& from_;
  TextureLoader& textures_;
  const std::string& place_;
  Context& context_;
  Material to_;
};

void MaterialConverter::set_textures() {
  to_.base_color = texture({aiTextureType_BASE_COLOR, aiTextureType_DIFFUSE});
  to_.normal = texture({aiTextureType_NORMALS, aiTextureType_NORMAL_CAMERA});
  to_.emissive = texture({aiTextureType_EMISSION_COLOR, aiTextureType_EMISSIVE});
  to_.occlusion = texture({aiTextureType_AMBIENT_OCCLUSION, aiTextureType_LIGHTMAP});
  for (const aiTextureType type : {aiTextureType_HEIGHT, aiTextureType_SPECULAR, aiTextureType_SHININESS,
                                   aiTextureType_METALNESS, aiTextureType_DIFFUSE_ROUGHNESS}) {
    if (from_.GetTextureCount(type) == 0) continue;
    context_.report("ignored-map", fmt::format("a {} map was left out", aiTextureTypeToString(type)), place_);
  }
}

void MaterialConverter::set_colors() {
  auto& base = to_.base_color_factor;
  if (!color(AI_MATKEY_BASE_COLOR, base)) color(AI_MATKEY_COLOR_DIFFUSE, base);
  // Exporters that know only the image leave the colour black, which would multiply it away.
  if (to_.base_color && base[0] + base[1] + base[2] == 0) base = {1, 1, 1, 1};
  // Opacity 0 is how some exporters say that they have none to tell.
  if (const auto opacity = number(AI_MATKEY_OPACITY); opacity && *opacity > 0)
    base[3] = std::min(*opacity, 1.0);
  color(AI_MATKEY_COLOR_EMISSIVE, to_.emissive_factor);
  if (to_.emissive && to_.emissive_factor == std::array<double, 3>{0, 0, 0}) to_.emissive_factor = {1, 1, 1};
  if (base[3] < 1 || from_.GetTextureCount(aiTextureType_OPACITY) > 0) to_.alpha_mode = AlphaMode::blend;
}

void MaterialConverter::set_surface() {
  to_.metallic_factor = std::clamp(number(AI_MATKEY_METALLIC_FACTOR).value_or(0), 0.0, 1.0);
  const double exponent = number(AI_MATKEY_SHININESS).value_or(0);
  to_.roughness_factor = std::clamp(
      number(AI_MATKEY_ROUGHNESS_FACTOR).value_or(exponent > 0 ? roughness_of_exponent(exponent) : 1), 0.0,
      1.0);
  int two_sided = 0;
  to_.double_sided = from_.Get(AI_MATKEY_TWOSIDED, two_sided) == aiReturn_SUCCESS && two_sided != 0;
}

std::optional<TextureRef> MaterialConverter::texture(std::initializer_list<aiTextureType> types) {
  for (const aiTextureType type : types) {
    aiString name;
    unsigned uv_set = 0;
    aiTextureMapMode modes[3] = {aiTextureMapMode_Wrap, aiTextureMapMode_Wrap, aiTextureMapMode_Wrap};
    if (from_.GetTexture(type, 0, &name, nullptr, &uv_set, nullptr, nullptr, modes) != aiReturn_SUCCESS)
      continue;
    Sampler sampler;
    sampler.wrap_u = wrap_of(modes[0]);
    sampler.wrap_v = wrap_of(modes[1]);
    const aiTexture* embedded = scene_.GetEmbeddedTexture(name.C_Str());
    const auto found = embedded ? textures_.texture(name.C_Str(), encoded_bytes(*embedded), sampler, place_)
                                : textures_.texture(name.C_Str(), sampler, place_);
    if (!found) return {};
    TextureRef ref;
    ref.texture = *found;
    ref.uv_set = static_cast<int>(std::min(uv_set, 7u));
    return ref;
  }
  return {};
}

}  // namespace

void convert_materials(const aiScene& scene, Model& model, TextureLoader& textures, const std::string& place,
                       Context& context) {
  for (unsigned m = 0; m < scene.mNumMaterials; ++m) {
    model.materials.push_back(MaterialConverter(scene, *scene.mMaterials[m], textures, place, context).run());
  }
}

}  // namespace fovea
