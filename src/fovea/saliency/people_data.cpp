#include "fovea/saliency/people_data.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <string_view>
#include <utility>

#include "fovea/base/error.h"
#include "fovea/base/text.h"
#include "fovea/io/field_file.h"
#include "fovea/io/read.h"
#include "fovea/io/text_scan.h"
#include "fovea/surface/curvature.h"
#include "fovea/surface/scene_surface.h"

namespace fovea {

namespace fs = std::filesystem;

namespace {

constexpr std::int64_t kMaxBytes = std::int64_t{8} << 30;

// --- Which files belong together ----------------------------------------------------------------------

constexpr std::string_view kModelExtensions[] = {".obj", ".off", ".ply", ".stl", ".glb", ".gltf"};
constexpr std::string_view kMapExtensions[] = {".npy", ".txt", ".csv", ".val"};

bool has_extension(const fs::path& path, std::span<const std::string_view> extensions) {
  return std::find(extensions.begin(), extensions.end(), lower_extension(path)) != extensions.end();
}

/// The files of one name.
struct Namesakes {
  std::vector<fs::path> models, maps;
};

std::map<std::string, Namesakes> find_files(const fs::path& folder) {
  std::map<std::string, Namesakes> files;
  std::error_code error;
  fs::recursive_directory_iterator at(folder, fs::directory_options::skip_permission_denied, error);
  for (; !error && at != fs::recursive_directory_iterator(); at.increment(error)) {
    const fs::path& path = at->path();
    std::error_code ignored;
    if (!at->is_regular_file(ignored)) continue;
    Namesakes& same = files[lower_case(path.stem().string())];
    if (has_extension(path, kModelExtensions)) same.models.push_back(path);
    if (has_extension(path, kMapExtensions)) same.maps.push_back(path);
  }
  if (error) throw Error(ErrorKind::input, "the folder cannot be read: " + error.message(), folder.string());
  for (auto& [name, same] : files) {
    std::sort(same.models.begin(), same.models.end());
    std::sort(same.maps.begin(), same.maps.end());
  }
  return files;
}

[[noreturn]] void refuse_two(const fs::path& of, const char* what, const fs::path& a, const fs::path& b) {
  throw Error(ErrorKind::usage, fmt::format("two {} have its name: {} and {}", what, a.string(), b.string()),
              of.string(), "keep the other in a folder of its own");
}

/// The map beside the model, else the only one; none without maps.
const fs::path* map_of(const fs::path& model, const std::vector<fs::path>& maps) {
  std::vector<const fs::path*> beside, all;
  for (const fs::path& map : maps) {
    all.push_back(&map);
    if (map.parent_path() == model.parent_path()) beside.push_back(&map);
  }
  const auto& fitting = beside.empty() ? all : beside;
  if (fitting.size() > 1) refuse_two(model, "maps", *fitting[0], *fitting[1]);
  return fitting.empty() ? nullptr : fitting[0];
}

// --- Points -------------------------------------------------------------------------------------------

struct GazePoint {
  Vec3f position;
  float seconds = 0;
};

constexpr int kPointColumns = 8;

/// The next number of a line; numbers are parted by blanks, commas or semicolons.
bool next_number(TextScanner& scan, float& value) {
  scan.skip_blanks();
  if (scan.skip(',') || scan.skip(';')) scan.skip_blanks();
  return scan.number(value);
}

/// The numbers of a line; none unless there are as many as a point has, and nothing else.
std::optional<GazePoint> point_of(TextScanner& scan) {
  float x[kPointColumns];
  for (float& value : x) {
    if (!next_number(scan, value) || !std::isfinite(value)) return {};
  }
  if (!scan.line_done()) return {};
  return GazePoint{{x[0], x[1], x[2]}, x[6]};
}

/// The points of a text whose first line, or the first after a heading, is one.
std::optional<std::vector<GazePoint>> parse_points(std::span<const std::byte> bytes,
                                                   const std::string& place) {
  std::vector<GazePoint> points;
  std::size_t lines = 0;
  for (TextScanner scan(bytes); !scan.at_end(); scan.next_line()) {
    if (scan.line_done()) continue;
    ++lines;
    if (const auto point = point_of(scan)) {
      points.push_back(*point);
    } else if (!points.empty()) {
      throw Error(ErrorKind::format, "this is no point: x y z nx ny nz seconds binary",
                  fmt::format("{}: line {}", place, scan.line()));
    } else if (lines == 2) {
      return {};
    }
  }
  if (points.empty()) return {};
  return points;
}

/// Finds vertices by their place, in cells as wide as what may lie between.
class VertexFinder {
 public:
  VertexFinder(const Surface& surface, double tolerance) : surface_(surface), tolerance_(tolerance) {
    for (std::uint32_t v = 0; v < surface.positions.size(); ++v)
      cells_.emplace_back(cell_of(surface.position(v)), v);
    std::sort(cells_.begin(), cells_.end());
  }

  /// The nearest within the tolerance, of equally near ones the first; kInvalid if there is none.
  std::uint32_t nearest(Vec3d p) const {
    const Cell c = cell_of(p);
    std::pair<double, std::uint32_t> best{tolerance_ * tolerance_, kInvalid};
    for (double x = -1; x <= 1; ++x) {
      for (double y = -1; y <= 1; ++y) {
        for (double z = -1; z <= 1; ++z) look({c[0] + x, c[1] + y, c[2] + z}, p, best);
      }
    }
    return best.second;
  }

 private:
  using Cell = std::array<double, 3>;  // whole numbers, of any size

  Cell cell_of(Vec3d p) const {
    return {std::floor(p.x / tolerance_), std::floor(p.y / tolerance_), std::floor(p.z / tolerance_)};
  }
  void look(const Cell& cell, Vec3d p, std::pair<double, std::uint32_t>& best) const {
    const auto first = std::lower_bound(cells_.begin(), cells_.end(), std::pair(cell, std::uint32_t{0}));
    for (auto at = first; at != cells_.end() && at->first == cell; ++at)
      best = std::min(best, {length_squared(surface_.position(at->second) - p), at->second});
  }

  const Surface& surface_;
  double tolerance_;
  std::vector<std::pair<Cell, std::uint32_t>> cells_;  // sorted
};

PeopleMap map_of_points(std::span<const GazePoint> points, const Surface& surface, const std::string& place) {
  constexpr double kToleranceRel = 1e-5;
  const double tolerance = kToleranceRel * diagonal(surface);
  if (!(tolerance > 0)) throw Error(ErrorKind::unsupported, "the model has no surface", place);
  PeopleMap map;
  map.points = points.size();
  map.values.assign(surface.positions.size(), 0.0f);
  const VertexFinder finder(surface, tolerance);
  for (const GazePoint& point : points) {
    const std::uint32_t v = finder.nearest(Vec3d(point.position));
    if (v == kInvalid) {
      ++map.strays;
    } else {
      map.values[v] = std::max(map.values[v], point.seconds);
    }
  }
  if (map.strays == map.points) {
    throw Error(ErrorKind::format, fmt::format("none of {} points is at a vertex of the model", map.points),
                place);
  }
  return map;
}

// --- One value per face -------------------------------------------------------------------------------

using Triangle = std::array<VertexId, 3>;

/// The position that the next corner "v/vt/vn" of an OBJ file names, with `count` so far.
std::size_t next_position(TextScanner& scan, std::size_t count) {
  std::int64_t index = 0;
  scan.number(index);
  if (!scan.at_word_end()) scan.word();
  return index > 0 ? static_cast<std::size_t>(index) - 1 : count - static_cast<std::size_t>(-index);
}

/// The triangles of an OBJ file in its order, over the vertices of the mesh that was read from it: the file
/// is known to be sound.
std::vector<Triangle> obj_triangles(std::span<const std::byte> bytes, const std::string& place,
                                    const TriMesh& mesh) {
  std::vector<Triangle> triangles;
  std::size_t positions = 0;
  for (TextScanner scan(bytes, true); !scan.at_end(); scan.next_line()) {
    if (scan.line_done()) continue;
    const std::string_view word = scan.word();
    if (word == "v") ++positions;
    if (word != "f" && word != "fo") continue;
    const std::size_t line = scan.line();
    Triangle triangle;
    std::size_t corners = 0;
    for (; !scan.line_done(); ++corners) {
      const std::size_t position = next_position(scan, positions);
      if (corners < 3) triangle[corners] = mesh.source_vertex.at(position);
    }
    if (corners != 3) {
      throw Error(ErrorKind::unsupported,
                  fmt::format("a face with {} corners: a map of faces needs triangles", corners),
                  fmt::format("{}: line {}", place, line));
    }
    triangles.push_back(triangle);
  }
  return triangles;
}

bool is_degenerate(const Triangle& t) { return t[0] == t[1] || t[1] == t[2] || t[2] == t[0]; }

/// Numbers of the triangles that use no vertex twice, those with equal corners beside each other, else in
/// their order.
std::vector<std::size_t> by_corners(std::span<const Triangle> triangles) {
  std::vector<std::size_t> order;
  for (std::size_t f = 0; f < triangles.size(); ++f) {
    if (!is_degenerate(triangles[f])) order.push_back(f);
  }
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return triangles[a] < triangles[b]; });
  return order;
}

/// Values of an OBJ file's faces as those of the mesh, which has the same triangles but for those dropped.
std::vector<float> in_mesh_order(std::span<const float> values, std::span<const Triangle> file,
                                 std::span<const Triangle> mesh) {
  const std::vector<std::size_t> from = by_corners(file), to = by_corners(mesh);
  if (from.size() != to.size()) throw Error(ErrorKind::internal, "the faces of an OBJ file were lost");
  std::vector<float> result(mesh.size());
  for (std::size_t i = 0; i < to.size(); ++i) result[to[i]] = values[from[i]];
  return result;
}

/// Whether faces may be in another order than in the file: those of several parts, but in glTF.
bool is_sorted_by_material(const Model& model, FileFormat format) {
  if (format == FileFormat::gltf || format == FileFormat::glb) return false;
  return std::any_of(model.meshes.begin(), model.meshes.end(),
                     [](const Mesh& mesh) { return mesh.surface.parts.size() > 1; });
}

// --- One value per vertex, or per face ----------------------------------------------------------------

/// Numbers of elements that a map can be over.
struct Sizes {
  std::size_t source_vertices = 0, vertices = 0, faces = 0;

  explicit Sizes(const Model& model) {
    for (const Mesh& mesh : model.meshes) {
      const TriMesh& surface = mesh.surface;
      source_vertices +=
          surface.source_vertex.empty() ? surface.vertex_count() : surface.source_vertex.size();
      vertices += surface.vertex_count();
      faces += surface.face_count();
    }
  }
};

[[noreturn]] void refuse_size(std::size_t count, const PeopleFiles& files, const Sizes& sizes) {
  throw Error(ErrorKind::format,
              fmt::format("{} values fit neither {} vertices of the file ({} after welding) nor {} triangles",
                          count, sizes.source_vertices, sizes.vertices, sizes.faces),
              files.map.string(),
              "triangles without area are dropped on reading; which is known of OBJ files only");
}

std::vector<float> face_values(std::vector<float>&& values, const PeopleFiles& files, const Model& model,
                               Sizes sizes) {
  const std::vector<std::byte> bytes = read_file(files.model, kMaxBytes);
  const FileFormat format = detect_format(bytes, files.model);
  if (format == FileFormat::obj) {
    const TriMesh& mesh = model.meshes.at(0).surface;
    const std::vector<Triangle> triangles = obj_triangles(bytes, files.model.string(), mesh);
    sizes.faces = triangles.size();
    if (values.size() != sizes.faces) refuse_size(values.size(), files, sizes);
    return in_mesh_order(values, triangles, mesh.triangles);
  }
  if (values.size() != sizes.faces) refuse_size(values.size(), files, sizes);
  if (is_sorted_by_material(model, format)) {
    throw Error(ErrorKind::unsupported, "the faces of several materials are not in the file's order any more",
                files.model.string(), "make it an OBJ file");
  }
  return std::move(values);
}

PeopleMap map_of_values(std::vector<float>&& values, const PeopleFiles& files, const Model& model) {
  const Sizes sizes(model);
  PeopleMap map;
  if (values.size() == sizes.source_vertices || values.size() == sizes.vertices) {
    for (const VertexField& field : field_from_source_order(model, values)) {
      const std::span<const float> part = field.values();
      map.values.insert(map.values.end(), part.begin(), part.end());
    }
  } else {
    map.over = PeopleMap::Over::faces;
    map.values = face_values(std::move(values), files, model, sizes);
  }
  return map;
}

// --- Faces of a surface -------------------------------------------------------------------------------

float area_of(const Surface& surface, const std::array<std::uint32_t, 3>& t) {
  return static_cast<float>(
      triangle_area(surface.position(t[0]), surface.position(t[1]), surface.position(t[2])));
}

float mean_of(const VertexField& field, const std::array<std::uint32_t, 3>& t) {
  double sum = 0;
  for (const std::uint32_t v : t) sum += static_cast<double>(field.values()[v]);
  return static_cast<float>(sum / 3);
}

}  // namespace

std::vector<PeopleFiles> find_people_files(const fs::path& folder) {
  std::error_code error;
  if (!fs::is_directory(folder, error))
    throw Error(ErrorKind::input, "there is no such folder", folder.string());
  std::vector<PeopleFiles> found;
  for (const auto& [name, same] : find_files(folder)) {
    std::map<fs::path, fs::path> model_of;
    for (const fs::path& model : same.models) {
      const fs::path* map = map_of(model, same.maps);
      if (map == nullptr) continue;
      const auto [known, is_new] = model_of.try_emplace(*map, model);
      if (!is_new) refuse_two(*map, "models", known->second, model);
      found.push_back({model.stem().string(), model, *map});
    }
  }
  if (found.empty()) {
    throw Error(ErrorKind::input, "no model in it has a map (.npy, .txt, .csv, .val) of the same name",
                folder.string());
  }
  return found;
}

PeopleMap read_people_map(const PeopleFiles& files, const Model& model) {
  const std::string place = files.map.string();
  const auto points = parse_points(read_file(files.map, kMaxBytes), place);
  if (points) return map_of_points(*points, scene_surface(model, rest_pose(model)).surface, place);
  std::vector<float> values = read_field(files.map);
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (!std::isfinite(values[i]) || values[i] < 0)
      throw Error(ErrorKind::format, fmt::format("value {} is not a number from 0 on", i), place);
  }
  return map_of_values(std::move(values), files, model);
}

Agreement agreement(const VertexField& predicted, const PeopleMap& observed, const Surface& surface,
                    const Context& context) {
  if (observed.over == PeopleMap::Over::vertices) {
    const VertexField areas = vertex_areas(surface, Adjacency(surface, context), context);
    return agreement(predicted.values(), observed.values, areas.values());
  }
  std::vector<float> means, areas;
  for (const auto& t : surface.triangles) {
    means.push_back(mean_of(predicted, t));
    areas.push_back(area_of(surface, t));
  }
  return agreement(means, observed.values, areas);
}

}  // namespace fovea
