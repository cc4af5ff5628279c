#include "fovea/surface/correspondence.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string>

#include "fovea/base/error.h"
#include "fovea/surface/disjoint_sets.h"
#include "fovea/surface/pose.h"

namespace fovea {

namespace {

[[noreturn]] void differ(const std::string& message) {
  throw Error(ErrorKind::unsupported, message, {},
              "poses must have the same vertices and triangles in the same order");
}

/// Source vertex -> vertex.
std::vector<VertexId> vertices_of_sources(const TriMesh& mesh) {
  if (!mesh.source_vertex.empty()) return mesh.source_vertex;
  std::vector<VertexId> own;
  for (std::size_t v = 0; v < mesh.vertex_count(); ++v) own.emplace_back(v);
  return own;
}

/// The triangles with each vertex v as the set that `first_vertex` + v is in; those with a set twice are left
/// out, as `weld` does.
std::vector<std::array<std::uint32_t, 3>> merged_triangles(const TriMesh& mesh, std::size_t first_vertex,
                                                           DisjointSets& sets) {
  std::vector<std::array<std::uint32_t, 3>> triangles;
  for (const auto& triangle : mesh.triangles) {
    std::array<std::uint32_t, 3> t;
    for (std::size_t k = 0; k < 3; ++k) t[k] = sets.find(first_vertex + triangle[k].index());
    if (t[0] != t[1] && t[1] != t[2] && t[2] != t[0]) triangles.push_back(t);
  }
  return triangles;
}

void check_triangles(const TriMesh& first, const TriMesh& other, DisjointSets& sets) {
  const auto expected = merged_triangles(first, 0, sets),
             found = merged_triangles(other, first.vertex_count(), sets);
  if (found.size() != expected.size())
    differ(fmt::format("there are {} triangles but the first pose has {}", found.size(), expected.size()));
  const auto [a, b] = std::mismatch(expected.begin(), expected.end(), found.begin());
  if (a != expected.end())
    differ(fmt::format("triangle {} joins other vertices than in the first pose", a - expected.begin()));
}

/// The positions of a mesh's vertices as its first instance shows them.
std::vector<Vec3f> shown_positions(const Model& model, std::size_t mesh) {
  const Pose pose = rest_pose(model);
  for (const Instance& instance : instances(model, pose)) {
    if (instance.mesh == mesh) return posed_surface(model, pose, instance).positions;
  }
  return model.meshes[mesh].surface.positions;
}

}  // namespace

std::vector<VertexId> corresponding_vertices(const TriMesh& first, const TriMesh& other) {
  const std::vector<VertexId> a = vertices_of_sources(first), b = vertices_of_sources(other);
  if (a.size() != b.size())
    differ(fmt::format("there are {} vertices but the first pose has {}", b.size(), a.size()));
  DisjointSets sets(first.vertex_count() + other.vertex_count());
  std::vector<VertexId> result(first.vertex_count());
  for (std::size_t s = 0; s < a.size(); ++s) {
    if (a[s].valid() != b[s].valid()) {
      differ(fmt::format("vertex {} belongs to {} triangle but to {} in the first pose", s,
                         b[s].valid() ? "a" : "no", a[s].valid() ? "one" : "none"));
    }
    if (!a[s].valid()) continue;
    sets.unite(a[s].index(), first.vertex_count() + b[s].index());
    if (!result[a[s].index()].valid()) result[a[s].index()] = b[s];
  }
  check_triangles(first, other, sets);
  return result;
}

std::vector<Surface> surfaces_in(const Model& first, const Model& pose) {
  if (pose.meshes.size() != first.meshes.size())
    differ(fmt::format("there are {} meshes but the first pose has {}", pose.meshes.size(),
                       first.meshes.size()));
  std::vector<Surface> surfaces;
  for (std::size_t m = 0; m < first.meshes.size(); ++m) {
    const TriMesh &mesh = first.meshes[m].surface, &posed = pose.meshes[m].surface;
    std::vector<VertexId> vertices;
    try {
      vertices = corresponding_vertices(mesh, posed);
    } catch (const Error& error) {
      throw error.within(fmt::format("mesh {}", m));
    }
    const std::vector<Vec3f> positions = shown_positions(pose, m);
    Surface& surface = surfaces.emplace_back(surface_of(mesh));
    for (std::size_t v = 0; v < vertices.size(); ++v) surface.positions[v] = positions[vertices[v].index()];
  }
  return surfaces;
}

}  // namespace fovea
