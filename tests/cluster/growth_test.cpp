#include "fovea/cluster/growth.h"

#include <gtest/gtest.h>

#include <set>

#include "fovea/base/random.h"
#include "fovea/cluster/seeds.h"
#include "oracle/cluster_oracle.h"
#include "support/meshes.h"

namespace fovea {
namespace {

VertexField random_saliency(std::size_t count, std::uint64_t seed) {
  Random random(seed);
  VertexField saliency(count);
  for (float& s : saliency.values()) s = static_cast<float>(random.uniform());
  return saliency;
}

ClusterGround ground_of(const TriMesh& mesh, std::uint64_t seed) {
  Surface surface = surface_of(mesh);
  scale(surface, unit_scale(surface));
  return {surface, random_saliency(surface.positions.size(), seed), Context()};
}

/// No two in one triangle.
std::vector<std::uint32_t> apart(const ClusterGround& ground, std::size_t count) {
  const auto next = [&](std::uint32_t v) {
    return (v + 17) % static_cast<std::uint32_t>(ground.vertex_saliency.size());
  };
  std::set<std::uint32_t> taken;
  std::vector<std::uint32_t> seeds;
  for (std::uint32_t v = 0; seeds.size() < count; v = next(v)) {
    bool free = true;
    for (const std::uint32_t c : ground.adjacency.corners(v)) free = free && taken.count(c / 3) == 0;
    if (!free) continue;
    for (const std::uint32_t c : ground.adjacency.corners(v)) taken.insert(c / 3);
    seeds.push_back(v);
  }
  return seeds;
}

TEST(Growth, IsAsItIsWritten) {
  for (const std::uint64_t seed : {1u, 2u, 3u}) {
    for (const TriMesh& mesh : {test::icosphere(2), test::wavy_grid(12, 9, 0.2), test::torus(14, 9)}) {
      const ClusterGround ground = ground_of(mesh, seed);
      const std::vector<std::uint32_t> seeds = apart(ground, 5);
      Growth growth(ground);
      EXPECT_EQ(growth.grow(seeds), test::literal_growth(ground.surface, ground.vertex_saliency, seeds));
    }
  }
}

TEST(Growth, DoesNotRememberTheLastOne) {
  const ClusterGround ground = ground_of(test::icosphere(2), 1);
  Growth once(ground), twice(ground);
  twice.grow(apart(ground, 9));
  EXPECT_EQ(twice.grow(apart(ground, 4)), once.grow(apart(ground, 4)));
}

TEST(Growth, SeedsMayShareATriangleOrBeTheSame) {
  const ClusterGround ground = ground_of(test::tetrahedron(), 1);
  Growth growth(ground);
  const std::vector<std::uint32_t>& of_face = growth.grow(std::vector<std::uint32_t>{0, 0, 0, 0});
  EXPECT_EQ(std::set<std::uint32_t>(of_face.begin(), of_face.end()), (std::set<std::uint32_t>{0, 1, 2, 3}));
}

TEST(InnerSeeds, AreAsItIsWritten) {
  const Context context;
  for (const std::uint64_t seed : {1u, 2u, 3u}) {
    const ClusterGround ground = ground_of(test::icosphere(2), seed);
    const std::vector<std::uint32_t> seeds = apart(ground, 5);
    Growth growth(ground);
    const std::vector<std::uint32_t> of_face = growth.grow(seeds);
    EXPECT_EQ(inner_seeds(ground, of_face, seeds, context),
              test::literal_inner_seeds(ground.surface, ground.vertex_saliency, of_face, 5));
  }
}

TEST(InnerSeeds, AClusterWithoutBorderKeepsItsSeed) {
  const ClusterGround ground = ground_of(test::icosphere(1), 1);
  const std::vector<std::uint32_t> of_face(ground.graph.face_count(), 0), seeds{17};
  EXPECT_EQ(inner_seeds(ground, of_face, seeds, Context()), seeds);
}

TEST(SalientSeeds, AreFromTheMostSalientVertices) {
  const ClusterGround ground = ground_of(test::icosphere(3), 1);
  std::vector<float> sorted = ground.vertex_saliency;
  std::sort(sorted.rbegin(), sorted.rend());
  const std::vector<std::uint32_t> seeds = salient_seeds(ground, 8, 1);
  EXPECT_EQ(std::set<std::uint32_t>(seeds.begin(), seeds.end()).size(), 8u);
  for (const std::uint32_t v : seeds) EXPECT_GE(ground.vertex_saliency[v], sorted[5 * 8 - 1]);
  EXPECT_EQ(salient_seeds(ground, 8, 1), seeds);
  EXPECT_NE(salient_seeds(ground, 8, 2), seeds);
}

TEST(SalientSeeds, RepeatWhereVerticesAreTooFew) {
  const ClusterGround ground = ground_of(test::cube(), 1);
  const std::vector<std::uint32_t> seeds = salient_seeds(ground, 12, 1);
  EXPECT_EQ(seeds.size(), 12u);
  EXPECT_EQ(std::set<std::uint32_t>(seeds.begin(), seeds.end()).size(), 8u);
}

// Farthest of all, looked for anew each time.
TEST(SpreadFaces, AreFarFromEachOther) {
  const DualGraph graph = ground_of(test::wavy_grid(9, 7, 0.1), 1).graph;
  const auto distances_from = [&](const std::vector<std::uint32_t>& from) {
    std::vector<float> d(graph.face_count(), 1e9f);
    for (const std::uint32_t f : from) d[f] = 0;
    for (bool changed = true; changed;) {
      changed = false;
      for (std::size_t f = 0; f < d.size(); ++f) {
        for (const DualGraph::Link& link : graph.around(f)) {
          if (d[f] + link.distance < d[link.face]) d[link.face] = d[f] + link.distance, changed = true;
        }
      }
    }
    return d;
  };
  const std::vector<std::uint32_t> faces = spread_faces(graph, 12, 3);
  for (std::size_t i = 1; i < faces.size(); ++i) {
    const std::vector<float> d =
        distances_from({faces.begin(), faces.begin() + static_cast<std::ptrdiff_t>(i)});
    EXPECT_EQ(faces[i], std::max_element(d.begin(), d.end()) - d.begin());
  }
  const std::vector<std::uint32_t> all = spread_faces(graph, graph.face_count(), 3);
  EXPECT_EQ(std::set<std::uint32_t>(all.begin(), all.end()).size(), graph.face_count());
}

}  // namespace
}  // namespace fovea
