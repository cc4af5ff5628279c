#include "inspect.h"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "fovea/model/texture_use.h"
#include "fovea/model/weld.h"
#include "fovea/surface/pose.h"

namespace fovea::cli {

namespace {

using FileJson = nlohmann::json;  // sorted by keys

LayerFacts layer_facts(const TriMesh& mesh, const AttributeLayer& layer) {
  std::vector<bool> seen(mesh.vertex_count());
  std::uint64_t vertices = 0;
  for (std::size_t c = 0; c < layer.corner_value.size(); ++c) {
    if (!layer.corner_value[c].valid()) continue;
    const std::size_t v = mesh.vertex(CornerId(c)).index();
    vertices += !seen[v];
    seen[v] = true;
  }
  const std::uint64_t values = layer.size();
  return {attribute_name(layer), values, values - std::min(values, vertices)};
}

MeshFacts mesh_facts(const TriMesh& mesh) {
  MeshFacts facts;
  facts.edges = count_edges(mesh);
  facts.components = components(mesh).count;
  facts.bow_ties = count_bow_ties(mesh);
  facts.split_vertices = split_vertex_count(mesh);
  for (const Part& part : mesh.parts) facts.raw_parts += part.raw.has_value();
  for (const AttributeLayer& layer : mesh.layers) facts.layers.push_back(layer_facts(mesh, layer));
  return facts;
}

// Extensions keep their textures in objects whose names end in "Texture" (all of Khronos' do).
void add_extension_textures(const Material& material, std::vector<TextureUse>& uses) {
  const FileJson json = FileJson::parse(material.json, nullptr, false);
  if (!json.is_object() || !json.contains("extensions")) return;
  for (const auto& extension : json["extensions"].items()) {
    if (!extension.value().is_object()) continue;
    for (const auto& [name, value] : extension.value().items()) {
      const bool texture = name.size() > 7 && name.compare(name.size() - 7, 7, "Texture") == 0;
      if (!texture || !value.is_object()) continue;
      const FileJson index = value.value("index", FileJson()), set = value.value("texCoord", FileJson(0));
      if (!index.is_number_integer() || !set.is_number_integer()) continue;
      uses.push_back({extension.key() + "." + name, index.get<int>(), -1, set.get<int>()});
    }
  }
}

const char* name_of(TextureRole role) {
  switch (role) {
    case TextureRole::base_color: return "base color";
    case TextureRole::metallic_roughness: return "metal roughness";
    case TextureRole::normal: return "normal";
    case TextureRole::occlusion: return "occlusion";
    case TextureRole::emissive: return "emissive";
  }
  return "";
}

std::vector<TextureUse> texture_uses(const Model& model, const Material& material) {
  std::vector<TextureUse> uses;
  for (const auto& [role, ref] : textures_of(material))
    uses.push_back({name_of(role), ref.texture, -1, ref.uv_set});
  add_extension_textures(material, uses);
  for (TextureUse& use : uses) {
    const bool known = use.texture >= 0 && static_cast<std::size_t>(use.texture) < model.textures.size();
    const int image = known ? model.textures[static_cast<std::size_t>(use.texture)].image : -1;
    use.image = image >= 0 && static_cast<std::size_t>(image) < model.images.size() ? image : -1;
  }
  return uses;
}

std::string generator_of(const Model& model) {
  const FileJson json = FileJson::parse(model.json, nullptr, false);
  if (!json.is_object() || !json.contains("asset") || !json["asset"].is_object()) return {};
  const FileJson generator = json["asset"].value("generator", FileJson());
  return generator.is_string() ? generator.get<std::string>() : std::string();
}

void add_uses_of_meshes(const Model& model, ModelFacts& facts) {
  const std::vector<std::vector<Mat4>> instances = mesh_instances(model);
  for (std::size_t i = 0; i < facts.meshes.size(); ++i) facts.meshes[i].shown = instances[i].size();
  for (const Node& node : model.nodes) {
    if (node.mesh >= 0 && node.skin >= 0) facts.meshes[static_cast<std::size_t>(node.mesh)].skinned = true;
  }
}

}  // namespace

std::string attribute_name(const AttributeLayer& layer) {
  const std::string set = "_" + std::to_string(layer.set);
  switch (layer.semantic) {
    case Semantic::uv: return "TEXCOORD" + set;
    case Semantic::normal: return "NORMAL";
    case Semantic::tangent: return "TANGENT";
    case Semantic::color: return "COLOR" + set;
    case Semantic::joints: return "JOINTS" + set;
    case Semantic::weights: return "WEIGHTS" + set;
    case Semantic::custom: break;
  }
  return layer.name;
}

ModelFacts inspect(const Model& model, Context& context) {
  ModelFacts facts;
  for (std::size_t i = 0; i < model.meshes.size(); ++i) {
    context.advance_or_throw("inspect", static_cast<double>(i) / static_cast<double>(model.meshes.size()));
    facts.meshes.push_back(mesh_facts(model.meshes[i].surface));
  }
  add_uses_of_meshes(model, facts);
  for (const Material& material : model.materials) facts.textures.push_back(texture_uses(model, material));
  for (const EncodedImage& image : model.images) facts.images.push_back(image_info(image.bytes));
  for (const Animation& animation : model.animations) {
    facts.animation_seconds.push_back(duration_s(animation));
  }
  facts.box = bounds(model);
  facts.generator = generator_of(model);
  return facts;
}

}  // namespace fovea::cli
