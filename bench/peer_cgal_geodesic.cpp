#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/Surface_mesh_shortest_path.h>

#include <vector>

#include "peers.h"

namespace fovea::bench {
namespace {

using ExactKernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using ExactMesh = CGAL::Surface_mesh<ExactKernel::Point_3>;
using ShortestPaths =
    CGAL::Surface_mesh_shortest_path<CGAL::Surface_mesh_shortest_path_traits<ExactKernel, ExactMesh>>;

}  // namespace

std::vector<double> cgal_geodesics(const Surface& surface, std::uint32_t source,
                                   std::span<const std::uint32_t> targets) {
  ExactMesh mesh;
  std::vector<ExactMesh::Vertex_index> vertices;
  for (const Vec3f& p : surface.positions) vertices.push_back(mesh.add_vertex({p.x, p.y, p.z}));
  for (const auto& [a, b, c] : surface.triangles) {
    if (mesh.add_face(vertices[a], vertices[b], vertices[c]) == ExactMesh::null_face()) return {};
  }
  ShortestPaths paths(mesh);
  paths.add_source_point(vertices[source]);
  std::vector<double> distances;
  for (const std::uint32_t target : targets)
    distances.push_back(paths.shortest_distance_to_source_points(vertices[target]).first);
  return distances;
}

}  // namespace fovea::bench
