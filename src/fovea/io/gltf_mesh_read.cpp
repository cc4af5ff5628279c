#include "fovea/io/gltf_mesh_read.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <tuple>

#include "fovea/base/error.h"
#include "fovea/io/gltf_json_write.h"
#include "fovea/io/gltf_primitive_read.h"

namespace fovea::gltf {

namespace {

/// Extensions that number the vertices or triangles of the file: welding and simplifying make them wrong.
constexpr const char* kVertexOrderExtensions[] = {"CESIUM_primitive_outline", "EXT_mesh_manifold",
                                                  "FB_ngon_encoding"};

void drop_vertex_order(ReadState& state, Json& object, const JsonView& at) {
  for (const char* name : kVertexOrderExtensions) {
    if (!find_extension(object, name)) continue;
    erase_extension(object, name);
    state.context.report("extension-dropped",
                         fmt::format("{} numbers vertices of the file and was dropped", name), at.place());
  }
}

void check_variants(const ReadState& state, const JsonView& primitive) {
  const auto variants = primitive.extension("KHR_materials_variants");
  if (!variants) return;
  for (const JsonView& mapping : variants->elements("mappings")) {
    mapping.index("material", state.count("materials"), "materials");
  }
}

std::string keep_primitive(ReadState& state, const JsonView& primitive) {
  check_variants(state, primitive);
  Json rest = without(primitive.raw(), {"attributes", "indices", "targets", "mode"});
  erase_extension(rest, "KHR_draco_mesh_compression");
  drop_vertex_order(state, rest, primitive);
  return state.keeper.keep(std::move(rest), primitive);
}

SplitPart read_part(ReadState& state, const JsonView& primitive) {
  RawPrimitive data = read_primitive_data(state, primitive);
  const bool is_raw = data.mode < 4;
  SplitPart part = is_raw ? SplitPart{} : to_split_part(state, primitive, data);
  part.part.material = primitive.index("material", state.count("materials"), "materials");
  part.part.json = keep_primitive(state, primitive);
  if (is_raw) part.part.raw = std::move(data);
  return part;
}

/// Welding keeps, for every layer of the mesh, a number per vertex and per corner of every part: with
/// many parts that share no attribute this is more than the parts themselves.
void charge_welding(ReadState& state, const std::vector<SplitPart>& parts, const JsonView& mesh) {
  std::set<std::tuple<Semantic, int, std::string>> layers;
  std::uint64_t elements = 0, targets = 0;
  for (const SplitPart& part : parts) {
    elements += part.positions.size() + part.indices.size();
    targets = std::max<std::uint64_t>(targets, part.position_morphs.size());
    for (const VertexArray& a : part.attributes) layers.emplace(a.semantic, a.set, a.name);
  }
  state.budget.charge(elements, sizeof(std::uint32_t) * (1 + layers.size()), mesh.place());
  state.budget.charge(elements, sizeof(Vec3f) * targets, mesh.place());
}

std::size_t target_count(const std::vector<JsonView>& primitives) {
  const std::size_t count = primitives.empty() ? 0 : primitives.front().elements("targets").size();
  for (const JsonView& primitive : primitives) {
    const std::size_t own = primitive.elements("targets").size();
    if (own != count)
      primitive.fail(fmt::format("{} morph targets where the first primitive has {}", own, count));
  }
  return count;
}

Mesh read_mesh(ReadState& state, const JsonView& json) {
  Mesh mesh;
  mesh.name = json.text("name");
  const std::vector<JsonView> primitives = json.at("primitives").elements();
  const std::size_t targets = target_count(primitives);
  mesh.morph_weights = json.numbers("weights");
  if (!mesh.morph_weights.empty() && mesh.morph_weights.size() != targets) {
    state.context.report("morph-weights", "weights do not match the morph targets", json.place());
    mesh.morph_weights.resize(targets);
  }
  std::vector<SplitPart> parts;
  for (const JsonView& primitive : primitives) state.add(parts, read_part(state, primitive), primitive);
  charge_welding(state, parts, json);
  mesh.surface = weld(parts, state.context, json.place());
  Json rest = without(json.raw(), {"primitives"});
  drop_vertex_order(state, rest, json);
  mesh.json = state.keeper.keep(std::move(rest), json);
  return mesh;
}

float largest_joint(const TriMesh& mesh) {
  float largest = -1;
  for (const AttributeLayer& layer : mesh.layers) {
    if (layer.semantic != Semantic::joints) continue;
    for (const float joint : layer.values) largest = std::max(largest, joint);
  }
  return largest;
}

/// What a node must know of its mesh.
struct MeshNeeds {
  std::size_t targets = 0;
  float largest_joint = -1;
};

std::vector<MeshNeeds> mesh_needs(const ReadState& state) {
  std::vector<MeshNeeds> needs;
  for (const JsonView& mesh : state.root.elements("meshes")) {
    const TriMesh& surface = state.model.meshes[needs.size()].surface;
    needs.push_back({target_count(mesh.at("primitives").elements()), largest_joint(surface)});
  }
  return needs;
}

}  // namespace

void read_meshes(ReadState& state) {
  const std::vector<JsonView> meshes = state.root.elements("meshes");
  for (std::size_t m = 0; m < meshes.size(); ++m) {
    state.context.advance_or_throw("read", static_cast<double>(m) / static_cast<double>(meshes.size()));
    state.add(state.model.meshes, read_mesh(state, meshes[m]), meshes[m]);
  }
}

void fit_mesh_users(ReadState& state) {
  const std::vector<MeshNeeds> needs = mesh_needs(state);
  for (std::size_t n = 0; n < state.model.nodes.size(); ++n) {
    Node& node = state.model.nodes[n];
    if (node.mesh < 0) continue;
    const MeshNeeds& need = needs[static_cast<std::size_t>(node.mesh)];
    const std::string place = fmt::format("{}/nodes/{}", state.root.place(), n);
    if (!node.morph_weights.empty() && node.morph_weights.size() != need.targets) {
      state.context.report("morph-weights", "weights do not match the morph targets", place);
      node.morph_weights.resize(need.targets);
    }
    if (node.skin < 0) continue;
    const std::size_t joints = state.model.skins[static_cast<std::size_t>(node.skin)].joints.size();
    if (need.largest_joint >= static_cast<float>(joints)) {
      state.context.report("joint-out-of-range", "a mesh uses joints that its skin does not have", place);
    }
  }
}

}  // namespace fovea::gltf
