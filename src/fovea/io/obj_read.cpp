#include "fovea/io/obj_read.h"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <map>

#include "fovea/base/error.h"
#include "fovea/base/srgb.h"
#include "fovea/io/indexed_mesh.h"
#include "fovea/io/mtl_read.h"
#include "fovea/io/text_scan.h"
#include "fovea/io/triangulate.h"

namespace fovea {

namespace {

/// What the statements of the file say, before faces are cut.
struct ObjFile {
  std::vector<Vec3f> positions;
  std::vector<Vec3f> colors;  // as many as positions if any has one
  std::vector<Vec2f> uvs;
  std::vector<Vec3f> normals;
  std::vector<std::array<std::uint32_t, 3>> corners;  // position, uv, normal; kInvalid if absent
  std::vector<std::size_t> face_begin;                // into corners
  std::vector<std::int32_t> face_material;            // into material_names; -1 before any usemtl
  std::vector<std::string> material_names;
  std::vector<std::string> libraries;
};

class ObjParser {
 public:
  ObjParser(std::span<const std::byte> bytes, const std::string& place, const ReadOptions& options,
            Context& context)
      : scan_(bytes, true), place_(place), options_(options), context_(context), size_(bytes.size()) {}

  ObjFile run();

 private:
  void read_statement();
  void read_vertex_statement(std::string_view word);
  void read_position();
  void read_uv();
  void read_normal();
  void read_face();
  bool read_index(std::uint32_t& index, int table);
  void use_material(const std::string& name);
  void drop(std::string_view word);
  void check_forward_indices() const;
  std::size_t table_size(int table) const;
  void refuse(const std::string& message) const { refuse_at(message, scan_.line()); }
  [[noreturn]] void refuse_at(const std::string& message, std::size_t line) const {
    throw Error(ErrorKind::format, message, fmt::format("{}: line {}", place_, line));
  }

  TextScanner scan_;
  const std::string& place_;
  const ReadOptions& options_;
  Context& context_;
  std::size_t size_;
  ObjFile file_;
  std::map<std::string, std::int32_t, std::less<>> material_of_name_;
  std::int32_t material_ = -1;
  std::uint64_t bad_uvs_ = 0;
  // Per table the largest index that was not yet defined where it was used, and the line.
  std::array<std::uint64_t, 3> forward_{};
  std::array<std::size_t, 3> forward_line_{};
};

constexpr std::array<const char*, 3> kTableNames = {"vertex", "texture coordinate", "normal"};

ObjFile ObjParser::run() {
  std::uint64_t statements = 0;
  for (; !scan_.at_end(); scan_.next_line()) {
    if (!scan_.line_done()) read_statement();
    if (++statements % 1'000'000 == 0) {
      context_.advance_or_throw("read", static_cast<double>(scan_.offset()) / static_cast<double>(size_));
    }
  }
  check_forward_indices();
  file_.face_begin.push_back(file_.corners.size());
  if (bad_uvs_ > 0) {
    context_.report("bad-texture-coordinates", "texture coordinates that are not finite became 0", place_,
                    bad_uvs_);
  }
  return std::move(file_);
}

void ObjParser::read_statement() {
  const std::string_view word = scan_.word();
  if (word == "v") {
    read_position();
  } else if (word == "vt") {
    read_uv();
  } else if (word == "vn") {
    read_normal();
  } else if (word == "f" || word == "fo") {
    read_face();
  } else if (word == "usemtl") {
    use_material(std::string(scan_.rest()));
  } else if (word == "mtllib") {
    file_.libraries.emplace_back(scan_.rest());
  } else if (word != "o" && word != "g" && word != "s" && word != "vp") {
    drop(word);
  }
}

void ObjParser::read_position() {
  float number[7];
  int count = 0;
  while (count < 7 && !scan_.line_done()) {
    if (!scan_.number(number[count])) refuse("a vertex has something that is no number");
    if (!std::isfinite(number[count])) refuse("a vertex has a number that is not finite");
    ++count;
  }
  if (count < 3) refuse("a vertex needs three numbers");
  file_.positions.emplace_back(number[0], number[1], number[2]);
  check_element_count(file_.positions.size(), "vertices", options_, place_);
  // Four numbers: the fourth is a weight of rational surfaces, which says nothing about triangles.
  if (count >= 6) {
    file_.colors.resize(file_.positions.size() - 1, Vec3f{1, 1, 1});
    file_.colors.emplace_back(srgb_to_linear(number[3]), srgb_to_linear(number[4]),
                              srgb_to_linear(number[5]));
  }
}

void ObjParser::read_uv() {
  float u = 0, v = 0;
  if (!scan_.number(u)) refuse("a texture coordinate needs a number");
  if (!scan_.line_done() && !scan_.number(v)) refuse("a texture coordinate has something that is no number");
  const bool good = std::isfinite(u) && std::isfinite(v);
  bad_uvs_ += !good;
  file_.uvs.push_back(good ? Vec2f{u, 1.0f - v} : Vec2f{0, 0});
}

void ObjParser::read_normal() {
  Vec3f n;
  if (!scan_.number(n.x) || !scan_.number(n.y) || !scan_.number(n.z)) refuse("a normal needs three numbers");
  file_.normals.push_back(n);
}

void ObjParser::read_face() {
  const std::size_t begin = file_.corners.size();
  while (!scan_.line_done()) {
    std::array<std::uint32_t, 3> corner{kInvalid, kInvalid, kInvalid};
    if (!read_index(corner[0], 0)) refuse("a face has something that is no index");
    if (scan_.skip('/')) {
      read_index(corner[1], 1);
      if (scan_.skip('/')) read_index(corner[2], 2);
    }
    if (!scan_.at_word_end()) refuse("a face has something that is no index");
    file_.corners.push_back(corner);
    check_element_count(file_.corners.size(), "face corners", options_, place_);
  }
  if (file_.corners.size() - begin < 3) {
    context_.report("small-faces", "faces with fewer than three corners were dropped",
                    fmt::format("{}: line {}", place_, scan_.line()));
    file_.corners.resize(begin);
    return;
  }
  file_.face_begin.push_back(begin);
  file_.face_material.push_back(material_);
}

/// Reads one of "v/vt/vn": from 1, or negative and counted from the present end of the table.
bool ObjParser::read_index(std::uint32_t& index, int table) {
  if (scan_.at_word_end()) return false;
  std::int64_t number = 0;
  if (!scan_.number(number)) return false;
  const auto t = static_cast<std::size_t>(table);
  const auto size = static_cast<std::int64_t>(table_size(table));
  if (number == 0) refuse(fmt::format("{} index 0: indices count from 1", kTableNames[t]));
  if (number < -size) {
    refuse(fmt::format("{} index {} but only {} precede it", kTableNames[t], number, size));
  }
  if (number >= kInvalid) refuse(fmt::format("{} index {} is out of range", kTableNames[t], number));
  const auto from_one = static_cast<std::uint64_t>(number > 0 ? number : size + number + 1);
  if (from_one > static_cast<std::uint64_t>(size) && from_one > forward_[t]) {
    forward_[t] = from_one;
    forward_line_[t] = scan_.line();
  }
  index = static_cast<std::uint32_t>(from_one - 1);
  return true;
}

std::size_t ObjParser::table_size(int table) const {
  return table == 0 ? file_.positions.size() : table == 1 ? file_.uvs.size() : file_.normals.size();
}

void ObjParser::check_forward_indices() const {
  for (std::size_t t = 0; t < 3; ++t) {
    const std::size_t size = table_size(static_cast<int>(t));
    if (forward_[t] > size) {
      refuse_at(fmt::format("{} index {} but there are {}", kTableNames[t], forward_[t], size),
                forward_line_[t]);
    }
  }
}

void ObjParser::use_material(const std::string& name) {
  const auto next = static_cast<std::int32_t>(file_.material_names.size());
  const auto [known, is_new] = material_of_name_.try_emplace(name, next);
  if (is_new) file_.material_names.push_back(name);
  material_ = known->second;
}

void ObjParser::drop(std::string_view word) {
  const std::string here = fmt::format("{}: line {}", place_, scan_.line());
  if (word == "l" || word == "p") {
    context_.report("dropped-lines-points", "lines and points were dropped", here);
  } else {
    context_.report(
        "unknown-statement",
        fmt::format("statements that are not known were ignored, first \"{}\"", word.substr(0, 32)), here);
  }
}

/// Cuts the faces and sorts them into groups of equal material and make.
class ObjGroups {
 public:
  ObjGroups(ObjFile& file, IndexedMesh& mesh) : file_(file), mesh_(mesh) {}

  void run() {
    for (std::size_t f = 0; f + 1 < file_.face_begin.size(); ++f) {
      add_face({file_.corners.data() + file_.face_begin[f], file_.face_begin[f + 1] - file_.face_begin[f]},
               file_.face_material[f]);
    }
  }

 private:
  using Corner = std::array<std::uint32_t, 3>;

  void add_face(std::span<const Corner> corners, std::int32_t material) {
    const auto all_have = [&](std::size_t table) {
      for (const Corner& c : corners) {
        if (c[table] == kInvalid) return false;
      }
      return true;
    };
    const bool uvs = all_have(1), normals = all_have(2);
    IndexedMesh::Group& group = mesh_.groups[group_of(material, uvs, normals)];
    polygon_.clear();
    for (const Corner& c : corners) polygon_.push_back(mesh_.positions[c[0]]);
    for (const auto& triangle : triangulator_.run(polygon_)) {
      for (const std::uint32_t k : triangle) {
        group.positions.push_back(corners[k][0]);
        if (uvs) group.uvs.push_back(corners[k][1]);
        if (normals) group.normals.push_back(corners[k][2]);
      }
    }
  }

  std::size_t group_of(std::int32_t material, bool uvs, bool normals) {
    const std::int64_t key = std::int64_t{material} * 4 + uvs * 2 + normals;
    const auto [known, is_new] = group_of_key_.try_emplace(key, mesh_.groups.size());
    if (is_new) mesh_.groups.emplace_back().material = material;
    return known->second;
  }

  ObjFile& file_;
  IndexedMesh& mesh_;
  Triangulator triangulator_;
  std::vector<Vec3f> polygon_;
  std::map<std::int64_t, std::size_t> group_of_key_;
};

IndexedMesh make_mesh(ObjFile&& file) {
  IndexedMesh mesh;
  mesh.positions = std::move(file.positions);
  mesh.uvs = std::move(file.uvs);
  mesh.normals = std::move(file.normals);
  if (!file.colors.empty()) {
    file.colors.resize(mesh.positions.size(), Vec3f{1, 1, 1});
    VertexArray& color = mesh.attributes.emplace_back();
    color.semantic = Semantic::color;
    color.width = 3;
    for (const Vec3f& c : file.colors) color.values.insert(color.values.end(), {c.x, c.y, c.z});
  }
  ObjGroups(file, mesh).run();
  return mesh;
}

/// The names that faces use, numbered anew in order of first use by a face.
std::vector<std::string> number_by_use(ObjFile& file) {
  std::vector<std::int32_t> number(file.material_names.size(), -1);
  std::vector<std::string> names;
  for (std::int32_t& m : file.face_material) {
    if (m < 0) continue;
    std::int32_t& n = number[static_cast<std::size_t>(m)];
    if (n < 0) {
      n = static_cast<std::int32_t>(names.size());
      names.push_back(file.material_names[static_cast<std::size_t>(m)]);
    }
    m = n;
  }
  return names;
}

void read_library(const std::string& library, const std::filesystem::path& folder, const std::string& place,
                  const ReadOptions& options, const std::set<std::string>& wanted, TextureLoader& textures,
                  std::map<std::string, Material>& found, Context& context) {
  const auto file = find_side_file(folder, library);
  if (!file) {
    context.report("missing-material-library", fmt::format("\"{}\" is not in the model's folder", library),
                   place);
    return;
  }
  const auto bytes = read_file(*file, options.max_file_bytes);
  for (Material& m : read_mtl(bytes, file->string(), wanted, textures, context)) {
    found.try_emplace(m.name, std::move(m));
  }
}

/// Material names with spaces inside are legal, so a line is one name unless only its words are files.
std::vector<std::string> library_names(const std::string& line, const std::filesystem::path& folder) {
  if (line.find(' ') == std::string::npos || find_side_file(folder, line)) return {line};
  std::vector<std::string> names;
  TextScanner scan({reinterpret_cast<const std::byte*>(line.data()), line.size()});
  for (std::string_view word = scan.word(); !word.empty(); word = scan.word()) names.emplace_back(word);
  return names;
}

std::vector<Material> read_materials(const ObjFile& file, const std::vector<std::string>& names,
                                     const std::filesystem::path& folder, const std::string& place,
                                     const ReadOptions& options, TextureLoader& textures, Context& context) {
  const std::set<std::string> wanted(names.begin(), names.end());
  std::map<std::string, Material> found;
  for (const std::string& line : std::set<std::string>(file.libraries.begin(), file.libraries.end())) {
    for (const std::string& name : library_names(line, folder)) {
      read_library(name, folder, place, options, wanted, textures, found, context);
    }
  }
  std::vector<Material> materials;
  for (const std::string& name : names) {
    const auto it = found.find(name);
    if (it == found.end()) {
      context.report("missing-material", fmt::format("material \"{}\" is in no library", name), place);
      materials.emplace_back().name = name;
      materials.back().metallic_factor = 0;
    } else {
      materials.push_back(it->second);
    }
  }
  return materials;
}

}  // namespace

Model read_obj(std::span<const std::byte> bytes, const std::filesystem::path& folder,
               const std::string& place, const ReadOptions& options, Context& context) {
  ObjFile file = ObjParser(bytes, place, options, context).run();
  const std::vector<std::string> names = number_by_use(file);
  Model images;
  TextureLoader textures(images, folder, options, context);
  std::vector<Material> materials = read_materials(file, names, folder, place, options, textures, context);
  TriMesh surface = weld(make_mesh(std::move(file)), options, context, place);

  Model model = model_of(std::move(surface), std::filesystem::path(place).stem().string());
  model.materials = std::move(materials);
  model.textures = std::move(images.textures);
  model.samplers = std::move(images.samplers);
  model.images = std::move(images.images);
  drop_textures_without_uvs(model);
  return model;
}

}  // namespace fovea
