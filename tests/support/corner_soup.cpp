#include "support/corner_soup.h"

#include <algorithm>
#include <cstring>

namespace fovea::test {

namespace {

void put(std::string& key, const float* values, std::size_t count) {
  for (std::size_t i = 0; i < count; ++i) {
    const float value = values[i] == 0 ? 0.0f : values[i];
    char bits[sizeof(float)];
    std::memcpy(bits, &value, sizeof(bits));
    key.append(bits, sizeof(bits));
  }
}

/// A joint without weight is nobody's business: files put 0 there.
void clear_unused_joints(const TriMesh& mesh, const AttributeLayer& joints, CornerId corner,
                         std::vector<float>& values) {
  const AttributeLayer* weights = mesh.find(Semantic::weights, joints.set);
  if (!weights || !weights->corner_value[corner.index()].valid()) return;
  const float* w = weights->value(weights->corner_value[corner.index()]);
  for (std::size_t i = 0; i < values.size() && i < static_cast<std::size_t>(weights->width); ++i) {
    if (w[i] == 0) values[i] = 0;
  }
}

std::string layer_key(const TriMesh& mesh, const AttributeLayer& layer, CornerId corner) {
  const ValueId id = layer.corner_value[corner.index()];
  if (!id.valid()) return {};
  const std::size_t width = static_cast<std::size_t>(layer.width);
  std::string key =
      std::to_string(static_cast<int>(layer.semantic)) + ":" + std::to_string(layer.set) + layer.name;
  std::vector<float> values(layer.value(id), layer.value(id) + width);
  if (layer.semantic == Semantic::joints) clear_unused_joints(mesh, layer, corner, values);
  put(key, values.data(), width);
  for (const auto& morph : layer.morphs) {
    const std::vector<float> none(width, 0.0f);
    put(key, morph.empty() ? none.data() : &morph[id.index() * width], width);
  }
  return key;
}

std::string corner_key(const TriMesh& mesh, CornerId corner) {
  std::string key;
  const VertexId vertex = mesh.vertex(corner);
  put(key, &mesh.positions[vertex.index()].x, 3);
  for (const auto& morph : mesh.position_morphs) put(key, &morph[vertex.index()].x, 3);
  std::vector<std::string> layers;
  for (const AttributeLayer& layer : mesh.layers) layers.push_back(layer_key(mesh, layer, corner));
  std::sort(layers.begin(), layers.end());
  for (const std::string& layer : layers) key += layer;
  return key;
}

}  // namespace

std::vector<std::vector<std::string>> corner_soup(const TriMesh& mesh) {
  std::vector<std::vector<std::string>> parts(mesh.parts.size());
  for (std::size_t f = 0; f < mesh.face_count(); ++f) {
    std::vector<std::string> corners;
    for (std::size_t k = 0; k < 3; ++k) corners.push_back(corner_key(mesh, CornerId{3 * f + k}));
    std::rotate(corners.begin(), std::min_element(corners.begin(), corners.end()), corners.end());
    parts[mesh.face_part[f]].push_back(corners[0] + corners[1] + corners[2]);
  }
  std::erase_if(parts, [](const auto& part) { return part.empty(); });
  for (auto& part : parts) std::sort(part.begin(), part.end());
  return parts;
}

}  // namespace fovea::test
