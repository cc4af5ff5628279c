#include "fovea/io/gltf_material_read.h"

#include <fmt/format.h>

#include <string_view>

namespace fovea::gltf {

namespace {

constexpr int kMaxUvSet = 999;

/// Extensions whose image replaces that of a texture, in the order in which they win.
constexpr const char* kTextureSources[] = {"KHR_texture_basisu", "EXT_texture_webp", "EXT_texture_avif",
                                           "MSFT_texture_dds"};

Wrap wrap_mode(const JsonView& json, const char* name) {
  const auto member = json.find(name);
  if (!member) return Wrap::repeat;
  const std::int64_t number = member->integer(0, 0xFFFF);
  if (number != 33071 && number != 33648 && number != 10497) {
    member->fail(fmt::format("{} is not a wrapping mode", number));
  }
  return static_cast<Wrap>(number);
}

std::optional<int> filter_mode(const JsonView& json, const char* name) {
  const auto member = json.find(name);
  if (!member) return std::nullopt;
  const std::int64_t number = member->integer(0, 0xFFFF);
  const bool known = number == 9728 || number == 9729 || (number >= 9984 && number <= 9987);
  if (!known) member->fail(fmt::format("{} is not a texture filter", number));
  return static_cast<int>(number);
}

TextureTransform texture_transform(const JsonView& json) {
  TextureTransform transform;
  double offset[2] = {0, 0}, scale[2] = {1, 1};
  std::span<double> offset_span(offset), scale_span(scale);
  json.numbers_into("offset", offset_span);
  json.numbers_into("scale", scale_span);
  transform.offset = {offset[0], offset[1]};
  transform.scale = {scale[0], scale[1]};
  transform.rotation_rad = json.number("rotation", 0);
  return transform;
}

std::optional<TextureRef> texture_ref(const ReadState& state, const std::optional<JsonView>& json) {
  if (!json) return std::nullopt;
  TextureRef ref;
  ref.texture = json->at("index").index(state.count("textures"), "textures");
  ref.uv_set = static_cast<int>(json->integer("texCoord", 0, kMaxUvSet, 0));
  if (const auto extension = json->extension("KHR_texture_transform")) {
    ref.transform = texture_transform(*extension);
    ref.uv_set = static_cast<int>(extension->integer("texCoord", 0, kMaxUvSet, ref.uv_set));
  }
  return ref;
}

AlphaMode alpha_mode(const JsonView& json) {
  const auto member = json.find("alphaMode");
  if (!member || member->text() == "OPAQUE") return AlphaMode::opaque;
  if (member->text() == "MASK") return AlphaMode::mask;
  if (member->text() == "BLEND") return AlphaMode::blend;
  member->fail(shown(member->text()) + " is not an alpha mode");
}

void read_metallic_roughness(const ReadState& state, const JsonView& json, Material& material) {
  const auto pbr = json.find("pbrMetallicRoughness");
  if (!pbr) return;
  pbr->numbers_into("baseColorFactor", material.base_color_factor);
  material.base_color = texture_ref(state, pbr->find("baseColorTexture"));
  material.metallic_factor = pbr->number("metallicFactor", 1);
  material.roughness_factor = pbr->number("roughnessFactor", 1);
  material.metallic_roughness = texture_ref(state, pbr->find("metallicRoughnessTexture"));
}

/// Textures that extensions name must exist as well: members called "...Texture" with an index.
void check_texture_indices(const ReadState& state, const JsonView& json) {
  for (const auto& [name, member] : json.members()) {
    if (name == "extras" || !member.raw().is_object()) continue;
    if (std::string_view(name).ends_with("Texture") && member.has("index")) {
      member.index("index", state.count("textures"), "textures");
    }
    check_texture_indices(state, member);
  }
}

Material read_material(ReadState& state, const JsonView& json) {
  Material material;
  material.name = json.text("name");
  read_metallic_roughness(state, json, material);
  const auto normal = json.find("normalTexture");
  material.normal = texture_ref(state, normal);
  if (normal) material.normal_scale = normal->number("scale", 1);
  const auto occlusion = json.find("occlusionTexture");
  material.occlusion = texture_ref(state, occlusion);
  if (occlusion) material.occlusion_strength = occlusion->number("strength", 1);
  material.emissive = texture_ref(state, json.find("emissiveTexture"));
  json.numbers_into("emissiveFactor", material.emissive_factor);
  material.alpha_mode = alpha_mode(json);
  material.alpha_cutoff = json.number("alphaCutoff", 0.5);
  material.double_sided = json.boolean("doubleSided", false);
  material.unlit = json.extension("KHR_materials_unlit").has_value();
  if (const auto extensions = json.find("extensions")) check_texture_indices(state, *extensions);
  material.json = state.keeper.keep(json.raw(), json);
  return material;
}

Sampler read_sampler(ReadState& state, const JsonView& json) {
  Sampler sampler;
  sampler.wrap_u = wrap_mode(json, "wrapS");
  sampler.wrap_v = wrap_mode(json, "wrapT");
  sampler.mag_filter = filter_mode(json, "magFilter");
  sampler.min_filter = filter_mode(json, "minFilter");
  sampler.json = state.keeper.keep(json.raw(), json);
  return sampler;
}

Texture read_texture(ReadState& state, const JsonView& json) {
  const std::size_t images = state.count("images");
  Texture texture;
  texture.name = json.text("name");
  texture.sampler = json.index("sampler", state.count("samplers"), "samplers");
  texture.image = json.index("source", images, "images");
  for (const char* name : kTextureSources) {
    const auto extension = json.extension(name);
    if (!extension) continue;
    const int source = extension->index("source", images, "images");
    if (texture.image < 0) texture.image = source;
  }
  texture.json = state.keeper.keep(json.raw(), json);
  return texture;
}

}  // namespace

void read_samplers(ReadState& state) {
  for (const JsonView& json : state.root.elements("samplers")) {
    state.add(state.model.samplers, read_sampler(state, json), json);
  }
}

void read_textures(ReadState& state) {
  for (const JsonView& json : state.root.elements("textures")) {
    state.add(state.model.textures, read_texture(state, json), json);
  }
}

void read_materials(ReadState& state) {
  for (const JsonView& json : state.root.elements("materials")) {
    state.add(state.model.materials, read_material(state, json), json);
  }
}

}  // namespace fovea::gltf
