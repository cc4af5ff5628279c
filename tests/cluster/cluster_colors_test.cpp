#include "fovea/cluster/cluster_colors.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <set>

#include "support/meshes.h"

namespace fovea {
namespace {

TEST(ClusterColors, OfNeighborsAreClearlyDifferent) {
  const TriMesh mesh = test::icosphere(4);
  SceneSurface scene;
  scene.surface = surface_of(mesh);
  Context context;
  const Clusters clusters =
      make_clusters(scene, VertexField(mesh.vertex_count()), {60, ClusterMethod::propagative, 20}, context);
  const auto colors = cluster_colors(scene, clusters);
  ASSERT_EQ(colors.size(), 60u);
  EXPECT_EQ(std::set(colors.begin(), colors.end()).size(), 12u);
  std::vector<std::set<std::uint32_t>> around(mesh.vertex_count());
  for (std::size_t f = 0; f < mesh.face_count(); ++f) {
    for (const std::uint32_t v : scene.surface.triangles[f]) around[v].insert(clusters.of_face[FaceId{f}]);
  }
  for (const auto& near : around) {
    for (const std::uint32_t a : near) {
      for (const std::uint32_t b : near) {
        int apart = 0;
        for (std::size_t i = 0; i < 3; ++i) apart += std::abs(colors[a][i] - colors[b][i]);
        EXPECT_TRUE(a == b || apart >= 80) << a << " and " << b;
      }
    }
  }
}

TEST(ClusterColors, AreThereHoweverManyMeet) {
  // A fan of a thousand triangles around one vertex, each its own cluster.
  SceneSurface scene;
  scene.surface.positions.push_back({0, 0, 0});
  for (std::uint32_t i = 0; i < 1000; ++i) {
    scene.surface.positions.push_back({static_cast<float>(i), 1, 0});
    scene.surface.positions.push_back({static_cast<float>(i), 2, 0});
    scene.surface.triangles.push_back({0, 2 * i + 1, 2 * i + 2});
  }
  Clusters clusters;
  clusters.count = 1000;
  clusters.of_face = Field<FaceId, std::uint32_t>(1000);
  for (std::uint32_t i = 0; i < 1000; ++i) clusters.of_face[FaceId{i}] = i;
  const auto colors = cluster_colors(scene, clusters);
  for (std::size_t i = 1; i < 1000; ++i) EXPECT_NE(colors[i], colors[i - 1]);
}

}  // namespace
}  // namespace fovea
