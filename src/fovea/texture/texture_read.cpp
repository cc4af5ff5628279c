#include "fovea/texture/texture_read.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

#include "fovea/model/texture_use.h"

namespace fovea {

namespace {

using Json = nlohmann::json;
using Kind = TexelMeaning::Kind;

constexpr const char* kTransform = "KHR_texture_transform";

Kind kind_of(TextureRole role) {
  if (role == TextureRole::normal) return Kind::normal;
  return encoding(role) == ColorEncoding::srgb ? Kind::color : Kind::data;
}

Kind kind_by_name(std::string_view name) {
  constexpr std::array<std::string_view, 5> kColors{"sheenColorTexture", "specularColorTexture",
                                                    "diffuseTexture", "specularGlossinessTexture",
                                                    "diffuseTransmissionColorTexture"};
  if (std::ranges::find(kColors, name) != kColors.end()) return Kind::color;
  return name.find("ormalTexture") != std::string_view::npos ? Kind::normal : Kind::data;
}

/// The object of that name in one, or an empty one.
Json member(const Json& json, const char* name) {
  if (!json.is_object() || !json.contains(name) || !json[name].is_object()) return Json::object();
  return json[name];
}

/// Only what of KHR_texture_transform is as it should be.
TextureTransform transform_of(const Json& json) {
  TextureTransform transform;
  const auto read = [&](const char* key, Vec2d& to) {
    const Json value = json.value(key, Json());
    if (value.is_array() && value.size() == 2 && value[0].is_number() && value[1].is_number())
      to = {value[0].get<double>(), value[1].get<double>()};
  };
  read("offset", transform.offset);
  read("scale", transform.scale);
  if (const Json angle = json.value("rotation", Json()); angle.is_number())
    transform.rotation_rad = angle.get<double>();
  return transform;
}

class Reads {
 public:
  explicit Reads(const Model& model) : model_(model) {}

  void add_roles(const Material& material) {
    for (const auto& [role, ref] : textures_of(material)) {
      TextureRead read;
      read.alpha_counts = role == TextureRole::base_color && material.alpha_mode != AlphaMode::opaque;
      read.meaning = {kind_of(role), read.alpha_counts};
      if (read.alpha_counts && material.alpha_mode == AlphaMode::mask)
        read.meaning.alpha_cutoff = material.alpha_cutoff;
      read.uv_set = ref.uv_set;
      read.is_transformed = ref.transform && !(*ref.transform == TextureTransform{});
      read.matrix = matrix(ref);
      add(ref.texture, read);
    }
  }

  void add_extensions(const Material& material) {
    const Json extensions = member(Json::parse(material.json, nullptr, false), "extensions");
    for (const Json& extension : extensions) {
      if (!extension.is_object()) continue;
      for (const auto& [name, info] : extension.items()) {
        if (name.ends_with("Texture") && info.is_object()) add_info(name, info);
      }
    }
  }

  std::vector<TextureRead> take() { return std::move(reads_); }

 private:
  void add_info(const std::string& name, const Json& info) {
    const auto number = [](const Json& object, const char* key, int otherwise) {
      const Json value = object.value(key, Json());
      return value.is_number_integer() ? value.get<int>() : otherwise;
    };
    const Json transform = member(member(info, "extensions"), kTransform);
    TextureRead read;
    read.meaning.kind = kind_by_name(name);
    read.alpha_counts = true;
    read.uv_set = number(transform, "texCoord", number(info, "texCoord", 0));
    read.is_transformed =
        transform.contains("offset") || transform.contains("rotation") || transform.contains("scale");
    read.matrix = matrix(transform_of(transform));
    add(number(info, "index", -1), read);
  }

  void add(int texture, TextureRead& read) {
    if (texture < 0 || static_cast<std::size_t>(texture) >= model_.textures.size()) return;
    const Texture& t = model_.textures[static_cast<std::size_t>(texture)];
    if (t.image < 0 || static_cast<std::size_t>(t.image) >= model_.images.size()) return;
    const bool known = t.sampler >= 0 && static_cast<std::size_t>(t.sampler) < model_.samplers.size();
    const Sampler sampler = known ? model_.samplers[static_cast<std::size_t>(t.sampler)] : Sampler();
    read.image = t.image;
    read.wrap_u = sampler.wrap_u;
    read.wrap_v = sampler.wrap_v;
    reads_.push_back(read);
  }

  const Model& model_;
  std::vector<TextureRead> reads_;
};

}  // namespace

std::vector<TextureRead> texture_reads(const Model& model, const Material& material) {
  Reads reads(model);
  reads.add_roles(material);
  reads.add_extensions(material);
  return reads.take();
}

std::set<int> part_materials(const Model& model, const Part& part) {
  std::set<int> materials{part.material};
  const Json json = Json::parse(part.json, nullptr, false);
  const auto mappings = Json::json_pointer("/extensions/KHR_materials_variants/mappings");
  if (!json.is_object() || !json.contains(mappings) || !json[mappings].is_array()) return materials;
  for (const Json& mapping : json[mappings]) {
    const Json material = mapping.is_object() ? mapping.value("material", Json()) : Json();
    if (!material.is_number_integer()) continue;
    const auto m = material.get<std::int64_t>();
    if (m >= 0 && m < static_cast<std::int64_t>(model.materials.size()))
      materials.insert(static_cast<int>(m));
  }
  return materials;
}

}  // namespace fovea
