#include "fovea/model/tri_mesh.h"

#include <fmt/format.h>

#include <cmath>
#include <utility>

#include "fovea/base/error.h"

namespace fovea {

namespace {

[[noreturn]] void broken(const std::string& message) { throw Error(ErrorKind::internal, message, "mesh"); }

void check_triangles(const TriMesh& mesh) {
  if (mesh.face_part.size() != mesh.face_count()) broken("face_part has the wrong size");
  for (std::size_t f = 0; f < mesh.face_count(); ++f) {
    const auto& t = mesh.triangles[f];
    for (const VertexId v : t) {
      if (v.index() >= mesh.vertex_count()) broken(fmt::format("triangle {} uses vertex {}", f, v.value));
    }
    if (t[0] == t[1] || t[1] == t[2] || t[2] == t[0])
      broken(fmt::format("triangle {} uses a vertex twice", f));
    if (mesh.face_part[f] >= mesh.parts.size()) broken(fmt::format("triangle {} has no part", f));
  }
}

void check_layer(const TriMesh& mesh, const AttributeLayer& layer, std::size_t index) {
  if (layer.corner_value.size() != 3 * mesh.face_count())
    broken(fmt::format("layer {}: corner map size", index));
  if (layer.width <= 0 || layer.values.size() % layer.width != 0)
    broken(fmt::format("layer {}: width", index));
  std::vector<VertexId> owner(layer.size());
  for (std::size_t c = 0; c < layer.corner_value.size(); ++c) {
    const ValueId value = layer.corner_value[c];
    if (!value.valid()) continue;
    if (value.index() >= layer.size()) broken(fmt::format("layer {}: corner {} has no value", index, c));
    const VertexId v = mesh.vertex(CornerId{c});
    if (owner[value.index()].valid() && owner[value.index()] != v) {
      broken(fmt::format("layer {}: value {} is shared by two vertices", index, value.value));
    }
    owner[value.index()] = v;
  }
  for (const auto& morph : layer.morphs) {
    if (!morph.empty() && morph.size() != layer.values.size())
      broken(fmt::format("layer {}: morph size", index));
  }
}

}  // namespace

const AttributeLayer* TriMesh::find(Semantic semantic, int set) const {
  for (const AttributeLayer& layer : layers) {
    if (layer.semantic == semantic && layer.set == set) return &layer;
  }
  return nullptr;
}

AttributeLayer* TriMesh::find(Semantic semantic, int set) {
  return const_cast<AttributeLayer*>(std::as_const(*this).find(semantic, set));
}

bool is_white(const AttributeLayer& colors) {
  for (std::size_t i = 0; i < colors.size(); ++i) {
    const float* const c = colors.value(ValueId{i});
    if (!(c[0] >= 1 && c[1] >= 1 && c[2] >= 1)) return false;
  }
  return true;
}

Box bounds(const TriMesh& mesh) {
  Box box;
  for (const Vec3f& p : mesh.positions) box.add(Vec3d(p));
  return box;
}

void check(const TriMesh& mesh) {
  for (const Vec3f& p : mesh.positions) {
    if (!std::isfinite(p.x) || !std::isfinite(p.y) || !std::isfinite(p.z)) broken("a position is not finite");
  }
  for (const auto& morph : mesh.position_morphs) {
    if (morph.size() != mesh.vertex_count()) broken("a position morph has the wrong size");
  }
  check_triangles(mesh);
  for (std::size_t i = 0; i < mesh.layers.size(); ++i) check_layer(mesh, mesh.layers[i], i);
}

}  // namespace fovea
