#include "fovea/io/gltf_extensions_read.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <string_view>

#include "fovea/base/error.h"

namespace fovea::gltf {

namespace {

/// Undone by reading: neither the model nor what is written of it has them.
constexpr const char* kUndone[] = {"EXT_meshopt_compression",    "KHR_meshopt_compression",
                                   "KHR_draco_mesh_compression", "CESIUM_primitive_outline",
                                   "EXT_mesh_manifold",          "FB_ngon_encoding"};

/// Understood, or sound to carry along without understanding.
constexpr const char* kKnown[] = {"KHR_mesh_quantization",
                                  "EXT_mesh_gpu_instancing",
                                  "KHR_lights_punctual",
                                  "EXT_lights_ies",
                                  "EXT_lights_image_based",
                                  "KHR_xmp",
                                  "KHR_xmp_json_ld",
                                  "KHR_animation_pointer",
                                  "KHR_node_visibility",
                                  "MSFT_lod",
                                  "MSFT_texture_dds",
                                  "EXT_mesh_features",
                                  "EXT_structural_metadata",
                                  "EXT_instance_features",
                                  "KHR_audio_emitter",
                                  "KHR_interactivity",
                                  "KHR_physics_rigid_bodies",
                                  "VRM",
                                  "VRMC_vrm"};
constexpr const char* kKnownPrefixes[] = {"KHR_materials_", "EXT_materials_", "KHR_texture_", "EXT_texture_"};

/// These change what indices or accessors mean without leaving a trace in them.
constexpr const char* kRefused[] = {"KHR_mesh_primitive_restart", "EXT_mesh_primitive_restart",
                                    "KHR_accessor_float64", "KHR_accessor_float16"};

template <class List>
bool contains(const List& list, std::string_view name) {
  return std::any_of(std::begin(list), std::end(list), [&](const char* known) { return name == known; });
}

bool is_known(std::string_view name) {
  return contains(kUndone, name) || contains(kKnown, name) ||
         std::any_of(std::begin(kKnownPrefixes), std::end(kKnownPrefixes),
                     [&](const char* prefix) { return name.starts_with(prefix); });
}

/// The extensions of all objects that decide how geometry is read, each with the first place.
std::map<std::string, std::string> extensions_in_geometry(const JsonView& root) {
  std::vector<JsonView> objects;
  for (const char* list : {"buffers", "bufferViews", "accessors"}) {
    for (const JsonView& element : root.elements(list)) objects.push_back(element);
  }
  for (const JsonView& mesh : root.elements("meshes")) {
    for (const JsonView& primitive : mesh.elements("primitives")) objects.push_back(primitive);
  }
  std::map<std::string, std::string> places;
  for (const JsonView& object : objects) {
    const auto extensions = object.find("extensions");
    if (!extensions) continue;
    for (const auto& [name, extension] : extensions->members()) places.emplace(name, extension.place());
  }
  return places;
}

void check_required(ReadState& state, const JsonView& entry,
                    const std::map<std::string, std::string>& users) {
  const std::string& name = entry.text();
  if (is_known(name)) return;
  const auto user = users.find(name);
  if (user != users.end() || contains(kRefused, name)) {
    throw Error(ErrorKind::unsupported,
                fmt::format("the file requires extension {}, which is not known", shown(name)),
                user != users.end() ? user->second : entry.place());
  }
  state.context.report(
      "unknown-required-extension",
      fmt::format("required extension {} is carried through without being understood", shown(name)),
      entry.place());
}

std::vector<std::string> kept(const std::vector<JsonView>& names) {
  std::vector<std::string> result;
  for (const JsonView& name : names) {
    if (!contains(kUndone, name.text())) result.push_back(name.text());
  }
  return result;
}

}  // namespace

void read_extension_lists(ReadState& state) {
  const std::vector<JsonView> required = state.root.elements("extensionsRequired");
  const auto users =
      required.empty() ? std::map<std::string, std::string>{} : extensions_in_geometry(state.root);
  for (const JsonView& entry : required) check_required(state, entry, users);
  state.model.extensions_used = kept(state.root.elements("extensionsUsed"));
  state.model.extensions_required = kept(required);
}

}  // namespace fovea::gltf
