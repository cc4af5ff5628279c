#include "subjects.h"

#include <cmath>
#include <cstdlib>
#include <numbers>

#include "fovea/base/context.h"
#include "fovea/io/read.h"
#include "fovea/sample/sample.h"

namespace fovea::bench {
namespace {

/// A sum of sines: bumps of several sizes, so that no region collapses for nothing.
double bump(Vec3d p) {
  double height = 0;
  for (int octave = 0; octave < 6; ++octave) {
    const double frequency = 3.0 * std::exp2(octave);
    height += std::sin(frequency * p.x + octave) * std::sin(frequency * p.y + 2 * octave) *
              std::sin(frequency * p.z + 3 * octave) / frequency;
  }
  return 1.0 + 0.3 * height;
}

/// `rows` rings of `columns` points between two poles.
std::vector<Vec3f> sphere_points(std::size_t rows, std::size_t columns) {
  const auto point = [](double polar, double azimuth) {
    const Vec3d p{std::sin(polar) * std::cos(azimuth), std::cos(polar), std::sin(polar) * std::sin(azimuth)};
    return Vec3f(p * bump(p));
  };
  std::vector<Vec3f> points{point(0, 0)};
  points.reserve(rows * columns + 2);
  for (std::size_t i = 0; i < rows; ++i) {
    const double polar = std::numbers::pi * static_cast<double>(i + 1) / static_cast<double>(rows + 1);
    for (std::size_t j = 0; j < columns; ++j) {
      points.push_back(
          point(polar, 2 * std::numbers::pi * static_cast<double>(j) / static_cast<double>(columns)));
    }
  }
  points.push_back(point(std::numbers::pi, 0));
  return points;
}

std::vector<std::array<VertexId, 3>> sphere_triangles(std::size_t rows, std::size_t columns) {
  const auto ring = [&](std::size_t i, std::size_t j) { return VertexId{1 + i * columns + j % columns}; };
  const VertexId north{0}, south{1 + rows * columns};
  std::vector<std::array<VertexId, 3>> triangles;
  triangles.reserve(2 * rows * columns);
  for (std::size_t j = 0; j < columns; ++j) {
    triangles.push_back({north, ring(0, j + 1), ring(0, j)});
    triangles.push_back({south, ring(rows - 1, j), ring(rows - 1, j + 1)});
  }
  for (std::size_t i = 0; i + 1 < rows; ++i) {
    for (std::size_t j = 0; j < columns; ++j) {
      triangles.push_back({ring(i, j), ring(i, j + 1), ring(i + 1, j)});
      triangles.push_back({ring(i, j + 1), ring(i + 1, j + 1), ring(i + 1, j)});
    }
  }
  return triangles;
}

Model one_mesh_model(TriMesh surface) {
  Model model;
  model.meshes.push_back({.name = "mesh", .surface = std::move(surface), .morph_weights = {}, .json = {}});
  Node node;
  node.mesh = 0;
  model.nodes.push_back(node);
  model.scenes.push_back({.name = {}, .nodes = {0}, .json = {}});
  model.default_scene = 0;
  return model;
}

Model make_noise_sphere(std::size_t triangles) {
  const auto rows = static_cast<std::size_t>(std::sqrt(static_cast<double>(triangles) / 4));
  TriMesh mesh;
  mesh.positions = sphere_points(rows, 2 * rows);
  mesh.triangles = sphere_triangles(rows, 2 * rows);
  mesh.face_part.assign(mesh.triangles.size(), 0);
  mesh.parts.emplace_back();
  return one_mesh_model(std::move(mesh));
}

/// Area-weighted normals, one per vertex.
std::vector<float> smooth_normals(const TriMesh& mesh) {
  std::vector<Vec3d> sums(mesh.vertex_count());
  for (const auto& [a, b, c] : mesh.triangles) {
    const Vec3d p(mesh.positions[a.index()]), q(mesh.positions[b.index()]), r(mesh.positions[c.index()]);
    const Vec3d normal = cross(q - p, r - p);
    for (const VertexId v : {a, b, c}) sums[v.index()] += normal;
  }
  std::vector<float> values;
  values.reserve(3 * sums.size());
  for (const Vec3d& sum : sums) {
    const Vec3f n(normalized(sum));
    values.insert(values.end(), {n.x, n.y, n.z});
  }
  return values;
}

AttributeLayer normal_layer(const TriMesh& mesh) {
  AttributeLayer layer;
  layer.semantic = Semantic::normal;
  layer.width = 3;
  layer.values = smooth_normals(mesh);
  layer.corner_value.reserve(3 * mesh.face_count());
  for (const auto& triangle : mesh.triangles) {
    for (const VertexId v : triangle) layer.corner_value.push_back(ValueId{v.index()});
  }
  return layer;
}

Subject file_subject(const std::filesystem::path& path) {
  return {path.stem().string(), [path] {
            Context context;
            return read_model(path, {}, context);
          }};
}

Subject sample_subject(const std::string& name) {
  return {name, [name] {
            Context context;
            return make_sample(name, 1.0, context);
          }};
}

/// Files of the data folder, or Fovea's own samples without one.
std::vector<Subject> subjects(std::initializer_list<const char*> files) {
  std::vector<Subject> all;
  if (const auto folder = data_folder()) {
    for (const char* file : files) all.push_back(file_subject(*folder / file));
  } else {
    for (const SampleInfo& info : samples()) all.push_back(sample_subject(info.name));
  }
  return all;
}

}  // namespace

std::optional<std::filesystem::path> data_folder() {
  const char* folder = std::getenv("FOVEA_DATA");
  if (folder == nullptr || *folder == '\0') return std::nullopt;
  return folder;
}

std::vector<Subject> speed_subjects() {
  return subjects({"scans/bunny.ply", "scans/armadillo.ply", "scans/dragon.ply", "textured/DamagedHelmet.glb",
                   "textured/ToyCar.glb"});
}

std::vector<Subject> saliency_subjects() {
  std::vector<Subject> all = speed_subjects();
  if (data_folder()) all.push_back(subjects({"textured/AcousticGuitar.glb"})[0]);
  return all;
}

std::vector<Subject> scan_subjects() {
  return subjects({"scans/bunny.ply", "scans/armadillo.ply", "scans/hand.ply", "scans/hammer.ply",
                   "scans/nefertiti.ply", "scans/dragon.ply"});
}

std::vector<Subject> render_subjects() {
  return subjects({"textured/DamagedHelmet.glb", "textured/AcousticGuitar.glb", "textured/ToyCar.glb",
                   "scans/dragon.ply"});
}

std::vector<Subject> textured_subjects() {
  return subjects({"textured/DamagedHelmet.glb", "textured/WaterBottle.glb",
                   "textured/MaterialsVariantsShoe.glb", "textured/YcbBanana.glb", "textured/SheenChair.glb",
                   "textured/Duck.glb", "textured/BoomBox.glb", "textured/ExplodingBarrel.glb",
                   "textured/AntiqueCameraBody.glb", "textured/IridescenceLamp.glb",
                   "textured/AcousticGuitar.glb", "textured/GlamVelvetSofa.glb", "textured/Avocado.glb",
                   "textured/Suzanne.glb", "textured/LightsPunctualLamp.glb", "textured/StainedGlassLamp.glb",
                   "textured/ToyCar.glb"});
}

std::vector<Subject> texture_subjects() {
  std::vector<Subject> all = textured_subjects();
  if (data_folder()) all.push_back(sample_subject("vase"));
  return all;
}

Subject noise_sphere(std::size_t triangles) {
  return {"noise sphere", [triangles] { return make_noise_sphere(triangles); }};
}

void keep_positions_only(Model& model) {
  for (Mesh& mesh : model.meshes) mesh.surface.layers.clear();
}

void add_missing_normals(Model& model) {
  for (Mesh& mesh : model.meshes) {
    if (mesh.surface.layers.empty()) mesh.surface.layers.push_back(normal_layer(mesh.surface));
  }
}

std::size_t triangle_count(const Model& model) {
  std::size_t count = 0;
  for (const Mesh& mesh : model.meshes) count += mesh.surface.face_count();
  return count;
}

}  // namespace fovea::bench
