#include "fovea/render/plain_model.h"

#include <algorithm>

namespace fovea {

Model plain_model(const Model& model, const std::string& material) {
  Model result = model;
  Material white;
  white.name = material;
  white.metallic_factor = 0;
  white.double_sided = std::any_of(model.materials.begin(), model.materials.end(),
                                   [](const Material& m) { return m.double_sided; });
  result.materials = {white};
  result.textures.clear();
  result.samplers.clear();
  result.images.clear();
  for (Mesh& own : result.meshes) {
    TriMesh& mesh = own.surface;
    for (Part& part : mesh.parts) {
      part.material = part.raw ? -1 : 0;
      part.json.clear();
    }
    std::erase_if(mesh.layers, [](const AttributeLayer& layer) {
      return layer.semantic != Semantic::normal && layer.semantic != Semantic::joints &&
             layer.semantic != Semantic::weights;
    });
  }
  return result;
}

void remove_attribute(TriMesh& mesh, const std::string& name) {
  std::erase_if(mesh.layers, [&](const AttributeLayer& layer) {
    return layer.semantic == Semantic::custom && layer.name == name;
  });
}

}  // namespace fovea
