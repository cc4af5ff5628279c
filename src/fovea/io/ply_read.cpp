#include "fovea/io/ply_read.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "fovea/base/error.h"
#include "fovea/base/srgb.h"
#include "fovea/io/indexed_mesh.h"
#include "fovea/io/ply_header.h"
#include "fovea/io/ply_source.h"
#include "fovea/io/side_files.h"
#include "fovea/io/triangulate.h"
#include "fovea/model/key_table.h"

namespace fovea {

namespace {

/// Where the numbers of one vertex property go.
struct Target {
  float* at = nullptr;  // null: skipped
  std::size_t stride = 0;
  double scale = 1;
};

/// The attributes that the vertex properties make, and which property goes where.
class VertexTable {
 public:
  VertexTable(const PlyElement& element, IndexedMesh& mesh, const std::string& place)
      : element_(element), mesh_(mesh), targets_(element.properties.size()) {
    const auto count = static_cast<std::size_t>(element.count);
    mesh.positions.resize(count);
    if (!has({"x", "y", "z"}))
      throw Error(ErrorKind::format, "the vertices have no x, y, z", place + ": header");
    if (count > 0) bind({"x", "y", "z"}, &mesh.positions[0].x, 3);
    add_attributes();
    add_custom_attributes();
    for (std::size_t a = 0; a < mesh.attributes.size(); ++a) {
      VertexArray& array = mesh.attributes[a];
      array.values.resize(count * static_cast<std::size_t>(array.width));
      if (count > 0) bind(names_[a], array.values.data(), array.width);
    }
  }
  std::vector<Target>& targets() { return targets_; }

 private:
  using Names = std::vector<std::string_view>;

  bool has(const Names& names) const {
    return std::all_of(names.begin(), names.end(), [&](std::string_view n) {
      const int i = element_.find(n);
      return i >= 0 && !element_.properties[static_cast<std::size_t>(i)].is_list;
    });
  }

  void bind(const Names& names, float* first, int width) {
    const bool color = names.size() >= 3 && names[0] != "x" && names[0] != "nx";
    for (std::size_t k = 0; k < names.size(); ++k) {
      const auto i = static_cast<std::size_t>(element_.find(names[k]));
      targets_[i] = {first + k, static_cast<std::size_t>(width),
                     color ? 1 / largest(element_.properties[i].type) : 1.0};
    }
  }

  void add(Semantic semantic, Names names) {
    VertexArray& array = mesh_.attributes.emplace_back();
    array.semantic = semantic;
    array.width = static_cast<int>(names.size());
    names_.push_back(std::move(names));
  }

  /// Adds the first of the alternatives that the file has.
  void add_first(Semantic semantic, std::initializer_list<Names> alternatives) {
    for (const Names& names : alternatives) {
      if (has(names)) return add(semantic, names);
    }
  }

  void add_attributes() {
    add_first(Semantic::normal, {{"nx", "ny", "nz"}});
    add_first(Semantic::uv, {{"s", "t"}, {"u", "v"}, {"texture_u", "texture_v"}, {"texture_s", "texture_t"}});
    add_first(Semantic::color, {{"red", "green", "blue", "alpha"},
                                {"red", "green", "blue"},
                                {"r", "g", "b", "a"},
                                {"r", "g", "b"},
                                {"diffuse_red", "diffuse_green", "diffuse_blue"}});
  }

  void add_custom_attributes() {
    static const Names kGeometry = {"x", "y", "z"};
    const auto is_taken = [&](const PlyProperty& p) {
      const auto holds = [&](const Names& n) { return std::find(n.begin(), n.end(), p.name) != n.end(); };
      return p.is_list || holds(kGeometry) || std::any_of(names_.begin(), names_.end(), holds);
    };
    for (const PlyProperty& p : element_.properties) {
      if (is_taken(p)) continue;
      add(Semantic::custom, {p.name});
      mesh_.attributes.back().name = p.name.starts_with('_') ? p.name : "_" + p.name;
    }
  }

  const PlyElement& element_;
  IndexedMesh& mesh_;
  std::vector<Names> names_;  // [#attributes], views into element_ or constants
  std::vector<Target> targets_;
};

/// Turns numbers of the file into what layers hold: light, top-left origin, nothing infinite.
void finish_attributes(IndexedMesh& mesh, Context& context, const std::string& place) {
  for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
    const Vec3f p = mesh.positions[v];
    if (!std::isfinite(p.x) || !std::isfinite(p.y) || !std::isfinite(p.z)) {
      throw Error(ErrorKind::format, fmt::format("vertex {} has a position that is not finite", v), place);
    }
  }
  for (VertexArray& a : mesh.attributes) {
    if (a.semantic == Semantic::normal) continue;  // those are repaired when welded
    std::uint64_t bad = 0;
    for (float& x : a.values) {
      if (std::isfinite(x)) continue;
      x = 0;
      ++bad;
    }
    if (bad > 0)
      context.report("non-finite-attributes", "attributes that are not finite became 0", place, bad);
    const auto width = static_cast<std::size_t>(a.width);
    for (std::size_t i = 0; i < a.values.size(); ++i) {
      if (a.semantic == Semantic::uv && i % 2 == 1) a.values[i] = 1.0f - a.values[i];
      if (a.semantic == Semantic::color && i % width < 3) a.values[i] = srgb_to_linear(a.values[i]);
    }
  }
}

/// Reads the rows of all elements. `Source` is one of ply_source.h.
template <class Source>
class BodyReader {
 public:
  BodyReader(Source source, const PlyHeader& header, const ReadOptions& options, const std::string& place,
             Context& context)
      : source_(std::move(source)),
        header_(header),
        options_(options),
        place_(place),
        context_(context),
        uv_table_(2, 0) {}

  IndexedMesh run() {
    bool has_vertices = false;
    for (const PlyElement& element : header_.elements) {
      check_element_count(element.count, "rows", options_, place_);
      if (element.name == "vertex" && !has_vertices) {
        read_vertices(element);
        has_vertices = true;
      } else if (element.name == "face") {
        if (!has_vertices) source_.refuse("faces before the vertices are not supported");
        read_faces(element);
      } else if (element.name == "tristrips") {
        if (!has_vertices) source_.refuse("strips before the vertices are not supported");
        read_strips(element);
      } else {
        for (std::uint64_t r = 0; r < element.count && !element.properties.empty(); ++r) skip_row(element);
      }
    }
    return std::move(mesh_);
  }

 private:
  void read_vertices(const PlyElement& element);
  void read_faces(const PlyElement& element);
  void read_strips(const PlyElement& element);
  std::uint64_t read_list_size(const PlyProperty& property);
  void read_indices(const PlyProperty& property);
  void read_uvs(const PlyProperty& property);
  void skip(const PlyProperty& property);
  void skip_row(const PlyElement& element) {
    for (const PlyProperty& p : element.properties) skip(p);
  }
  void add_face(std::int64_t texture);
  void add_strip();
  std::uint32_t vertex(std::int64_t index) const;
  IndexedMesh::Group& group(std::int64_t texture, bool has_uvs);

  Source source_;
  const PlyHeader& header_;
  const ReadOptions& options_;
  const std::string& place_;
  Context& context_;
  IndexedMesh mesh_;
  Triangulator triangulator_;
  KeyTable uv_table_;
  std::map<std::pair<int, bool>, std::size_t> groups_;
  std::vector<std::int64_t> indices_;  // of the present row
  std::vector<float> uvs_;             // of the present row
  std::vector<Vec3f> polygon_;
  std::vector<std::uint32_t> corner_uv_;
};

template <class Source>
void BodyReader<Source>::read_vertices(const PlyElement& element) {
  VertexTable table(element, mesh_, place_);
  std::vector<Target>& targets = table.targets();
  const auto& properties = element.properties;
  for (std::uint64_t r = 0; r < element.count; ++r) {
    for (std::size_t i = 0; i < properties.size(); ++i) {
      Target& target = targets[i];
      if (target.at) {
        *target.at = static_cast<float>(source_.number(properties[i].type) * target.scale);
        target.at += target.stride;
      } else {
        skip(properties[i]);
      }
    }
    if (r % 1'000'000 == 999'999) {
      context_.advance_or_throw("read", 0.5 * static_cast<double>(r) / static_cast<double>(element.count));
    }
  }
  finish_attributes(mesh_, context_, place_);
}

template <class Source>
void BodyReader<Source>::read_faces(const PlyElement& element) {
  int list = element.find("vertex_indices");
  if (list < 0) list = element.find("vertex_index");
  if (list < 0 || !element.properties[static_cast<std::size_t>(list)].is_list) {
    throw Error(ErrorKind::format, "the faces have no list vertex_indices", place_ + ": header");
  }
  const int uvs = element.find("texcoord"), texture = element.find("texnumber");
  for (std::uint64_t r = 0; r < element.count; ++r) {
    uvs_.clear();
    std::int64_t texture_number = 0;
    for (int i = 0; i < static_cast<int>(element.properties.size()); ++i) {
      const PlyProperty& p = element.properties[static_cast<std::size_t>(i)];
      if (i == list) {
        read_indices(p);
      } else if (i == uvs && p.is_list) {
        read_uvs(p);
      } else if (i == texture && !p.is_list) {
        texture_number = source_.integer(p.type);
      } else {
        skip(p);
      }
    }
    add_face(texture_number);
    if (r % 1'000'000 == 999'999) {
      context_.advance_or_throw("read",
                                0.5 + 0.5 * static_cast<double>(r) / static_cast<double>(element.count));
    }
  }
}

template <class Source>
void BodyReader<Source>::read_strips(const PlyElement& element) {
  for (std::uint64_t r = 0; r < element.count; ++r) {
    for (const PlyProperty& p : element.properties) {
      if (p.is_list && (p.name == "vertex_indices" || p.name == "vertex_index")) {
        read_indices(p);
        add_strip();
      } else {
        skip(p);
      }
    }
  }
}

template <class Source>
std::uint64_t BodyReader<Source>::read_list_size(const PlyProperty& property) {
  const std::int64_t size = source_.integer(property.count_type);
  if (size < 0 || !source_.has(static_cast<std::uint64_t>(size), property.type)) {
    source_.refuse(fmt::format("a list of {} numbers is longer than the file", size));
  }
  return static_cast<std::uint64_t>(size);
}

template <class Source>
void BodyReader<Source>::read_indices(const PlyProperty& property) {
  indices_.resize(read_list_size(property));
  for (std::int64_t& i : indices_) i = source_.integer(property.type);
}

template <class Source>
void BodyReader<Source>::read_uvs(const PlyProperty& property) {
  uvs_.resize(read_list_size(property));
  for (float& x : uvs_) {
    x = static_cast<float>(source_.number(property.type));
    if (!std::isfinite(x)) x = 0;
  }
}

template <class Source>
void BodyReader<Source>::skip(const PlyProperty& property) {
  source_.skip(property.is_list ? read_list_size(property) : 1, property.type);
}

template <class Source>
std::uint32_t BodyReader<Source>::vertex(std::int64_t index) const {
  if (index < 0 || static_cast<std::uint64_t>(index) >= mesh_.positions.size()) {
    source_.refuse(fmt::format("vertex index {} but there are {} vertices", index, mesh_.positions.size()));
  }
  return static_cast<std::uint32_t>(index);
}

template <class Source>
IndexedMesh::Group& BodyReader<Source>::group(std::int64_t texture, bool has_uvs) {
  const auto textures = static_cast<std::int64_t>(header_.texture_files.size());
  const int material =
      textures == 0 ? -1 : static_cast<int>(texture >= 0 && texture < textures ? texture : 0);
  const auto [known, is_new] = groups_.try_emplace({material, has_uvs}, mesh_.groups.size());
  if (is_new) mesh_.groups.emplace_back().material = material;
  return mesh_.groups[known->second];
}

template <class Source>
void BodyReader<Source>::add_face(std::int64_t texture) {
  if (indices_.size() < 3) {
    context_.report("small-faces", "faces with fewer than three corners were dropped", place_);
    return;
  }
  const bool has_uvs = !uvs_.empty() && uvs_.size() == 2 * indices_.size();
  IndexedMesh::Group& to = group(texture, has_uvs);
  polygon_.clear();
  for (const std::int64_t i : indices_) polygon_.push_back(mesh_.positions[vertex(i)]);
  corner_uv_.clear();
  for (std::size_t k = 0; has_uvs && k < indices_.size(); ++k) {
    const Vec2f uv{uvs_[2 * k], 1.0f - uvs_[2 * k + 1]};
    corner_uv_.push_back(uv_table_.insert(std::array{KeyTable::word(uv.x), KeyTable::word(uv.y)}));
    if (corner_uv_.back() == mesh_.uvs.size()) mesh_.uvs.push_back(uv);
  }
  for (const auto& triangle : triangulator_.run(polygon_)) {
    for (const std::uint32_t k : triangle) {
      to.positions.push_back(static_cast<std::uint32_t>(indices_[k]));
      if (has_uvs) to.uvs.push_back(corner_uv_[k]);
    }
  }
}

/// -1 ends one strip and begins the next.
template <class Source>
void BodyReader<Source>::add_strip() {
  IndexedMesh::Group& to = group(0, false);
  std::size_t begin = 0;
  for (std::size_t i = 0; i < indices_.size(); ++i) {
    if (indices_[i] == -1) {
      begin = i + 1;
    } else if (vertex(indices_[i]); i >= begin + 2) {
      const bool flip = (i - begin) % 2 == 1;
      for (const std::size_t k : {i - 2, flip ? i : i - 1, flip ? i - 1 : i}) {
        to.positions.push_back(static_cast<std::uint32_t>(indices_[k]));
      }
    }
  }
}

template <class Source>
IndexedMesh read_body(Source source, const PlyHeader& header, const ReadOptions& options,
                      const std::string& place, Context& context) {
  return BodyReader<Source>(std::move(source), header, options, place, context).run();
}

IndexedMesh read_body(std::span<const std::byte> bytes, const PlyHeader& header, const ReadOptions& options,
                      const std::string& place, Context& context) {
  switch (header.encoding) {
    case PlyEncoding::ascii:
      return read_body(PlyTextSource(bytes, header, place), header, options, place, context);
    case PlyEncoding::little:
      return read_body(PlyBinarySource<false>(bytes, header, place), header, options, place, context);
    case PlyEncoding::big:
      return read_body(PlyBinarySource<true>(bytes, header, place), header, options, place, context);
  }
  return {};
}

/// Wedge coordinates win over those of the vertices: they are what a face's texture was made for.
void drop_vertex_uvs(IndexedMesh& mesh) {
  if (mesh.uvs.empty()) return;
  std::erase_if(mesh.attributes, [](const VertexArray& a) { return a.semantic == Semantic::uv; });
}

void add_materials(Model& model, const PlyHeader& header, const std::filesystem::path& folder,
                   const ReadOptions& options, const std::string& place, Context& context) {
  TextureLoader textures(model, folder, options, context);
  for (const std::string& file : header.texture_files) {
    Material& material = model.materials.emplace_back();
    material.name = std::filesystem::path(file).stem().string();
    material.metallic_factor = 0;
    if (const auto texture = textures.texture(file, {}, place)) {
      material.base_color.emplace();
      material.base_color->texture = *texture;
    }
  }
}

}  // namespace

Model read_ply(std::span<const std::byte> bytes, const std::filesystem::path& folder,
               const std::string& place, const ReadOptions& options, Context& context) {
  const PlyHeader header = read_ply_header(bytes, place);
  IndexedMesh mesh = read_body(bytes, header, options, place, context);
  drop_vertex_uvs(mesh);
  Model model =
      model_of(weld(std::move(mesh), options, context, place), std::filesystem::path(place).stem().string());
  add_materials(model, header, folder, options, place, context);
  drop_textures_without_uvs(model);
  return model;
}

}  // namespace fovea
