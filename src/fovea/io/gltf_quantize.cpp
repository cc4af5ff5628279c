#include "fovea/io/gltf_quantize.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <set>

#include "fovea/io/gltf_json_write.h"

namespace fovea::gltf {

namespace {

/// Calls `f(number)` for every integer member called `key` anywhere inside `json`.
template <class F>
void for_each_index(const Json& json, const char* key, const F& f) {
  if (!json.is_structured()) return;
  for (const auto& [name, value] : json.items()) {
    if (json.is_object() && name == key && value.is_number_integer()) f(value.template get<std::int64_t>());
    for_each_index(value, key, f);
  }
}

const Json& extensions_of(const Json& object) {
  static const Json kNone = Json::object();
  const auto at = object.find("extensions");
  return at != object.end() ? *at : kNone;
}

bool has_thickness(const Material& material) {
  const Json json = parse_object(material.json);
  const Json* volume = find_extension(json, "KHR_materials_volume");
  return volume && volume->is_object() && volume->value("thicknessFactor", 0.0) != 0;
}

/// What decides which meshes can have a grid.
class Planner {
 public:
  Planner(const Model& model, std::span<const int> vertices_of, const WriteOptions& options, Context& context)
      : model_(model),
        vertices_of_(vertices_of),
        options_(options),
        context_(context),
        floating_(model.meshes.size()) {}

  QuantizationPlan run() {
    start_plan();
    if (!options_.quantize) return std::move(plan_);
    group_meshes_and_skins();
    keep_floating();
    make_grids();
    add_nodes();
    return std::move(plan_);
  }

 private:
  void start_plan();
  void group_meshes_and_skins();
  void keep_floating();
  void keep(std::int64_t mesh, const char* why);
  void keep_by_nodes();
  void keep_by_meshes();
  void keep_by_extensions();
  void make_grids();
  void add_nodes();

  std::size_t root(std::size_t i) const {
    while (group_[i] != i) i = group_[i];
    return i;
  }
  std::size_t skin_item(int skin) const { return model_.meshes.size() + static_cast<std::size_t>(skin); }
  bool is_shown(const Node& node) const {
    return node.mesh >= 0 && static_cast<std::size_t>(node.mesh) < model_.meshes.size();
  }

  const Model& model_;
  std::span<const int> vertices_of_;
  const WriteOptions& options_;
  Context& context_;
  QuantizationPlan plan_;
  std::vector<bool> floating_;      // [#meshes]
  std::vector<std::size_t> group_;  // [#meshes + #skins], a forest of those that share a grid
};

void Planner::start_plan() {
  plan_.mesh_grid.resize(model_.meshes.size());
  plan_.skin_grid.resize(model_.skins.size());
  plan_.nodes = model_.nodes;
  plan_.mesh_node.resize(model_.nodes.size());
  std::iota(plan_.mesh_node.begin(), plan_.mesh_node.end(), 0);
}

void Planner::group_meshes_and_skins() {
  group_.resize(model_.meshes.size() + model_.skins.size());
  std::iota(group_.begin(), group_.end(), std::size_t{0});
  const auto join = [&](std::size_t i, std::size_t j) {
    const std::size_t a = root(i), b = root(j);
    group_[std::max(a, b)] = std::min(a, b);
  };
  for (const Node& node : model_.nodes) {
    if (is_shown(node) && node.skin >= 0) join(static_cast<std::size_t>(node.mesh), skin_item(node.skin));
  }
  for (std::size_t m = 0; m < vertices_of_.size(); ++m) {
    if (vertices_of_[m] >= 0) join(m, static_cast<std::size_t>(vertices_of_[m]));
  }
}

void Planner::keep(std::int64_t mesh, const char* why) {
  if (mesh < 0 || static_cast<std::size_t>(mesh) >= floating_.size()) return;
  if (floating_[static_cast<std::size_t>(mesh)]) return;
  floating_[static_cast<std::size_t>(mesh)] = true;
  context_.report("mesh-not-quantized", fmt::format("positions were kept as they were: {}", why),
                  fmt::format("/meshes/{}", mesh));
}

void Planner::keep_by_nodes() {
  std::vector<bool> with_skin(floating_.size()), without_skin(floating_.size());
  for (const Node& node : model_.nodes) {
    if (!is_shown(node)) continue;
    if (!node.instances.empty()) keep(node.mesh, "the mesh is instanced");
    (node.skin >= 0 ? with_skin : without_skin)[static_cast<std::size_t>(node.mesh)] = true;
  }
  for (std::size_t m = 0; m < floating_.size(); ++m) {
    const std::int64_t mesh = static_cast<std::int64_t>(m);
    if (!with_skin[m] && !without_skin[m]) keep(mesh, "no node shows the mesh");
    if (with_skin[m] && without_skin[m]) keep(mesh, "the mesh is shown both with and without a skin");
  }
}

void Planner::keep_by_meshes() {
  std::vector<bool> thick;
  for (const Material& material : model_.materials) thick.push_back(has_thickness(material));
  const auto is_thick = [&](std::int64_t m) {
    return m >= 0 && static_cast<std::size_t>(m) < thick.size() && thick[static_cast<std::size_t>(m)];
  };
  for (std::size_t m = 0; m < floating_.size(); ++m) {
    const std::int64_t mesh = static_cast<std::int64_t>(m);
    const TriMesh& surface = model_.meshes[m].surface;
    if (surface.positions.empty()) keep(mesh, "it has no triangles");
    if (surface.position_storage.type != ComponentType::f32) keep(mesh, "they are integers already");
    for (const Part& part : surface.parts) {
      if (part.raw) keep(mesh, "the mesh has points or lines");
      bool any_thick = is_thick(part.material);
      for_each_index(extensions_of(parse_object(part.json)), "material",
                     [&](std::int64_t material) { any_thick = any_thick || is_thick(material); });
      if (any_thick) keep(mesh, "the thickness of its material is a length in the mesh's space");
    }
  }
}

/// Extensions may show a mesh or move its morph weights in ways unknown here.
void Planner::keep_by_extensions() {
  const auto keep_named = [&](const Json& object) {
    for_each_index(extensions_of(object), "mesh",
                   [&](std::int64_t mesh) { keep(mesh, "an extension refers to the mesh"); });
  };
  keep_named(parse_object(model_.json));
  for (const Node& node : model_.nodes) keep_named(parse_object(node.json));
  for (const Animation& animation : model_.animations) {
    for (const AnimationChannel& channel : animation.channels) {
      if (channel.path != "pointer") continue;
      for (std::size_t n = 0; n < model_.nodes.size(); ++n) {
        if (channel.json.find(fmt::format("/nodes/{}/weights", n)) == std::string::npos) continue;
        keep(model_.nodes[n].mesh, "an extension animates its morph weights");
      }
    }
  }
}

/// One mesh that stays keeps its whole group, because the group shares skins.
void Planner::keep_floating() {
  keep_by_nodes();
  keep_by_meshes();
  keep_by_extensions();
  std::set<std::size_t> kept_groups;
  for (std::size_t m = 0; m < floating_.size(); ++m) {
    if (floating_[m]) kept_groups.insert(root(m));
  }
  for (std::size_t m = 0; m < floating_.size(); ++m) {
    if (kept_groups.contains(root(m))) {
      keep(static_cast<std::int64_t>(m), "it shares a skin or vertices with a mesh that was kept");
    }
  }
}

Grid grid_of(const Box& box, std::int64_t bits) {
  const Vec3d size = box.high - box.low;
  const double extent = std::max({size.x, size.y, size.z});
  const double top = std::ldexp(1.0, static_cast<int>(bits)) - 1;
  return {box.low, extent > 0 ? extent / top : 1.0};
}

void Planner::make_grids() {
  std::vector<Box> boxes(group_.size());
  for (std::size_t m = 0; m < floating_.size(); ++m) {
    if (!floating_[m]) boxes[root(m)].add(bounds(model_.meshes[m].surface));
  }
  const auto grid = [&](std::size_t item) -> std::optional<Grid> {
    const Box& box = boxes[root(item)];
    if (box.empty()) return std::nullopt;
    return grid_of(box, options_.position_bits);
  };
  for (std::size_t m = 0; m < floating_.size(); ++m) plan_.mesh_grid[m] = grid(m);
  for (std::size_t s = 0; s < model_.skins.size(); ++s)
    plan_.skin_grid[s] = grid(skin_item(static_cast<int>(s)));
}

void Planner::add_nodes() {
  for (std::size_t n = 0; n < model_.nodes.size(); ++n) {
    if (!is_shown(model_.nodes[n]) || model_.nodes[n].skin >= 0) continue;
    const auto& grid = plan_.mesh_grid[static_cast<std::size_t>(model_.nodes[n].mesh)];
    if (!grid) continue;
    Node child;
    child.translation = grid->offset;
    child.scale = {grid->step, grid->step, grid->step};
    child.mesh = std::exchange(plan_.nodes[n].mesh, -1);
    child.morph_weights = std::exchange(plan_.nodes[n].morph_weights, {});
    plan_.mesh_node[n] = static_cast<int>(plan_.nodes.size());
    plan_.nodes[n].children.push_back(plan_.mesh_node[n]);
    plan_.nodes.push_back(std::move(child));
  }
}

}  // namespace

QuantizationPlan plan_quantization(const Model& model, std::span<const int> vertices_of,
                                   const WriteOptions& options, Context& context) {
  return Planner(model, vertices_of, options, context).run();
}

Accessor fold_grid(const Skin& skin, const Grid& grid) {
  std::vector<float> matrices;
  if (skin.inverse_bind) matrices = skin.inverse_bind->to_floats();
  for (std::size_t j = matrices.size() / 16; j < skin.joints.size(); ++j) {
    for (const double x : Mat4{}.m) matrices.push_back(static_cast<float>(x));
  }
  const Mat4 from_grid = compose(grid.offset, Quat{}, {grid.step, grid.step, grid.step});
  for (std::size_t j = 0; 16 * j < matrices.size(); ++j) {
    Mat4 inverse_bind;
    std::copy_n(matrices.begin() + static_cast<std::ptrdiff_t>(16 * j), 16, inverse_bind.m.begin());
    inverse_bind = inverse_bind * from_grid;
    std::transform(inverse_bind.m.begin(), inverse_bind.m.end(),
                   matrices.begin() + static_cast<std::ptrdiff_t>(16 * j),
                   [](double x) { return static_cast<float>(x); });
  }
  Accessor folded = Accessor::from_floats(matrices, 16);
  folded.matrix = true;
  return folded;
}

}  // namespace fovea::gltf
