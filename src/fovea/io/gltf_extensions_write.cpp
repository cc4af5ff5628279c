#include "fovea/io/gltf_extensions_write.h"

#include <algorithm>
#include <iterator>
#include <set>
#include <string>
#include <string_view>
#include <vector>

namespace fovea::gltf {

namespace {

constexpr std::string_view kQuantization = "KHR_mesh_quantization";
constexpr std::string_view kCompression = "EXT_meshopt_compression";

/// Extensions that a file has because of how it stores things; a rewritten file may not have them any more.
constexpr std::string_view kStorageExtensions[] = {kQuantization,
                                                   kCompression,
                                                   "KHR_meshopt_compression",
                                                   "KHR_draco_mesh_compression",
                                                   "EXT_mesh_gpu_instancing",
                                                   "EXT_texture_webp",
                                                   "EXT_texture_avif",
                                                   "KHR_texture_basisu",
                                                   "MSFT_texture_dds",
                                                   "KHR_texture_transform",
                                                   "KHR_materials_unlit"};
constexpr std::string_view kTextureExtensions[] = {"EXT_texture_webp", "EXT_texture_avif",
                                                   "KHR_texture_basisu", "MSFT_texture_dds"};

template <class List>
bool is_in(const List& list, std::string_view name) {
  return std::find(std::begin(list), std::end(list), name) != std::end(list);
}

/// Names of all extensions that objects below `json` have. Extras are the user's own.
void find_extensions(const Json& json, std::set<std::string>& names) {
  if (!json.is_structured()) return;
  for (const auto& [key, value] : json.items()) {
    if (json.is_object() && key == "extras") continue;
    if (json.is_object() && key == "extensions" && value.is_object()) {
      for (const auto& extension : value.items()) names.insert(extension.key());
    }
    find_extensions(value, names);
  }
}

/// Those without which the file cannot be shown as it is.
std::set<std::string> find_needed(const Json& root, const std::set<std::string>& found) {
  std::set<std::string> needed;
  for (const std::string_view name : {kQuantization, kCompression}) {
    if (found.contains(std::string(name))) needed.emplace(name);
  }
  for (const Json& texture : root.value("textures", Json::array())) {
    if (texture.contains("source")) continue;
    for (const std::string_view name : kTextureExtensions) {
      if (find_extension(texture, std::string(name).c_str())) needed.emplace(name);
    }
  }
  return needed;
}

/// Those of `listed` that `keep` wants, in their order, then those of `others` that are not among them.
template <class Keep>
std::vector<std::string> merge(const std::vector<std::string>& listed, const Keep& keep,
                               const std::set<std::string>& others) {
  std::vector<std::string> result;
  std::copy_if(listed.begin(), listed.end(), std::back_inserter(result), keep);
  for (const std::string& name : others) {
    if (!is_in(result, name)) result.push_back(name);
  }
  return result;
}

}  // namespace

void write_extension_lists(Json& root, const Model& model, bool quantized) {
  std::set<std::string> found;
  find_extensions(root, found);
  if (quantized) found.emplace(kQuantization);
  const auto is_used = [&](const std::string& name) {
    return found.contains(name) || !is_in(kStorageExtensions, name);
  };
  const std::vector<std::string> used = merge(model.extensions_used, is_used, found);
  const auto is_listed = [&](const std::string& name) { return is_in(used, name); };
  const std::vector<std::string> required =
      merge(model.extensions_required, is_listed, find_needed(root, found));
  refresh(root, "extensionsUsed", used, Json::array());
  refresh(root, "extensionsRequired", required, Json::array());
}

}  // namespace fovea::gltf
