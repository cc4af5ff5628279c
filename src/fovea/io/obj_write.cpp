#include "fovea/io/obj_write.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "fovea/base/srgb.h"
#include "fovea/io/flatten.h"
#include "fovea/io/mtl_write.h"

namespace fovea {

namespace {

/// Per vertex the first value of a layer that one of its corners has; null if none has.
std::vector<const float*> value_of_vertex(const TriMesh& mesh, const AttributeLayer& layer) {
  std::vector<const float*> result(mesh.vertex_count(), nullptr);
  for (std::size_t c = 0; c < layer.corner_value.size(); ++c) {
    const float*& value = result[mesh.vertex(CornerId{c}).index()];
    if (!value && layer.corner_value[c].valid()) value = layer.value(layer.corner_value[c]);
  }
  return result;
}

class ObjWriter {
 public:
  ObjWriter(const Model& model, const std::string& stem) : model_(model), stem_(stem) {}

  std::vector<OutputFile> run();

 private:
  /// A table of texture coordinates in the file: which, and the number of its first line.
  struct UvTable {
    UvSource source;
    std::size_t first = 0;
  };

  void write_mesh(const PlacedMesh& placed);
  void write_positions(const TriMesh& mesh, const PlacedMesh& placed);
  void write_normals(const AttributeLayer& layer, const PlacedMesh& placed);
  const std::vector<UvTable>& uv_tables(std::size_t mesh_index);
  void write_faces(const TriMesh& mesh, const PlacedMesh& placed);
  void write_face(const TriMesh& mesh, std::size_t face, const UvTable* table, bool mirrored);
  void use_material(int material);
  void line(std::string_view key, std::initializer_list<float> numbers) {
    out_.put(key);
    for (const float x : numbers) {
      out_.put(" ");
      out_.put_number(x);
    }
    out_.put("\n");
  }

  const Model& model_;
  const std::string& stem_;
  ByteWriter out_;
  std::map<int, std::string> name_of_material_;
  int material_ = -2;                                  // the one in force
  std::size_t positions_ = 0, uvs_ = 0, normals_ = 0;  // lines written so far
  std::size_t first_position_ = 0, first_normal_ = 0;  // of the present mesh
  std::map<std::size_t, std::vector<UvTable>> tables_of_mesh_;
};

std::vector<OutputFile> ObjWriter::run() {
  const std::vector<PlacedMesh> shown = placed_meshes(model_);
  const std::vector<int> materials = used_materials(model_, shown);
  const std::vector<std::string> names = material_names(model_, materials);
  for (std::size_t i = 0; i < materials.size(); ++i) name_of_material_[materials[i]] = names[i];

  std::vector<OutputFile> files(1);
  if (!materials.empty()) {
    files.push_back({stem_ + ".mtl", write_mtl(model_, materials, names, stem_, files)});
    out_.put("mtllib " + stem_ + ".mtl\n");
  }
  for (const PlacedMesh& placed : shown) write_mesh(placed);
  files[0].bytes = std::move(out_.bytes);
  return files;
}

void ObjWriter::write_mesh(const PlacedMesh& placed) {
  const Mesh& mesh = model_.meshes[placed.mesh];
  std::string name = mesh.name.empty() ? fmt::format("mesh_{}", placed.mesh) : mesh.name;
  std::replace_if(
      name.begin(), name.end(), [](char c) { return static_cast<unsigned char>(c) <= ' ' || c == '\\'; },
      '_');
  out_.put("o " + name + "\n");
  write_positions(mesh.surface, placed);
  uv_tables(placed.mesh);
  if (const AttributeLayer* normals = mesh.surface.find(Semantic::normal)) write_normals(*normals, placed);
  write_faces(mesh.surface, placed);
}

void ObjWriter::write_positions(const TriMesh& mesh, const PlacedMesh& placed) {
  first_position_ = positions_;
  const AttributeLayer* colors = mesh.find(Semantic::color);
  const auto color = colors ? value_of_vertex(mesh, *colors) : std::vector<const float*>();
  for (std::size_t v = 0; v < mesh.vertex_count(); ++v) {
    const Vec3f p = placed.position(mesh.positions[v]);
    if (colors) {
      static constexpr float kWhite[3] = {1, 1, 1};
      const float* c = color[v] ? color[v] : kWhite;
      line("v", {p.x, p.y, p.z, linear_to_srgb(c[0]), linear_to_srgb(c[1]), linear_to_srgb(c[2])});
    } else {
      line("v", {p.x, p.y, p.z});
    }
  }
  positions_ += mesh.vertex_count();
}

/// Instances of a mesh share its texture coordinates.
const std::vector<ObjWriter::UvTable>& ObjWriter::uv_tables(std::size_t mesh_index) {
  const auto [known, is_new] = tables_of_mesh_.try_emplace(mesh_index);
  std::vector<UvTable>& tables = known->second;
  if (!is_new) return tables;
  const TriMesh& mesh = model_.meshes[mesh_index].surface;
  for (const Part& part : mesh.parts) {
    const UvSource source = uv_source(model_, part.material);
    const AttributeLayer* layer = mesh.find(Semantic::uv, source.set);
    const auto same = [&](const UvTable& t) { return t.source == source; };
    if (!layer || part.raw || std::any_of(tables.begin(), tables.end(), same)) continue;
    tables.push_back({source, uvs_});
    for (std::size_t i = 0; i < layer->size(); ++i) {
      const Vec2f uv = source.apply(layer->value(ValueId{i}));
      line("vt", {uv.x, uv.y});
    }
    uvs_ += layer->size();
  }
  return tables;
}

void ObjWriter::write_normals(const AttributeLayer& layer, const PlacedMesh& placed) {
  first_normal_ = normals_;
  for (std::size_t i = 0; i < layer.size(); ++i) {
    const float* n = layer.value(ValueId{i});
    const Vec3f turned = placed.normal({n[0], n[1], n[2]});
    line("vn", {turned.x, turned.y, turned.z});
  }
  normals_ += layer.size();
}

void ObjWriter::write_faces(const TriMesh& mesh, const PlacedMesh& placed) {
  const std::vector<UvTable>& tables = uv_tables(placed.mesh);
  std::vector<std::vector<std::size_t>> faces(mesh.parts.size());
  for (std::size_t f = 0; f < mesh.face_count(); ++f) faces[mesh.face_part[f]].push_back(f);
  for (std::size_t p = 0; p < mesh.parts.size(); ++p) {
    if (faces[p].empty()) continue;
    use_material(mesh.parts[p].material);
    const UvSource source = uv_source(model_, mesh.parts[p].material);
    const auto table =
        std::find_if(tables.begin(), tables.end(), [&](const UvTable& t) { return t.source == source; });
    for (const std::size_t f : faces[p]) {
      write_face(mesh, f, table == tables.end() ? nullptr : &*table, placed.mirrored);
    }
  }
}

void ObjWriter::write_face(const TriMesh& mesh, std::size_t face, const UvTable* table, bool mirrored) {
  const AttributeLayer* uvs = table ? mesh.find(Semantic::uv, table->source.set) : nullptr;
  const AttributeLayer* normals = mesh.find(Semantic::normal);
  out_.put("f");
  for (const std::size_t k :
       {std::size_t{0}, std::size_t{mirrored ? 2u : 1u}, std::size_t{mirrored ? 1u : 2u}}) {
    const std::size_t c = 3 * face + k;
    out_.put(" ");
    out_.put_number(first_position_ + mesh.vertex(CornerId{c}).index() + 1);
    const bool has_uv = uvs && uvs->corner_value[c].valid();
    const bool has_normal = normals && normals->corner_value[c].valid();
    if (has_uv || has_normal) out_.put("/");
    if (has_uv) out_.put_number(table->first + uvs->corner_value[c].index() + 1);
    if (!has_normal) continue;
    out_.put("/");
    out_.put_number(first_normal_ + normals->corner_value[c].index() + 1);
  }
  out_.put("\n");
}

/// Faces without a material among others need one by name: it cannot be switched off again.
void ObjWriter::use_material(int material) {
  if (material == material_ || (material < 0 && material_ == -2)) return;
  material_ = material;
  const auto name = name_of_material_.find(material);
  out_.put("usemtl " + (name == name_of_material_.end() ? std::string("(none)") : name->second) + "\n");
}

std::vector<std::string> further_losses(const Model& model) {
  std::vector<std::string> lost;
  bool attributes = false, maps = false, colors = false;
  for (const Mesh& mesh : model.meshes) {
    for (const AttributeLayer& layer : mesh.surface.layers) {
      attributes = attributes || layer.semantic == Semantic::custom ||
                   (layer.semantic == Semantic::color && layer.set > 0);
      colors = colors || (layer.semantic == Semantic::color && layer.width == 4);
    }
  }
  for (const Material& m : model.materials) maps = maps || m.metallic_roughness || m.occlusion;
  if (attributes) lost.emplace_back("custom attributes and further colours");
  if (colors) lost.emplace_back("the opacity of vertex colours");
  if (maps) lost.emplace_back("metal, roughness and occlusion maps");
  return lost;
}

}  // namespace

std::vector<OutputFile> write_obj(const Model& model, const std::string& stem, Context& context) {
  report_losses(model, "OBJ", further_losses(model), context);
  return ObjWriter(model, stem).run();
}

}  // namespace fovea
