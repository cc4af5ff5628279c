#include "fovea/render/heat_map.h"

#include <utility>

#include "fovea/base/srgb.h"
#include "fovea/model/check_fields.h"
#include "fovea/render/plain_model.h"
#include "fovea/render/render.h"

namespace fovea {

namespace {

/// A layer with one value for each vertex.
AttributeLayer vertex_layer(const TriMesh& mesh, Semantic semantic, int width) {
  AttributeLayer layer;
  layer.semantic = semantic;
  layer.width = width;
  layer.values.resize(mesh.vertex_count() * static_cast<std::size_t>(width));
  layer.corner_value.reserve(3 * mesh.face_count());
  for (const auto& triangle : mesh.triangles) {
    for (const VertexId v : triangle) layer.corner_value.push_back(ValueId{v.value});
  }
  return layer;
}

AttributeLayer heat_layer(const TriMesh& mesh, const VertexField& field) {
  AttributeLayer layer = vertex_layer(mesh, Semantic::color, 3);
  layer.storage = {ComponentType::u16, true};
  for (std::size_t v = 0; v < field.size(); ++v) {
    const std::array<std::uint8_t, 3> color = heat_color(field.values()[v]);
    for (std::size_t c = 0; c < 3; ++c) layer.values[3 * v + c] = to_light(color[c]);
  }
  return layer;
}

}  // namespace

Model heat_map(const Model& model, const std::vector<VertexField>& fields) {
  check_fields(model, fields);
  Model result = plain_model(model, "heat");
  for (std::size_t m = 0; m < result.meshes.size(); ++m) {
    TriMesh& mesh = result.meshes[m].surface;
    mesh.layers.push_back(heat_layer(mesh, fields[m]));
  }
  return result;
}

Model with_attribute(const Model& model, const std::vector<VertexField>& fields, const std::string& name) {
  check_fields(model, fields);
  Model result = model;
  for (std::size_t m = 0; m < result.meshes.size(); ++m) {
    TriMesh& mesh = result.meshes[m].surface;
    remove_attribute(mesh, name);
    AttributeLayer layer = vertex_layer(mesh, Semantic::custom, 1);
    layer.name = name;
    layer.values.assign(fields[m].values().begin(), fields[m].values().end());
    mesh.layers.push_back(std::move(layer));
  }
  return result;
}

}  // namespace fovea
