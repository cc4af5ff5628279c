#include "fovea/io/gltf_scene_read.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "fovea/base/error.h"

namespace fovea::gltf {

namespace {

Vec3d vector3(const JsonView& json, const char* name, Vec3d standard) {
  std::array<double, 3> v{standard.x, standard.y, standard.z};
  json.numbers_into(name, v);
  return {v[0], v[1], v[2]};
}

Quat quaternion(const JsonView& json, const char* name) {
  std::array<double, 4> q{0, 0, 0, 1};
  json.numbers_into(name, q);
  return {q[0], q[1], q[2], q[3]};
}

std::vector<int> indices(const JsonView& json, const char* name, std::size_t count, const char* what) {
  std::vector<int> result;
  for (const JsonView& element : json.elements(name)) result.push_back(element.index(count, what));
  return result;
}

/// An attribute of EXT_mesh_gpu_instancing as numbers; empty if it is absent.
std::vector<float> instance_attribute(ReadState& state, const JsonView& attributes, const char* name,
                                      int width, std::size_t& count) {
  const auto reference = attributes.find(name);
  if (!reference) return {};
  const Accessor accessor = state.data.read(state.data.accessor_index(*reference));
  if (accessor.matrix || accessor.width != width) {
    reference->fail(fmt::format("{} components where {} are expected", accessor.width, width));
  }
  if (count != 0 && accessor.count != count) {
    reference->fail(fmt::format("{} values for {} instances", accessor.count, count));
  }
  count = accessor.count;
  return state.finite_floats(accessor, *reference);
}

std::vector<Mat4> read_instances(ReadState& state, const JsonView& node) {
  const auto extension = node.extension("EXT_mesh_gpu_instancing");
  if (!extension) return {};
  const JsonView attributes = extension->at("attributes");
  std::size_t count = 0;
  const auto t = instance_attribute(state, attributes, "TRANSLATION", 3, count);
  const auto r = instance_attribute(state, attributes, "ROTATION", 4, count);
  const auto s = instance_attribute(state, attributes, "SCALE", 3, count);
  state.budget.charge(count, sizeof(Mat4), extension->place());
  std::vector<Mat4> instances(count);
  for (std::size_t i = 0; i < count; ++i) {
    const Vec3d translation = t.empty() ? Vec3d{} : Vec3d{t[3 * i], t[3 * i + 1], t[3 * i + 2]};
    const Quat rotation = r.empty() ? Quat{} : Quat{r[4 * i], r[4 * i + 1], r[4 * i + 2], r[4 * i + 3]};
    const Vec3d scale = s.empty() ? Vec3d{1, 1, 1} : Vec3d{s[3 * i], s[3 * i + 1], s[3 * i + 2]};
    instances[i] = compose(translation, rotation, scale);
  }
  return instances;
}

void check_light(const ReadState& state, const JsonView& node) {
  const auto extension = node.extension("KHR_lights_punctual");
  if (!extension) return;
  extension->index("light", state.light_count(), "lights");
}

Node read_node(ReadState& state, const JsonView& json) {
  Node node;
  node.name = json.text("name");
  node.children = indices(json, "children", state.count("nodes"), "nodes");
  node.mesh = json.index("mesh", state.count("meshes"), "meshes");
  node.skin = json.index("skin", state.count("skins"), "skins");
  node.camera = json.index("camera", state.count("cameras"), "cameras");
  if (json.has("matrix")) {
    node.matrix.emplace();
    json.numbers_into("matrix", node.matrix->m);
  }
  node.translation = vector3(json, "translation", {0, 0, 0});
  node.rotation = quaternion(json, "rotation");
  node.scale = vector3(json, "scale", {1, 1, 1});
  node.morph_weights = json.numbers("weights");
  node.instances = read_instances(state, json);
  check_light(state, json);
  node.json = state.keeper.keep(json.raw(), json);
  return node;
}

std::vector<int> find_parents(const ReadState& state, const std::vector<JsonView>& json) {
  const std::vector<Node>& nodes = state.model.nodes;
  std::vector<int> parent(nodes.size(), -1);
  for (std::size_t n = 0; n < nodes.size(); ++n) {
    for (std::size_t k = 0; k < nodes[n].children.size(); ++k) {
      int& known = parent[static_cast<std::size_t>(nodes[n].children[k])];
      if (known >= 0) {
        json[n]
            .at("children")
            .elements()[k]
            .fail(fmt::format("node {} is a child of node {} already", nodes[n].children[k], known));
      }
      known = static_cast<int>(n);
    }
  }
  return parent;
}

/// With one parent each, the nodes that no root reaches are those on cycles and below them.
void refuse_cycles(const ReadState& state, const std::vector<JsonView>& json) {
  const std::vector<int> parent = find_parents(state, json);
  std::vector<std::size_t> reached;
  for (std::size_t n = 0; n < parent.size(); ++n) {
    if (parent[n] < 0) reached.push_back(n);
  }
  std::vector<bool> seen(parent.size(), false);
  for (std::size_t i = 0; i < reached.size(); ++i) {
    seen[reached[i]] = true;
    for (const int child : state.model.nodes[reached[i]].children)
      reached.push_back(static_cast<std::size_t>(child));
  }
  const auto missed = std::find(seen.begin(), seen.end(), false);
  if (missed != seen.end()) {
    json[static_cast<std::size_t>(missed - seen.begin())].fail(
        "the node is its own ancestor or below one that is");
  }
}

Camera read_camera(ReadState& state, const JsonView& json) {
  Camera camera;
  camera.name = json.text("name");
  const JsonView type = json.at("type");
  camera.perspective = type.text() == "perspective";
  if (!camera.perspective && type.text() != "orthographic")
    type.fail(shown(type.text()) + " is not a camera type");
  const JsonView lens = json.at(camera.perspective ? "perspective" : "orthographic");
  camera.znear = lens.at("znear").number();
  if (const auto zfar = lens.find("zfar")) camera.zfar = zfar->number();
  if (camera.perspective) {
    camera.yfov_rad = lens.at("yfov").number();
    if (const auto aspect = lens.find("aspectRatio")) camera.aspect = aspect->number();
  } else {
    camera.xmag = lens.at("xmag").number();
    camera.ymag = lens.at("ymag").number();
  }
  camera.json = state.keeper.keep(json.raw(), json);
  return camera;
}

Skin read_skin(ReadState& state, const JsonView& json) {
  Skin skin;
  skin.name = json.text("name");
  json.at("joints");
  skin.joints = indices(json, "joints", state.count("nodes"), "nodes");
  skin.skeleton = json.index("skeleton", state.count("nodes"), "nodes");
  if (const auto reference = json.find("inverseBindMatrices")) {
    Accessor matrices = state.data.read(state.data.accessor_index(*reference));
    if (!matrices.matrix || matrices.width != 16 || matrices.count < skin.joints.size()) {
      reference->fail(fmt::format("{} joints need as many MAT4", skin.joints.size()));
    }
    skin.inverse_bind = std::move(matrices);
  }
  skin.json = state.keeper.keep(without(json.raw(), {"inverseBindMatrices"}), json);
  return skin;
}

}  // namespace

void read_nodes(ReadState& state) {
  const std::vector<JsonView> nodes = state.root.elements("nodes");
  for (const JsonView& json : nodes) state.add(state.model.nodes, read_node(state, json), json);
  refuse_cycles(state, nodes);
}

void read_scenes(ReadState& state) {
  for (const JsonView& json : state.root.elements("scenes")) {
    Scene scene;
    scene.name = json.text("name");
    scene.nodes = indices(json, "nodes", state.count("nodes"), "nodes");
    scene.json = state.keeper.keep(json.raw(), json);
    state.add(state.model.scenes, std::move(scene), json);
  }
  state.model.default_scene = state.root.index("scene", state.model.scenes.size(), "scenes");
}

void read_skins(ReadState& state) {
  for (const JsonView& json : state.root.elements("skins"))
    state.add(state.model.skins, read_skin(state, json), json);
}

void read_cameras(ReadState& state) {
  for (const JsonView& json : state.root.elements("cameras")) {
    state.add(state.model.cameras, read_camera(state, json), json);
  }
}

}  // namespace fovea::gltf
