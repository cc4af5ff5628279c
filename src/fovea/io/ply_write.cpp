#include "fovea/io/ply_write.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <map>
#include <set>

#include "fovea/base/error.h"
#include "fovea/base/srgb.h"
#include "fovea/io/flatten.h"
#include "fovea/model/texture_use.h"
#include "fovea/model/weld.h"

namespace fovea {

namespace {

/// What every vertex of the file has.
struct Columns {
  bool normals = false, uvs = false;
  int color_width = 0;              // 0, 3 or 4
  std::vector<std::string> custom;  // names of layers, with the underscore
};

const VertexArray* find(const SplitPart& part, Semantic semantic, int set, const std::string& name = {}) {
  for (const VertexArray& a : part.attributes) {
    if (a.semantic == semantic && a.set == set && a.name == name) return &a;
  }
  return nullptr;
}

/// Names that a header cannot hold, or that mean something else in it, stay out.
bool is_plain_name(const std::string& name) {
  static const std::set<std::string> kTaken = {"x", "y", "z",   "nx",    "ny",   "nz",
                                               "s", "t", "red", "green", "blue", "alpha"};
  const std::string bare = name.starts_with('_') ? name.substr(1) : name;
  return !bare.empty() && !kTaken.contains(bare) &&
         std::all_of(bare.begin(), bare.end(), [](unsigned char c) { return std::isgraph(c); });
}

Columns columns_of(const Model& model, const std::vector<PlacedMesh>& shown) {
  Columns columns;
  std::set<std::string> custom;
  for (const PlacedMesh& placed : shown) {
    for (const AttributeLayer& layer : model.meshes[placed.mesh].surface.layers) {
      columns.normals = columns.normals || layer.semantic == Semantic::normal;
      columns.uvs = columns.uvs || layer.semantic == Semantic::uv;
      if (layer.semantic == Semantic::color && layer.set == 0) {
        columns.color_width = std::max(columns.color_width, layer.width);
      }
      if (layer.semantic == Semantic::custom && layer.width == 1 && is_plain_name(layer.name))
        custom.insert(layer.name);
    }
  }
  columns.custom.assign(custom.begin(), custom.end());
  return columns;
}

std::uint8_t to_byte(float x) {
  return static_cast<std::uint8_t>(std::lround(255 * std::clamp(x, 0.0f, 1.0f)));
}

class PlyWriter {
 public:
  explicit PlyWriter(const Model& model)
      : model_(model), shown_(placed_meshes(model)), columns_(columns_of(model, shown_)) {}

  std::vector<OutputFile> run(const std::string& stem) {
    std::vector<OutputFile> files(1);
    add_vertices_and_faces();
    write_header(texture_name(stem, files));
    ByteWriter& out = header_;
    for (const ByteWriter* body : {&vertices_, &faces_}) {
      out.bytes.insert(out.bytes.end(), body->bytes.begin(), body->bytes.end());
    }
    files[0].bytes = std::move(out.bytes);
    return files;
  }
  const std::vector<int>& images() const { return images_; }
  const Columns& columns() const { return columns_; }

 private:
  void add_vertices_and_faces() {
    std::map<std::size_t, std::vector<SplitPart>> parts_of_mesh;
    for (const PlacedMesh& placed : shown_) {
      const auto [known, is_new] = parts_of_mesh.try_emplace(placed.mesh);
      if (is_new) known->second = split(model_.meshes[placed.mesh].surface);
      for (const SplitPart& part : known->second) add_part(part, placed);
    }
    if (vertex_count_ > 0xFFFFFFFEu)
      throw Error(ErrorKind::unsupported, "PLY indices have 32 bits: too many vertices");
  }

  void add_part(const SplitPart& part, const PlacedMesh& placed) {
    for (std::size_t v = 0; v < part.positions.size(); ++v) add_vertex(part, placed, v);
    for (std::size_t i = 0; i + 2 < part.indices.size(); i += 3) {
      faces_.put_little_endian(std::uint8_t{3});
      const std::size_t second = placed.mirrored ? 2 : 1;
      for (const std::size_t k : {std::size_t{0}, second, 3 - second}) {
        faces_.put_little_endian(static_cast<std::uint32_t>(vertex_count_ + part.indices[i + k]));
      }
      ++face_count_;
    }
    vertex_count_ += part.positions.size();
  }

  void put(std::initializer_list<float> numbers) {
    for (const float x : numbers) vertices_.put_little_endian(x);
  }

  void add_vertex(const SplitPart& part, const PlacedMesh& placed, std::size_t v) {
    const Vec3f p = placed.position(part.positions[v]);
    put({p.x, p.y, p.z});
    const auto at = [&](const VertexArray* a) {
      return a->values.data() + v * static_cast<std::size_t>(a->width);
    };
    if (columns_.normals) {
      const VertexArray* a = find(part, Semantic::normal, 0);
      const Vec3f n = a ? placed.normal({at(a)[0], at(a)[1], at(a)[2]}) : Vec3f{0, 0, 1};
      put({n.x, n.y, n.z});
    }
    if (columns_.uvs) {
      const UvSource source = uv_source(model_, part.part.material);
      const VertexArray* a = find(part, Semantic::uv, source.set);
      const Vec2f uv = a ? source.apply(at(a)) : Vec2f{0, 0};
      put({uv.x, uv.y});
    }
    if (columns_.color_width > 0) add_color(find(part, Semantic::color, 0), v);
    for (const std::string& name : columns_.custom) {
      const VertexArray* a = find(part, Semantic::custom, 0, name);
      put({a ? at(a)[0] : 0.0f});
    }
  }

  void add_color(const VertexArray* a, std::size_t v) {
    for (int k = 0; k < columns_.color_width; ++k) {
      const bool given = a && k < a->width;
      const float x =
          given ? a->values[v * static_cast<std::size_t>(a->width) + static_cast<std::size_t>(k)] : 1.0f;
      vertices_.put_little_endian(to_byte(k < 3 ? linear_to_srgb(x) : x));
    }
  }

  /// Empty unless the model shows exactly one base colour image.
  std::string texture_name(const std::string& stem, std::vector<OutputFile>& files) {
    std::set<int> images;
    for (const int m : used_materials(model_, shown_)) {
      images.insert(image_of(model_, model_.materials[static_cast<std::size_t>(m)].base_color));
    }
    images.erase(-1);
    images_.assign(images.begin(), images.end());
    return images_.size() == 1 ? add_image_files(model_, images_, stem, files)[0] : "";
  }

  void write_header(const std::string& texture) {
    ByteWriter& out = header_;
    out.put("ply\nformat binary_little_endian 1.0\n");
    if (!texture.empty()) out.put("comment TextureFile " + texture + "\n");
    out.put(fmt::format("element vertex {}\n", vertex_count_));
    const auto properties = [&](const char* type, std::initializer_list<const char*> names) {
      for (const char* name : names) out.put(fmt::format("property {} {}\n", type, name));
    };
    properties("float", {"x", "y", "z"});
    if (columns_.normals) properties("float", {"nx", "ny", "nz"});
    if (columns_.uvs) properties("float", {"s", "t"});
    if (columns_.color_width > 0) properties("uchar", {"red", "green", "blue"});
    if (columns_.color_width == 4) properties("uchar", {"alpha"});
    for (const std::string& name : columns_.custom) {
      out.put("property float " + (name.starts_with('_') ? name.substr(1) : name) + "\n");
    }
    out.put(
        fmt::format("element face {}\nproperty list uchar uint vertex_indices\nend_header\n", face_count_));
  }

  const Model& model_;
  std::vector<PlacedMesh> shown_;
  Columns columns_;
  std::vector<int> images_;
  std::size_t vertex_count_ = 0, face_count_ = 0;
  ByteWriter header_, vertices_, faces_;
};

std::vector<std::string> further_losses(const Model& model, const PlyWriter& writer) {
  std::vector<std::string> lost;
  if (writer.images().size() > 1)
    lost.push_back(fmt::format("{} base colour images (it has one for all)", writer.images().size()));
  bool attributes = false, maps = false;
  for (const Mesh& mesh : model.meshes) {
    for (const AttributeLayer& layer : mesh.surface.layers) {
      attributes = attributes || (layer.semantic == Semantic::color && layer.set > 0) ||
                   (layer.semantic == Semantic::custom && (layer.width > 1 || !is_plain_name(layer.name)));
    }
  }
  for (const Material& m : model.materials)
    maps = maps || m.normal || m.metallic_roughness || m.occlusion || m.emissive;
  if (attributes) lost.emplace_back("some attributes");
  if (maps) lost.emplace_back("maps other than the base colour");
  return lost;
}

}  // namespace

std::vector<OutputFile> write_ply(const Model& model, const std::string& stem, Context& context) {
  PlyWriter writer(model);
  std::vector<OutputFile> files = writer.run(stem);
  report_losses(model, "PLY", further_losses(model, writer), context);
  return files;
}

}  // namespace fovea
