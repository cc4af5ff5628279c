#include "fovea/cluster/clusters.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <string>

#include "fovea/base/random.h"
#include "fovea/cluster/dual_graph.h"
#include "fovea/surface/disjoint_sets.h"
#include "fovea/surface/local_order.h"
#include "support/meshes.h"
#include "support/reading.h"

namespace fovea {
namespace {

constexpr ClusterMethod kMethods[] = {ClusterMethod::salient, ClusterMethod::propagative,
                                      ClusterMethod::kmeans};

SceneSurface scene_of(Surface surface) {
  SceneSurface scene;
  scene.first_vertex = {0, static_cast<std::uint32_t>(surface.positions.size())};
  scene.first_triangle = {0, static_cast<std::uint32_t>(surface.triangles.size())};
  scene.surface = std::move(surface);
  return scene;
}

SceneSurface scene_of(const TriMesh& mesh) { return scene_of(surface_of(mesh)); }

/// Triangles at random places, some of them in one place, some without area.
Surface soup(std::size_t count) {
  Random random(11);
  const auto number = [&] { return static_cast<float>(random.uniform()); };
  Surface surface;
  for (std::uint32_t i = 0; i < count; ++i) {
    const Vec3f p = i % 10 == 9 ? surface.positions[0] : Vec3f{number(), number(), number()};
    const Vec3f side = i % 7 == 6 ? Vec3f{0.02f, 0, 0} : Vec3f{0, 0.01f, 0};
    surface.positions.insert(surface.positions.end(), {p, p + Vec3f{0.01f, 0, 0}, p + side});
    surface.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
  }
  return surface;
}

/// A smooth field over any surface.
VertexField waves(const Surface& surface) {
  VertexField saliency(surface.positions.size());
  for (std::uint32_t v = 0; v < saliency.size(); ++v) {
    const Vec3d p = surface.position(v);
    saliency.values()[v] = static_cast<float>(1 + std::sin(3 * p.x) * std::cos(5 * p.y + p.z)) / 2;
  }
  return saliency;
}

Clusters divide(const SceneSurface& scene, std::int64_t count, ClusterMethod method, std::uint64_t seed = 1,
                int threads = 0) {
  Context context;
  context.seed = seed;
  context.threads = threads;
  return make_clusters(scene, waves(scene.surface), {count, method, 100}, context);
}

/// Whether all triangles of a cluster can be reached from each other, on the graph that clusters grow over.
bool are_connected(const SceneSurface& scene, const Clusters& clusters) {
  const LocalOrder order = local_order(scene.surface);
  Surface surface = reordered(scene.surface, order);
  scale(surface, unit_scale(surface));
  const DualGraph graph = dual_graph(surface, Context());
  const auto cluster = [&](std::size_t f) { return clusters.of_face[order.faces[f]]; };
  DisjointSets sets(graph.face_count());
  std::size_t pieces = graph.face_count();
  for (std::size_t f = 0; f < graph.face_count(); ++f) {
    for (const DualGraph::Link& link : graph.around(f)) {
      if (cluster(f) != cluster(link.face) || sets.find(f) == sets.find(link.face)) continue;
      sets.unite(f, link.face);
      --pieces;
    }
  }
  return pieces == clusters.count;
}

void expect_good(const SceneSurface& scene, const Clusters& clusters, const std::string& what) {
  const auto of_face = clusters.of_face.values();
  ASSERT_EQ(of_face.size(), scene.surface.triangles.size()) << what;
  const std::set<std::uint32_t> used(of_face.begin(), of_face.end());
  EXPECT_EQ(used.size(), clusters.count) << what;
  EXPECT_LT(*used.rbegin(), clusters.count) << what;
  EXPECT_EQ(clusters.seeds.size(), clusters.count) << what;
  for (const std::uint32_t v : clusters.seeds) EXPECT_LT(v, scene.surface.positions.size()) << what;
  EXPECT_GE(clusters.rounds, 1u);
  EXPECT_TRUE(are_connected(scene, clusters)) << what;
}

TEST(Clusters, HoldEveryTriangleOnceAndAreConnected) {
  std::vector<test::NamedMesh> meshes = test::all_families();
  meshes.push_back({"sphere", test::icosphere(4)});
  meshes.push_back({"shuffled", test::shuffled(test::wavy_grid(40, 40, 0.2))});
  for (const auto& [name, mesh] : meshes) {
    if (mesh.face_count() == 0) continue;
    const SceneSurface scene = scene_of(mesh);
    for (const ClusterMethod method : kMethods) {
      for (const std::int64_t count : {1, 2, 9, 1000000}) {
        const Clusters clusters = divide(scene, count, method);
        EXPECT_EQ(clusters.count, std::min<std::size_t>(static_cast<std::size_t>(count), mesh.face_count()));
        expect_good(scene, clusters, name + " by method " + std::to_string(static_cast<int>(method)));
      }
    }
  }
}

TEST(Clusters, SeedsOfKMeansAreInTheirClusters) {
  const SceneSurface scene = scene_of(test::shuffled(test::wavy_grid(40, 40, 0.5)));
  const Clusters clusters = divide(scene, 30, ClusterMethod::kmeans);
  std::vector<bool> in_cluster(30, false);
  for (std::size_t f = 0; f < scene.surface.triangles.size(); ++f) {
    const std::uint32_t c = clusters.of_face[FaceId{f}];
    for (const std::uint32_t v : scene.surface.triangles[f])
      in_cluster[c] = in_cluster[c] || v == clusters.seeds[c];
  }
  EXPECT_EQ(std::count(in_cluster.begin(), in_cluster.end(), true), 30);
}

TEST(Clusters, OfASoupOfTriangles) {
  const SceneSurface scene = scene_of(soup(3000));
  for (const ClusterMethod method : kMethods) expect_good(scene, divide(scene, 20, method), "soup");
}

TEST(Clusters, OfTrianglesThatAreAllInOnePlace) {
  Surface surface = soup(50);
  for (Vec3f& p : surface.positions) p = {1, 2, 3};
  const SceneSurface scene = scene_of(surface);
  for (const ClusterMethod method : kMethods) expect_good(scene, divide(scene, 8, method), "a point");
}

TEST(Clusters, AreTheSameForAnyNumberOfThreads) {
  const SceneSurface scene = scene_of(test::icosphere(5));
  for (const ClusterMethod method : kMethods) {
    const Clusters one = divide(scene, 20, method, 1, 1), two = divide(scene, 20, method, 1, 2);
    EXPECT_EQ(one.of_face, two.of_face);
    EXPECT_EQ(one.seeds, two.seeds);
    EXPECT_EQ(one.rounds, two.rounds);
  }
}

TEST(Clusters, DependOnTheSeed) {
  const SceneSurface scene = scene_of(test::icosphere(4));
  for (const ClusterMethod method : kMethods) {
    EXPECT_EQ(divide(scene, 12, method, 1).of_face, divide(scene, 12, method, 1).of_face);
    EXPECT_NE(divide(scene, 12, method, 1).of_face, divide(scene, 12, method, 2).of_face);
  }
}

// By powers of two, which lose no digits.
TEST(Clusters, AreTheSameInAnyUnitOfLength) {
  const SceneSurface scene = scene_of(test::icosphere(3));
  for (const ClusterMethod method : kMethods) {
    Context context;
    const VertexField saliency = waves(scene.surface);
    const Clusters expected = make_clusters(scene, saliency, {9, method, 100}, context);
    for (const float unit : {0x1p-100f, 0x1p100f}) {
      SceneSurface scaled = scene;
      for (Vec3f& p : scaled.surface.positions) p = p * unit;
      EXPECT_EQ(make_clusters(scaled, saliency, {9, method, 100}, context).of_face, expected.of_face);
    }
  }
}

/// A sheet with two bumps that stand out.
SceneSurface two_bumps(VertexField& saliency) {
  Surface surface = surface_of(test::grid(60, 30));
  saliency = VertexField(surface.positions.size());
  for (std::uint32_t v = 0; v < surface.positions.size(); ++v) {
    Vec3f& p = surface.positions[v];
    p.x *= 2;
    double height = 0;
    for (const double middle : {0.5, 1.5}) {
      const double dx = static_cast<double>(p.x) - middle, dy = static_cast<double>(p.y) - 0.5;
      height += std::exp(-(dx * dx + dy * dy) / (2 * 0.12 * 0.12));
    }
    saliency.values()[v] = static_cast<float>(height);
    p.z = static_cast<float>(0.25 * height);
  }
  return scene_of(surface);
}

TEST(Clusters, SalientOnesPartBumps) {
  VertexField saliency;
  const SceneSurface scene = two_bumps(saliency);
  for (const std::uint64_t seed : {1u, 2u, 3u, 4u, 5u}) {
    Context context;
    context.seed = seed;
    const Clusters clusters = make_clusters(scene, saliency, {4, ClusterMethod::salient, 100}, context);
    std::set<std::uint32_t> left, right;
    for (std::size_t f = 0; f < scene.surface.triangles.size(); ++f) {
      const std::uint32_t v = scene.surface.triangles[f][0];
      if (saliency.values()[v] < 0.5f) continue;
      (scene.surface.positions[v].x < 1 ? left : right).insert(clusters.of_face[FaceId{f}]);
    }
    for (const std::uint32_t c : left) EXPECT_EQ(right.count(c), 0u) << "seed " << seed;
  }
}

TEST(Clusters, StopAfterSoManyRounds) {
  const SceneSurface scene = scene_of(test::icosphere(4));
  Context context;
  const Clusters clusters =
      make_clusters(scene, waves(scene.surface), {20, ClusterMethod::salient, 1}, context);
  EXPECT_EQ(clusters.rounds, 1u);
  EXPECT_EQ(clusters.end, ClusterEnd::rounds);
}

TEST(Clusters, WhereNothingStandsOutDirectionAndDistanceDecide) {
  const SceneSurface scene = scene_of(test::icosphere(3));
  Context context;
  for (const float even : {0.0f, 0.5f}) {
    expect_good(scene,
                make_clusters(scene, VertexField(scene.surface.positions.size(), even),
                              {10, ClusterMethod::salient, 100}, context),
                "even");
  }
}

TEST(Clusters, BadInputIsRefused) {
  const SceneSurface scene = scene_of(test::cube());
  const VertexField good(8);
  const auto error = [](const SceneSurface& s, const VertexField& saliency, ClusterOptions options,
                        ErrorKind kind, const char* message) {
    Context context;
    test::expect_error([&] { make_clusters(s, saliency, options, context); }, kind, "", message);
  };
  error(scene, good, {0, ClusterMethod::salient, 100}, ErrorKind::usage, "");
  error(scene, good, {3, ClusterMethod::salient, 0}, ErrorKind::usage, "");
  error(scene, VertexField(7), {}, ErrorKind::usage, "7 values but the scene has 8");
  for (const float bad :
       {-1.0f, std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity()})
    error(scene, VertexField(8, bad), {}, ErrorKind::usage, "saliency of");
  error(scene_of(Surface()), {}, {}, ErrorKind::unsupported, "no triangles");
  Surface infinite = scene.surface;
  infinite.positions[0].x = std::numeric_limits<float>::infinity();
  error(scene_of(infinite), good, {}, ErrorKind::unsupported, "");
}

TEST(Clusters, CanBeCancelled) {
  const SceneSurface scene = scene_of(test::icosphere(2));
  for (const ClusterMethod method : kMethods) {
    Context context;
    context.progress = [](std::string_view phase, double) { return phase != "cluster"; };
    test::expect_error(
        [&] {
          make_clusters(scene, waves(scene.surface), {4, method, 100}, context);
        },
        ErrorKind::cancelled, "");
  }
}

}  // namespace
}  // namespace fovea
