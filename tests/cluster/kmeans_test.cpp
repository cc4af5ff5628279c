#include "fovea/cluster/kmeans.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "fovea/base/random.h"
#include "fovea/cluster/connect.h"
#include "support/meshes.h"

namespace fovea {
namespace {

/// Triangles of side 0.01 at random places, each for itself.
Surface soup(std::size_t count, std::uint64_t seed) {
  Random random(seed);
  Surface surface;
  for (std::uint32_t i = 0; i < count; ++i) {
    const Vec3f p{static_cast<float>(random.uniform()), static_cast<float>(random.uniform()),
                  static_cast<float>(random.uniform())};
    surface.positions.insert(surface.positions.end(), {p, p + Vec3f{0.01f, 0, 0}, p + Vec3f{0, 0.01f, 0}});
    surface.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
  }
  return surface;
}

std::vector<std::uint32_t> first_faces(std::uint32_t count) {
  std::vector<std::uint32_t> faces(count);
  for (std::uint32_t i = 0; i < count; ++i) faces[i] = i;
  return faces;
}

TEST(KMeans, EndsWhereTrianglesAreNearestToTheMeansOfTheirClusters) {
  Context context;
  const DualGraph graph = dual_graph(soup(3000, 1), context);
  const KMeans found = k_means(graph, first_faces(20), 1000, context);
  EXPECT_EQ(found.end, ClusterEnd::converged);
  std::vector<Vec3d> sums(20);
  std::vector<double> counts(20, 0);
  for (std::size_t f = 0; f < 3000; ++f) {
    sums[found.of_face[f]] += Vec3d(graph.centers[f]);
    ++counts[found.of_face[f]];
  }
  std::size_t astray = 0;
  for (std::size_t f = 0; f < 3000; ++f) {
    const auto squared = [&](std::uint32_t c) {
      return length_squared(Vec3d(graph.centers[f]) - sums[c] / counts[c]);
    };
    std::uint32_t nearest = 0;
    for (std::uint32_t c = 1; c < 20; ++c) nearest = squared(c) < squared(nearest) ? c : nearest;
    astray += nearest != found.of_face[f];
  }
  EXPECT_LT(astray, 60u) << "it stops when little is left to gain";
}

// Looking outwards along one axis finds what looking at all finds: one round of assignment by hand.
TEST(KMeans, AssignsToTheNearest) {
  Context context;
  const DualGraph graph = dual_graph(soup(2000, 2), context);
  const std::vector<std::uint32_t> first = first_faces(50);
  const KMeans found = k_means(graph, first, 1, context);
  EXPECT_EQ(found.end, ClusterEnd::rounds);
  EXPECT_EQ(found.rounds, 1u);
  for (std::size_t f = 0; f < 2000; ++f) {
    const auto nearest = std::min_element(first.begin(), first.end(), [&](std::uint32_t a, std::uint32_t b) {
      const Vec3d p(graph.centers[f]);
      return length_squared(Vec3d(graph.centers[a]) - p) < length_squared(Vec3d(graph.centers[b]) - p);
    });
    EXPECT_EQ(found.of_face[f], nearest - first.begin());
  }
}

TEST(KMeans, NoClusterIsEmpty) {
  Context context;
  Surface stack = soup(40, 3);
  for (std::size_t i = 3; i < stack.positions.size(); ++i) stack.positions[i] = stack.positions[i % 3];
  const DualGraph graph = dual_graph(stack, context);
  for (const std::uint32_t count : {1u, 7u, 40u}) {
    const KMeans found = k_means(graph, first_faces(count), 10, context);
    EXPECT_EQ(std::set<std::uint32_t>(found.of_face.begin(), found.of_face.end()).size(), count);
    const std::vector<std::uint32_t> nearest = nearest_faces(graph, found.of_face, found.centers);
    for (std::uint32_t c = 0; c < count; ++c) EXPECT_EQ(found.of_face[nearest[c]], c);
  }
}

/// A strip of quads along x; of quad i triangle 2 i + 1 is on the left, 2 i on the right.
ClusterGround strip(int quads) { return {surface_of(test::grid(quads, 1)), {}, Context()}; }

TEST(Connect, LargestPieceStaysAndOthersJoinWhatIsAroundThem) {
  const ClusterGround ground = strip(5);
  std::vector<std::uint32_t> of_face{0, 0, 0, 0, 1, 1, 0, 0, 1, 0};
  // Of 0 the first two quads stay, of 1 the third; what is beyond follows it ring by ring.
  connect(ground, of_face, 2);
  EXPECT_EQ(of_face, (std::vector<std::uint32_t>{0, 0, 0, 0, 1, 1, 1, 1, 1, 1}));
}

TEST(Connect, ByTheLongestCommonBorder) {
  const ClusterGround ground{surface_of(test::grid(3, 3)), {}, Context()};
  // All is 1 but the middle quad and a far corner: the middle is the larger piece of 0 only by a triangle.
  std::vector<std::uint32_t> of_face(18, 1);
  of_face[8] = of_face[9] = 0;
  of_face[0] = 0;
  connect(ground, of_face, 2);
  EXPECT_EQ(of_face[0], 1u);
  EXPECT_EQ(of_face[8], 0u);
  EXPECT_EQ(of_face[9], 0u);
}

TEST(Connect, LeavesConnectedOnesAlone) {
  const ClusterGround ground = strip(4);
  const std::vector<std::uint32_t> before{2, 2, 0, 0, 1, 0, 1, 1};
  std::vector<std::uint32_t> of_face = before;
  connect(ground, of_face, 3);
  EXPECT_EQ(of_face, before);
}

}  // namespace
}  // namespace fovea
