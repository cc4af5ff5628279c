#include "fovea/io/gltf_read.h"

#include <fmt/format.h>

#include <cctype>

#include "fovea/base/error.h"
#include "fovea/io/glb.h"
#include "fovea/io/gltf_extensions_read.h"
#include "fovea/io/gltf_material_read.h"
#include "fovea/io/gltf_mesh_read.h"
#include "fovea/io/gltf_read_state.h"
#include "fovea/io/gltf_scene_read.h"

namespace fovea {

namespace gltf {

namespace {

/// "2.0" -> 2; -1 for anything that does not begin with a number and a dot.
int major_version(const std::string& version) {
  const bool known =
      version.size() >= 3 && std::isdigit(static_cast<unsigned char>(version[0])) && version[1] == '.';
  return known ? version[0] - '0' : -1;
}

void check_asset(const JsonView& root) {
  const JsonView asset = root.at("asset");
  const JsonView version = asset.at("version");
  if (major_version(version.text()) != 2) {
    throw Error(ErrorKind::unsupported, fmt::format("glTF version {} is not 2.x", shown(version.text())),
                version.place());
  }
  const auto minimum = asset.find("minVersion");
  if (minimum && minimum->text() != "2.0") {
    throw Error(ErrorKind::unsupported, fmt::format("the file needs glTF {}", shown(minimum->text())),
                minimum->place());
  }
}

void read_root(ReadState& state) {
  check_asset(state.root);
  read_extension_lists(state);
  read_samplers(state);
  read_images(state);
  read_textures(state);
  read_materials(state);
  read_cameras(state);
  read_skins(state);
  read_nodes(state);
  read_scenes(state);
  read_animations(state);
  read_meshes(state);
  fit_mesh_users(state);
  state.model.json = state.keeper.keep(
      without(state.root.raw(), {"scenes", "nodes", "meshes", "materials", "textures", "samplers", "images",
                                 "skins", "animations", "cameras", "accessors", "bufferViews", "buffers",
                                 "extensionsUsed", "extensionsRequired"}),
      state.root);
}

}  // namespace

}  // namespace gltf

Model read_gltf(std::span<const std::byte> bytes, const std::filesystem::path& folder,
                const std::string& place, const ReadOptions& options, Context& context) {
  gltf::GlbChunks chunks{bytes, 0, std::nullopt};
  if (gltf::is_glb(bytes)) chunks = gltf::split_glb(bytes, place);
  ByteBudget budget(options, bytes.size());
  const gltf::Json json = gltf::parse_json(chunks.json, place, chunks.json_offset, budget);
  const gltf::JsonView root(json, "", place);
  Model model;
  gltf::DataReader data(root, chunks.binary, folder, options, budget);
  gltf::Keeper keeper(data, budget, model);
  gltf::ReadState state(root, data, budget, options, context, model, keeper);
  gltf::read_root(state);
  return model;
}

}  // namespace fovea
