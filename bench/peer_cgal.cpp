#include <CGAL/Simple_cartesian.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/Bounded_normal_change_filter.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/Count_ratio_stop_predicate.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/GarlandHeckbert_plane_policies.h>
#include <CGAL/Surface_mesh_simplification/edge_collapse.h>

#include <memory>
#include <vector>

#include "peers.h"

namespace fovea::bench {
namespace {

namespace SMS = CGAL::Surface_mesh_simplification;
using Kernel = CGAL::Simple_cartesian<double>;
using CgalSurface = CGAL::Surface_mesh<Kernel::Point_3>;
using Policies = SMS::GarlandHeckbert_plane_policies<CgalSurface, Kernel>;

CgalSurface surface_from(const TriMesh& mesh) {
  CgalSurface surface;
  std::vector<CgalSurface::Vertex_index> vertices;
  vertices.reserve(mesh.vertex_count());
  for (const Vec3f& p : mesh.positions) vertices.push_back(surface.add_vertex({p.x, p.y, p.z}));
  for (const auto& [a, b, c] : mesh.triangles) {
    surface.add_face(vertices[a.index()], vertices[b.index()], vertices[c.index()]);
  }
  return surface;
}

std::uint64_t simplify_surface(CgalSurface& surface, double ratio) {
  if (surface.number_of_faces() == 0) return 0;
  const SMS::Count_ratio_stop_predicate<CgalSurface> stop(ratio);
  const Policies policies(surface);
  const SMS::Bounded_normal_change_filter<> filter;
  SMS::edge_collapse(
      surface, stop,
      CGAL::parameters::get_cost(policies.get_cost()).filter(filter).get_placement(policies.get_placement()));
  return surface.number_of_faces();
}

}  // namespace

PeerWork cgal_peer(const Model& model, double ratio) {
  auto surfaces = std::make_shared<std::vector<CgalSurface>>();
  for (const Mesh& mesh : model.meshes) surfaces->push_back(surface_from(mesh.surface));
  return [surfaces, ratio] {
    std::uint64_t triangles = 0;
    for (CgalSurface& surface : *surfaces) triangles += simplify_surface(surface, ratio);
    return triangles;
  };
}

}  // namespace fovea::bench
