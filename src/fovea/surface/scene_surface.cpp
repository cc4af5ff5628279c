#include "fovea/surface/scene_surface.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "fovea/base/error.h"

namespace fovea {

namespace {

/// How much larger an instance is than its mesh, in volume; skinned ones are as their joints make them.
double scale(const Instance& instance) { return std::abs(determinant3(instance.world)); }

/// For each mesh the instance that shows it largest, the first of equals; null if none does.
std::vector<const Instance*> largest_instances(const Model& model, const std::vector<Instance>& all) {
  std::vector<const Instance*> largest(model.meshes.size(), nullptr);
  for (const Instance& instance : all) {
    const Instance*& best = largest[instance.mesh];
    if (best == nullptr || scale(instance) > scale(*best)) best = &instance;
  }
  return largest;
}

}  // namespace

SceneSurface scene_surface(const Model& model, const Pose& pose) {
  const std::vector<Instance> all = instances(model, pose);
  const std::vector<const Instance*> largest = largest_instances(model, all);
  SceneSurface scene;
  scene.first_vertex.push_back(0);
  scene.first_triangle.push_back(0);
  std::vector<Vec3f>& positions = scene.surface.positions;
  const auto& triangles = scene.surface.triangles;
  for (std::size_t m = 0; m < model.meshes.size(); ++m) {
    const TriMesh& mesh = model.meshes[m].surface;
    if (positions.size() + mesh.vertex_count() + 3 * (triangles.size() + mesh.face_count()) >
        std::numeric_limits<std::uint32_t>::max())
      throw Error(ErrorKind::limit, "the scene has more than 2^32 - 1 corners");
    if (largest[m] != nullptr) {
      const PosedSurface posed = posed_surface(model, pose, *largest[m]);
      append(scene.surface, mesh, posed.positions, posed.mirrored);
    } else {
      positions.insert(positions.end(), mesh.positions.begin(), mesh.positions.end());
    }
    scene.first_vertex.push_back(static_cast<std::uint32_t>(positions.size()));
    scene.first_triangle.push_back(static_cast<std::uint32_t>(triangles.size()));
  }
  return scene;
}

std::vector<VertexField> split(const SceneSurface& scene, const VertexField& field) {
  std::vector<VertexField> fields;
  for (std::size_t m = 0; m + 1 < scene.first_vertex.size(); ++m) {
    const std::size_t first = scene.first_vertex[m];
    const std::span<const float> values = field.values().subspan(first, scene.first_vertex[m + 1] - first);
    fields.emplace_back(std::vector<float>(values.begin(), values.end()));
  }
  return fields;
}

VertexField joined(const std::vector<VertexField>& fields) {
  std::vector<float> values;
  for (const VertexField& field : fields)
    values.insert(values.end(), field.values().begin(), field.values().end());
  return VertexField(std::move(values));
}

}  // namespace fovea
