#include "fovea/lod/lod_chain_parts.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <numeric>

namespace fovea {

namespace {

using Json = nlohmann::ordered_json;

/// Where `index` leads; itself if it is none.
int mapped(int index, const std::vector<int>& to) {
  return index >= 0 && static_cast<std::size_t>(index) < to.size() ? to[static_cast<std::size_t>(index)]
                                                                   : index;
}

/// Replaces an index inside JSON. Returns whether it changed.
bool remap(Json& json, const char* key, const std::vector<int>& to) {
  if (!json.is_object() || !json.contains(key) || !json[key].is_number_integer()) return false;
  const int before = json[key].get<int>(), after = mapped(before, to);
  json[key] = after;
  return before != after;
}

/// Textures of a material's extensions are the objects whose names end in "Texture" (texture_read.h).
bool remap_textures(std::string& text, const std::vector<int>& to) {
  Json json = Json::parse(text, nullptr, false);
  if (!json.is_object() || !json.contains("extensions") || !json["extensions"].is_object()) return false;
  bool changed = false;
  for (auto& extension : json["extensions"]) {
    if (!extension.is_object()) continue;
    for (auto& [name, info] : extension.items())
      if (name.ends_with("Texture")) changed = remap(info, "index", to) || changed;
  }
  if (changed) text = json.dump();
  return changed;
}

/// The materials of KHR_materials_variants.
void remap_variants(std::string& text, const std::vector<int>& to) {
  Json json = Json::parse(text, nullptr, false);
  const auto place = Json::json_pointer("/extensions/KHR_materials_variants/mappings");
  if (!json.is_object() || !json.contains(place) || !json[place].is_array()) return;
  bool changed = false;
  for (Json& mapping : json[place]) changed = remap(mapping, "material", to) || changed;
  if (changed) text = json.dump();
}

bool remap_textures(Material& material, const std::vector<int>& to) {
  bool changed = false;
  for (std::optional<TextureRef>* ref : {&material.base_color, &material.metallic_roughness, &material.normal,
                                         &material.occlusion, &material.emissive}) {
    if (!*ref) continue;
    const int texture = mapped((*ref)->texture, to);
    changed = changed || texture != (*ref)->texture;
    (*ref)->texture = texture;
  }
  return remap_textures(material.json, to) || changed;
}

bool same_layers(const TriMesh& a, const TriMesh& b) {
  return std::ranges::equal(a.layers, b.layers, [](const AttributeLayer& x, const AttributeLayer& y) {
    return x.values == y.values && x.corner_value == y.corner_value && x.morphs == y.morphs;
  });
}

bool same_parts(const TriMesh& a, const TriMesh& b) {
  return std::ranges::equal(a.parts, b.parts, [](const Part& x, const Part& y) {
    return x.material == y.material && x.json == y.json;
  });
}

bool same(const TriMesh& a, const TriMesh& b) {
  return a.triangles == b.triangles && a.positions == b.positions && a.position_morphs == b.position_morphs &&
         a.face_part == b.face_part && same_parts(a, b) && same_layers(a, b);
}

bool same_textures(const Material& a, const Material& b) {
  return a.base_color == b.base_color && a.metallic_roughness == b.metallic_roughness &&
         a.normal == b.normal && a.occlusion == b.occlusion && a.emissive == b.emissive && a.json == b.json;
}

std::vector<int> counting(std::size_t count) {
  std::vector<int> numbers(count);
  std::iota(numbers.begin(), numbers.end(), 0);
  return numbers;
}

std::string named(const std::string& name, int level) {
  return name.empty() ? name : fmt::format("{}_LOD{}", name, level);
}

}  // namespace

std::vector<int> LodParts::add_images(const Model& level) {
  std::vector<int> image(level.images.size());
  for (std::size_t i = 0; i < image.size(); ++i) {
    // An image keeps its number where it is the original's, be there others like it.
    const auto is_it = [&](const EncodedImage& other) { return other.bytes == level.images[i].bytes; };
    auto at = i < all_.images.size() && is_it(all_.images[i])
                  ? all_.images.begin() + static_cast<std::ptrdiff_t>(i)
                  : std::ranges::find_if(all_.images, is_it);
    image[i] = static_cast<int>(at - all_.images.begin());
    if (at == all_.images.end()) all_.images.push_back(level.images[i]);
  }
  return image;
}

std::vector<int> LodParts::add_textures(const Model& level, const std::vector<int>& image) {
  std::vector<int> texture(level.textures.size());
  for (std::size_t t = 0; t < texture.size(); ++t) {
    Texture copy = level.textures[t];
    copy.image = mapped(copy.image, image);
    texture[t] = static_cast<int>(t);
    if (copy.image == level.textures[t].image) continue;
    const auto at = std::ranges::find_if(all_.textures, [&](const Texture& other) {
      return other.image == copy.image && other.sampler == copy.sampler && other.json == copy.json;
    });
    texture[t] = static_cast<int>(at - all_.textures.begin());
    if (at == all_.textures.end()) all_.textures.push_back(std::move(copy));
  }
  return texture;
}

std::vector<int> LodParts::add_materials(const Model& level, const std::vector<int>& texture) {
  std::vector<int> material = counting(level.materials.size());
  for (std::size_t m = 0; m < material.size(); ++m) {
    Material copy = level.materials[m];
    if (!remap_textures(copy, texture)) continue;
    int& last = last_copy_.try_emplace(m, -1).first->second;
    if (last < 0 || !same_textures(all_.materials[static_cast<std::size_t>(last)], copy)) {
      last = static_cast<int>(all_.materials.size());
      all_.materials.push_back(std::move(copy));
    }
    material[m] = last;
  }
  return material;
}

int LodParts::add_mesh(const Mesh& mesh, int before, const std::vector<int>& material, int number) {
  Mesh copy = mesh;
  for (Part& part : copy.surface.parts) {
    part.material = mapped(part.material, material);
    remap_variants(part.json, material);
  }
  if (same(copy.surface, all_.meshes[static_cast<std::size_t>(before)].surface)) return before;
  copy.name = named(copy.name, number);
  all_.meshes.push_back(std::move(copy));
  return static_cast<int>(all_.meshes.size()) - 1;
}

std::vector<int> LodParts::add(const Model& level, int number) {
  if (before_.empty()) before_ = counting(level.meshes.size());
  const std::vector<int> texture = add_textures(level, add_images(level));
  const std::vector<int> material = add_materials(level, texture);
  for (std::size_t m = 0; m < level.meshes.size(); ++m)
    before_[m] = add_mesh(level.meshes[m], before_[m], material, number);
  return before_;
}

}  // namespace fovea
