#include "fovea/lod/level_model.h"

#include <utility>

namespace fovea {

namespace {

/// Copies of the vertices that a mesh uses.
class LevelMesh {
 public:
  LevelMesh(const TriMesh& original, const LevelVertices& vertices)
      : vertices_(vertices), number_(vertices.positions.size()) {
    mesh_.position_storage = original.position_storage;
    mesh_.parts = original.parts;
    mesh_.position_morphs.resize(vertices.position_morphs.size());
    for (const AttributeLayer& layer : vertices.layers) {
      AttributeLayer& copy = mesh_.layers.emplace_back();
      copy.semantic = layer.semantic;
      copy.set = layer.set;
      copy.name = layer.name;
      copy.width = layer.width;
      copy.storage = layer.storage;
      copy.morphs.resize(layer.morphs.size());
    }
  }

  /// `lacks` [#layers]: which layers the part is without.
  void add(std::span<const std::uint32_t> indices, std::uint32_t part, const std::vector<bool>& lacks) {
    for (std::size_t i = 0; i < indices.size(); i += 3) {
      std::array<VertexId, 3>& triangle = mesh_.triangles.emplace_back();
      mesh_.face_part.push_back(part);
      for (std::size_t k = 0; k < 3; ++k) {
        triangle[k] = vertex(indices[i + k]);
        for (std::size_t l = 0; l < lacks.size(); ++l)
          mesh_.layers[l].corner_value.push_back(lacks[l] ? ValueId{} : ValueId{triangle[k].index()});
      }
    }
  }

  TriMesh take() { return std::move(mesh_); }

 private:
  VertexId vertex(std::uint32_t v) {
    if (number_[v].valid()) return number_[v];
    number_[v] = VertexId{mesh_.positions.size()};
    mesh_.positions.push_back(vertices_.positions[v]);
    for (std::size_t t = 0; t < mesh_.position_morphs.size(); ++t)
      mesh_.position_morphs[t].push_back(vertices_.position_morphs[t][v]);
    for (std::size_t l = 0; l < mesh_.layers.size(); ++l) {
      const AttributeLayer& from = vertices_.layers[l];
      AttributeLayer& to = mesh_.layers[l];
      const auto copy = [&](const std::vector<float>& values, std::vector<float>& out) {
        if (values.empty()) return;
        const auto begin = values.begin() + static_cast<std::ptrdiff_t>(v) * from.width;
        out.insert(out.end(), begin, begin + from.width);
      };
      copy(from.values, to.values);
      for (std::size_t t = 0; t < from.morphs.size(); ++t) copy(from.morphs[t], to.morphs[t]);
    }
    return number_[v];
  }

  const LevelVertices& vertices_;
  std::vector<VertexId> number_;
  TriMesh mesh_;
};

/// Which layers a part of a mesh is without.
std::vector<bool> lacking(const TriMesh& mesh, std::uint32_t part) {
  std::size_t f = 0;
  while (mesh.face_part[f] != part) ++f;
  std::vector<bool> lacks;
  for (const AttributeLayer& layer : mesh.layers) lacks.push_back(!layer.corner_value[3 * f].valid());
  return lacks;
}

}  // namespace

Model model_of_level(const Model& original, const VertexHierarchy& hierarchy, const LevelIndices& level) {
  Model model = original;
  for (std::uint32_t m = 0; m < model.meshes.size(); ++m) {
    const TriMesh& surface = original.meshes[m].surface;
    LevelMesh mesh(surface, hierarchy.vertices[m]);
    for (std::size_t p = 0; p < hierarchy.parts.size(); ++p) {
      const LevelPart& part = hierarchy.parts[p];
      if (part.mesh == m) mesh.add(level.of_part(hierarchy, p), part.part, lacking(surface, part.part));
    }
    model.meshes[m].surface = mesh.take();
  }
  return model;
}

}  // namespace fovea
