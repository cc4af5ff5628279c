#include "fovea/surface/local_order.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "support/meshes.h"

namespace fovea {
namespace {

/// Sum of the distances in memory from each corner's vertex to the next's.
double way(const TriMesh& mesh, const LocalOrder& order) {
  std::vector<double> place(mesh.vertex_count());
  for (std::size_t i = 0; i < order.vertices.size(); ++i)
    place[order.vertices[i].index()] = static_cast<double>(i);
  double sum = 0, last = 0;
  for (const FaceId f : order.faces) {
    for (const VertexId v : mesh.triangles[f.index()]) {
      sum += std::abs(place[v.index()] - last);
      last = place[v.index()];
    }
  }
  return sum;
}

LocalOrder own_order(const TriMesh& mesh) {
  LocalOrder order;
  for (std::size_t v = 0; v < mesh.vertex_count(); ++v) order.vertices.push_back(VertexId{v});
  for (std::size_t f = 0; f < mesh.face_count(); ++f) order.faces.push_back(FaceId{f});
  return order;
}

TEST(LocalOrder, NamesEveryVertexAndTriangleOnce) {
  const TriMesh mesh = test::shuffled(test::torus(96, 48));
  const LocalOrder order = local_order(surface_of(mesh));
  std::vector<int> vertices(mesh.vertex_count()), faces(mesh.face_count());
  for (const VertexId v : order.vertices) ++vertices[v.index()];
  for (const FaceId f : order.faces) ++faces[f.index()];
  EXPECT_EQ(vertices, std::vector<int>(mesh.vertex_count(), 1));
  EXPECT_EQ(faces, std::vector<int>(mesh.face_count(), 1));
}

TEST(LocalOrder, BringsScatteredNeighboursTogether) {
  // In random order the next corner is a third of all vertices away; on a Z-order curve most are within the
  // square root of them.
  const TriMesh mesh = test::shuffled(test::torus(96, 48));
  EXPECT_LT(way(mesh, local_order(surface_of(mesh))), 0.1 * way(mesh, own_order(mesh)));
}

TEST(LocalOrder, KeepsAnOrderThatIsLocal) {
  const TriMesh mesh = test::grid(64, 64);
  const LocalOrder order = local_order(surface_of(mesh)), own = own_order(mesh);
  EXPECT_EQ(order.vertices, own.vertices);
  EXPECT_EQ(order.faces, own.faces);
}

TEST(LocalOrder, PutsUpWithMeshesOfNoSize) {
  EXPECT_TRUE(local_order(Surface()).faces.empty());
  TriMesh mesh = test::shuffled(test::grid(64, 64));
  for (Vec3f& p : mesh.positions) p = {1, 2, 3};
  EXPECT_EQ(local_order(surface_of(mesh)).faces.size(), mesh.face_count());
}

TEST(LocalOrder, ReorderedSurfacesAreTheSame) {
  const Surface surface = surface_of(test::shuffled(test::grid(64, 64)));
  const LocalOrder order = local_order(surface);
  const Surface local = reordered(surface, order);
  VertexField x(local.positions.size());
  for (std::size_t v = 0; v < x.size(); ++v) x.values()[v] = local.positions[v].x;
  const VertexField own = in_own_order(x, order);
  EXPECT_EQ(in_order(own, order), x);
  for (std::size_t v = 0; v < x.size(); ++v) EXPECT_EQ(own.values()[v], surface.positions[v].x);
  for (std::size_t f = 0; f < local.triangles.size(); ++f) {
    for (std::size_t k = 0; k < 3; ++k) {
      EXPECT_EQ(local.positions[local.triangles[f][k]],
                surface.positions[surface.triangles[order.faces[f].index()][k]]);
    }
  }
}

}  // namespace
}  // namespace fovea
