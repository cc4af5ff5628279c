#include "fovea/cluster/dual_graph.h"

#include <gtest/gtest.h>

#include <set>

#include "fovea/base/random.h"
#include "fovea/cluster/bridges.h"
#include "support/meshes.h"

namespace fovea {
namespace {

std::set<std::uint32_t> faces_around(const DualGraph& graph, std::size_t face) {
  std::set<std::uint32_t> faces;
  for (const DualGraph::Link& link : graph.around(face)) faces.insert(link.face);
  return faces;
}

std::size_t pieces(const DualGraph& graph) {
  DisjointSets sets(graph.face_count());
  for (std::size_t f = 0; f < graph.face_count(); ++f) {
    for (const DualGraph::Link& link : graph.around(f)) sets.unite(f, link.face);
  }
  std::size_t count = 0;
  for (std::size_t f = 0; f < graph.face_count(); ++f) count += sets.find(f) == f;
  return count;
}

TEST(DualGraph, LinksTrianglesOverEdges) {
  const Context context;
  const DualGraph graph = dual_graph(surface_of(test::tetrahedron()), context);
  ASSERT_EQ(graph.face_count(), 4u);
  for (std::uint32_t f = 0; f < 4; ++f) {
    std::set<std::uint32_t> others{0, 1, 2, 3};
    others.erase(f);
    EXPECT_EQ(faces_around(graph, f), others);
    for (const DualGraph::Link& link : graph.around(f))
      EXPECT_NEAR(static_cast<double>(link.distance),
                  length(Vec3d(graph.centers[f]) - Vec3d(graph.centers[link.face])), 1e-6);
  }
}

TEST(DualGraph, HasCentersNormalsAndAreas) {
  const Context context;
  const DualGraph graph = dual_graph({{{0, 0, 1}, {3, 0, 1}, {0, 3, 1}}, {{0, 1, 2}}}, context);
  EXPECT_EQ(graph.centers[0], Vec3f(1, 1, 1));
  EXPECT_EQ(graph.normals[0], Vec3f(0, 0, 1));
  EXPECT_EQ(graph.areas[0], 4.5f);
  EXPECT_TRUE(graph.around(0).empty());
}

TEST(DualGraph, AllAroundANonManifoldEdgeAreLinked) {
  const Context context;
  const DualGraph graph = dual_graph(surface_of(test::non_manifold_edge()), context);
  for (std::uint32_t f = 0; f < 3; ++f) EXPECT_EQ(graph.around(f).size(), 2u);
}

TEST(DualGraph, ATriangleWithoutAreaHasNoNormal) {
  const Context context;
  const DualGraph graph =
      dual_graph({{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {0, 1, 0}}, {{0, 1, 2}, {0, 1, 3}}}, context);
  EXPECT_EQ(graph.normals[0], Vec3f(0, 0, 0));
  EXPECT_EQ(graph.areas[0], 0.0f);
  EXPECT_EQ(faces_around(graph, 0), std::set<std::uint32_t>{1});
}

TEST(DualGraph, BridgesJoinPieces) {
  const Context context;
  for (const TriMesh& mesh : {test::tetrahedra(7), test::bow_tie()})
    EXPECT_EQ(pieces(dual_graph(surface_of(mesh), context)), 1u);
}

TEST(Bridges, JoinNearSetsWithOneFewerThanThereAre) {
  const std::vector<Vec3f> points{{0, 0, 0}, {10, 0, 0}, {0.01f, 0, 0}, {10, 0.01f, 0}, {0, 0.02f, 0}};
  DisjointSets sets(points.size());
  sets.unite(0, 4);
  const auto pairs = bridges(points, sets);
  ASSERT_EQ(pairs.size(), 3u);
  int far = 0;
  for (const auto& [a, b] : pairs) far += length(Vec3d(points[a]) - Vec3d(points[b])) > 1;
  EXPECT_EQ(far, 1) << "only one spans the gap";
  for (std::size_t i = 0; i < points.size(); ++i) EXPECT_EQ(sets.find(i), 0u);
}

TEST(Bridges, AreShortWhereSetsAreDense) {
  Random random(5);
  std::vector<Vec3f> points(20000);
  for (Vec3f& p : points) {
    p = {static_cast<float>(random.uniform()), static_cast<float>(random.uniform()),
         static_cast<float>(random.uniform())};
  }
  DisjointSets sets(points.size());
  const auto pairs = bridges(points, sets);
  EXPECT_EQ(pairs.size() + 1, points.size());
  double sum = 0;
  for (const auto& [a, b] : pairs) sum += length(Vec3d(points[a]) - Vec3d(points[b]));
  // The mean over the shortest tree of random points is about 0.65 of the cube root of the volume of each.
  EXPECT_LT(sum / static_cast<double>(pairs.size()), 3 * std::cbrt(1.0 / 20000));
}

TEST(Bridges, OfPointsInOnePlaceAreThereToo) {
  const std::vector<Vec3f> points(100, Vec3f{1, 2, 3});
  DisjointSets sets(points.size());
  EXPECT_EQ(bridges(points, sets).size(), 99u);
}

}  // namespace
}  // namespace fovea
