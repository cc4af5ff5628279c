#include "fovea/model/model.h"

#include <algorithm>

#include "fovea/base/error.h"
#include "fovea/model/weld.h"

namespace fovea {

std::vector<Mat4> world_transforms(const Model& model) { return world_transforms(model.nodes); }

std::vector<Mat4> world_transforms(const std::vector<Node>& nodes) {
  const std::size_t count = nodes.size();
  std::vector<int> parent(count, -1);
  for (std::size_t n = 0; n < count; ++n) {
    for (const int child : nodes[n].children) parent[static_cast<std::size_t>(child)] = static_cast<int>(n);
  }
  std::vector<Mat4> world(count);
  std::vector<char> done(count, 0);
  std::vector<std::size_t> chain;
  for (std::size_t n = 0; n < count; ++n) {
    chain.clear();
    for (std::size_t at = n; !done[at]; at = static_cast<std::size_t>(parent[at])) {
      chain.push_back(at);
      if (chain.size() > count) throw Error(ErrorKind::internal, "the node hierarchy has a cycle", "nodes");
      if (parent[at] < 0) break;
    }
    for (; !chain.empty(); chain.pop_back()) {
      const std::size_t at = chain.back();
      const Mat4 local = nodes[at].local();
      world[at] = parent[at] < 0 ? local : world[static_cast<std::size_t>(parent[at])] * local;
      done[at] = 1;
    }
  }
  return world;
}

std::vector<bool> shown_nodes(const Model& model) {
  const bool has_scene = !model.scenes.empty();
  std::vector<bool> shown(model.nodes.size(), !has_scene);
  if (!has_scene) return shown;
  std::vector<int> stack = model.scenes[static_cast<std::size_t>(std::max(model.default_scene, 0))].nodes;
  while (!stack.empty()) {
    const auto n = static_cast<std::size_t>(stack.back());
    stack.pop_back();
    if (shown[n]) continue;
    shown[n] = true;
    stack.insert(stack.end(), model.nodes[n].children.begin(), model.nodes[n].children.end());
  }
  return shown;
}

namespace {

/// Where a skin puts a mesh in the rest pose, told by its first joint.
Mat4 skin_transform(const Skin& skin, const std::vector<Mat4>& world) {
  if (skin.joints.empty()) return {};
  const Mat4& joint = world[static_cast<std::size_t>(skin.joints[0])];
  if (!skin.inverse_bind || skin.inverse_bind->count == 0) return joint;
  Mat4 inverse_bind;
  const std::vector<float> numbers = skin.inverse_bind->to_floats();
  std::copy_n(numbers.begin(), 16, inverse_bind.m.begin());
  return joint * inverse_bind;
}

}  // namespace

std::vector<std::vector<Mat4>> mesh_instances(const Model& model) {
  std::vector<std::vector<Mat4>> result(model.meshes.size());
  const std::vector<Mat4> world = world_transforms(model);
  const std::vector<bool> shown = shown_nodes(model);
  for (std::size_t n = 0; n < model.nodes.size(); ++n) {
    const Node& node = model.nodes[n];
    if (node.mesh < 0 || !shown[n]) continue;
    auto& instances = result[static_cast<std::size_t>(node.mesh)];
    if (node.skin >= 0) {
      instances.push_back(skin_transform(model.skins[static_cast<std::size_t>(node.skin)], world));
    } else if (node.instances.empty()) {
      instances.push_back(world[n]);
    } else {
      for (const Mat4& instance : node.instances) instances.push_back(world[n] * instance);
    }
  }
  return result;
}

std::vector<double> largest_scales(const Model& model) {
  std::vector<double> scales;
  for (const std::vector<Mat4>& instances : mesh_instances(model)) {
    double largest = 0;
    for (const Mat4& world : instances) largest = std::max(largest, std::cbrt(std::abs(determinant3(world))));
    scales.push_back(largest);
  }
  return scales;
}

Box bounds(const Model& model) {
  Box box;
  const auto instances = mesh_instances(model);
  for (std::size_t m = 0; m < model.meshes.size(); ++m) {
    for (const Mat4& transform : instances[m]) {
      for (const Vec3f& p : model.meshes[m].surface.positions) box.add(transform_point(transform, Vec3d(p)));
    }
  }
  return box;
}

ModelCounts counts(const Model& model) {
  ModelCounts c;
  const auto instances = mesh_instances(model);
  for (std::size_t m = 0; m < model.meshes.size(); ++m) {
    const TriMesh& mesh = model.meshes[m].surface;
    c.triangles += mesh.face_count();
    c.triangles_drawn += mesh.face_count() * instances[m].size();
    c.vertices += mesh.vertex_count();
    c.split_vertices += split_vertex_count(mesh);
  }
  for (const EncodedImage& image : model.images) c.image_bytes += image.bytes.size();
  return c;
}

}  // namespace fovea
