#include "fovea/lod/lod_chain_gltf.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <set>
#include <string>

#include "fovea/base/error.h"
#include "fovea/lod/lod_chain_parts.h"
#include "fovea/surface/pose.h"

namespace fovea {

namespace {

using Json = nlohmann::ordered_json;

constexpr const char* kLod = "MSFT_lod";
constexpr const char* kCoverage = "MSFT_screencoverage";
constexpr const char* kInstancing = "EXT_mesh_gpu_instancing";

Json object_of(const std::string& text) {
  Json json = text.empty() ? Json::object() : Json::parse(text, nullptr, false);
  return json.is_object() ? json : Json::object();
}

/// Names of a node's extensions.
std::set<std::string> extensions_of(const Json& node) {
  std::set<std::string> names;
  if (!node.contains("extensions") || !node["extensions"].is_object()) return names;
  for (const auto& extension : node["extensions"].items()) names.insert(extension.key());
  return names;
}

/// For each node the radius of the sphere around all that it shows at rest; 0 for nothing.
std::vector<double> shown_radii(const Model& model) {
  const Pose pose = rest_pose(model);
  std::vector<Box> boxes(model.nodes.size());
  std::vector<std::vector<Vec3f>> points(model.nodes.size());
  for (const Instance& instance : instances(model, pose)) {
    const PosedSurface surface = posed_surface(model, pose, instance);
    for (const Vec3f& p : surface.positions) boxes[instance.node].add(Vec3d(p));
    points[instance.node].insert(points[instance.node].end(), surface.positions.begin(),
                                 surface.positions.end());
  }
  std::vector<double> radii(model.nodes.size());
  for (std::size_t n = 0; n < radii.size(); ++n) {
    for (const Vec3f& p : points[n]) radii[n] = std::max(radii[n], length(Vec3d(p) - boxes[n].center()));
  }
  return radii;
}

class LodMerger {
 public:
  LodMerger(const LodChain& chain, double vanish, Context& context)
      : chain_(chain), vanish_(vanish), context_(context), all_(chain.levels.front().model) {}

  Model run(std::vector<int>* level_of) {
    add_scene();
    radii_ = shown_radii(all_);
    find_needed();
    LodParts parts(all_);
    for (std::size_t i = 1; i < chain_.levels.size(); ++i)
      mesh_.push_back(parts.add(chain_.levels[i].model, static_cast<int>(i)));
    const std::size_t count = all_.nodes.size();
    for (std::size_t n = 0; n < count; ++n) add_levels(n);
    tell_pointers();
    if (level_of != nullptr) *level_of = find_originals();
    return std::move(all_);
  }

 private:
  /// Without scenes all nodes are shown, and those of levels would be.
  void add_scene() {
    if (!all_.scenes.empty()) return;
    std::vector<bool> is_child(all_.nodes.size());
    for (const Node& node : all_.nodes)
      for (const int child : node.children) is_child[static_cast<std::size_t>(child)] = true;
    Scene& scene = all_.scenes.emplace_back();
    for (std::size_t n = 0; n < is_child.size(); ++n)
      if (!is_child[n]) scene.nodes.push_back(static_cast<int>(n));
    all_.default_scene = 0;
  }

  /// Nodes that others than their mesh need.
  void find_needed() {
    needed_.resize(all_.nodes.size());
    for (const Skin& skin : all_.skins) {
      for (const int joint : skin.joints) needed_[static_cast<std::size_t>(joint)] = true;
      if (skin.skeleton >= 0) needed_[static_cast<std::size_t>(skin.skeleton)] = true;
    }
    for (const Animation& animation : all_.animations) {
      for (const AnimationChannel& channel : animation.channels)
        if (channel.node >= 0 && channel.path != "weights")
          needed_[static_cast<std::size_t>(channel.node)] = true;
    }
    for (std::size_t n = 0; n < needed_.size(); ++n) {
      const Node& node = all_.nodes[n];
      std::set<std::string> extensions = extensions_of(object_of(node.json));
      extensions.erase(kInstancing);
      if (!node.children.empty() || node.camera >= 0 || !extensions.empty() || pointed_at(n))
        needed_[n] = true;
    }
  }

  /// Whether KHR_animation_pointer moves a node.
  bool pointed_at(std::size_t node) const {
    const std::string place = fmt::format("\"/nodes/{}/", node);
    return std::ranges::any_of(all_.animations, [&](const Animation& animation) {
      return std::ranges::any_of(animation.channels, [&](const AnimationChannel& channel) {
        return channel.json.find(place) != std::string::npos;
      });
    });
  }

  /// [#meshes] Of the original, that each is a level of; -1 for those.
  std::vector<int> find_originals() const {
    std::vector<int> original(all_.meshes.size(), -1);
    for (const std::vector<int>& level : mesh_) {
      for (std::size_t m = 0; m < level.size(); ++m) {
        if (level[m] != static_cast<int>(m))
          original[static_cast<std::size_t>(level[m])] = static_cast<int>(m);
      }
    }
    return original;
  }

  void add_levels(std::size_t n) {
    const int mesh = all_.nodes[n].mesh;
    if (mesh < 0) return;
    std::vector<int> meshes;
    for (const std::vector<int>& level : mesh_) meshes.push_back(level[static_cast<std::size_t>(mesh)]);
    if (std::ranges::all_of(meshes, [&](int m) { return m == mesh; }) && vanish_ == 0) return;
    const std::size_t shown = needed_[n] ? move_mesh(n) : n;
    Json ids = Json::array();
    for (std::size_t i = 0; i < meshes.size(); ++i) {
      Node level = all_.nodes[shown];
      level.mesh = meshes[i];
      if (!level.name.empty()) level.name = fmt::format("{}_LOD{}", all_.nodes[n].name, i + 1);
      ids.push_back(all_.nodes.size());
      follow_weights(static_cast<int>(shown), static_cast<int>(all_.nodes.size()));
      all_.nodes.push_back(std::move(level));
    }
    name_levels(all_.nodes[shown], std::move(ids), radii_[n]);
  }

  /// Moves the mesh of a node, with all that belongs to it, to a new child. Returns that.
  std::size_t move_mesh(std::size_t n) {
    const int child = static_cast<int>(all_.nodes.size());
    Node shown;
    Node& node = all_.nodes[n];
    if (!node.name.empty()) shown.name = node.name + "_LOD0";
    shown.mesh = std::exchange(node.mesh, -1);
    shown.skin = std::exchange(node.skin, -1);
    shown.morph_weights = std::exchange(node.morph_weights, {});
    shown.instances = std::exchange(node.instances, {});
    Json json = object_of(node.json);
    if (extensions_of(json).contains(kInstancing)) {
      shown.json = Json{{"extensions", {{kInstancing, json["extensions"][kInstancing]}}}}.dump();
      json["extensions"].erase(kInstancing);
      if (json["extensions"].empty()) json.erase("extensions");
      node.json = json.dump();
    }
    node.children.push_back(child);
    all_.nodes.push_back(std::move(shown));
    for (Animation& animation : all_.animations) {
      for (AnimationChannel& channel : animation.channels)
        if (channel.node == static_cast<int>(n) && channel.path == "weights") channel.node = child;
    }
    return static_cast<std::size_t>(child);
  }

  /// Whatever moves the morph weights of a node moves those of a level, too.
  void follow_weights(int node, int level) {
    for (Animation& animation : all_.animations) {
      const std::size_t count = animation.channels.size();
      for (std::size_t c = 0; c < count; ++c) {
        if (animation.channels[c].node != node || animation.channels[c].path != "weights") continue;
        AnimationChannel copy = animation.channels[c];
        copy.node = level;
        animation.channels.push_back(std::move(copy));
      }
    }
  }

  void name_levels(Node& node, Json ids, double radius) {
    Json json = object_of(node.json);
    if (json.contains("extensions") && !json["extensions"].is_object()) json.erase("extensions");
    json["extensions"][kLod]["ids"] = std::move(ids);
    Json coverage = Json::array();
    for (std::size_t i = 1; i < chain_.levels.size(); ++i) {
      const double distance = chain_.levels[i].distance;
      coverage.push_back(area_of(coverage_at(distance, radius, chain_.screen), chain_.screen));
    }
    coverage.push_back(area_of(vanish_ * radius / chain_.sphere.radius, chain_.screen));
    if (json.contains("extras") && !json["extras"].is_object()) {
      context_.report("extras-replaced", "extras that are no object gave way to the coverage of levels",
                      node.name);
      json.erase("extras");
    }
    json["extras"][kCoverage] = std::move(coverage);
    node.json = json.dump();
  }

  void tell_pointers() {
    for (const Animation& animation : all_.animations) {
      for (const AnimationChannel& channel : animation.channels) {
        if (channel.path == "pointer" && (channel.json.find("/weights") != std::string::npos ||
                                          channel.json.find("/materials/") != std::string::npos))
          context_.report("lod-pointer", "animation pointers to weights or materials move level 0 alone",
                          animation.name);
      }
    }
  }

  const LodChain& chain_;
  double vanish_;
  Context& context_;
  Model all_;
  std::vector<double> radii_;           // [#nodes]
  std::vector<bool> needed_;            // [#nodes]
  std::vector<std::vector<int>> mesh_;  // [level - 1][#meshes]
};

}  // namespace

Model with_lods(const LodChain& chain, double vanish, Context& context, std::vector<int>* level_of) {
  if (chain.levels.size() < 2)
    throw Error(ErrorKind::usage, "a chain of one level has nothing to switch", "lods");
  const double last = chain.levels.back().coverage;
  if (!(vanish >= 0) || vanish >= last)
    throw Error(ErrorKind::usage,
                fmt::format("nothing can vanish at a coverage of {}: the last level comes in at {:.4g}",
                            vanish, last),
                "--vanish", "give less; 0 never lets it vanish");
  return LodMerger(chain, vanish, context).run(level_of);
}

}  // namespace fovea
