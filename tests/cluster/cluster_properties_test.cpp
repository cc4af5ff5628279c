#include "fovea/cluster/cluster_properties.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "support/meshes.h"
#include "support/reading.h"

namespace fovea {
namespace {

SceneSurface bare_scene(const TriMesh& mesh) {
  SceneSurface scene;
  scene.surface = surface_of(mesh);
  return scene;
}

/// The triangles of a cube by the axis that they look along: x, y, z, −x, −y, −z.
Clusters sides(const SceneSurface& scene) {
  Clusters clusters;
  clusters.count = 6;
  clusters.of_face = Field<FaceId, std::uint32_t>(scene.surface.triangles.size());
  for (std::size_t f = 0; f < scene.surface.triangles.size(); ++f) {
    const auto& t = scene.surface.triangles[f];
    const Vec3d a = scene.surface.position(t[0]),
                n = cross(scene.surface.position(t[1]) - a, scene.surface.position(t[2]) - a);
    const double values[] = {n.x, n.y, n.z, -n.x, -n.y, -n.z};
    clusters.of_face[FaceId{f}] = static_cast<std::uint32_t>(std::max_element(values, values + 6) - values);
  }
  return clusters;
}

TEST(ClusterProperties, OfTheSidesOfACube) {
  const SceneSurface scene = bare_scene(test::cube());
  VertexField saliency(8);
  for (std::uint32_t v = 0; v < 8; ++v)
    saliency.values()[v] = scene.surface.positions[v].x > 0 ? 1.0f : 0.25f;
  const auto properties = cluster_properties(scene, saliency, sides(scene));
  ASSERT_EQ(properties.size(), 6u);
  for (std::size_t i = 0; i < 6; ++i) {
    const ClusterProperties& p = properties[i];
    EXPECT_EQ(p.triangles, 2u);
    EXPECT_EQ(p.vertices, 4u);
    EXPECT_DOUBLE_EQ(p.area, 4);
    const double along = i < 3 ? 1 : -1;
    const Vec3d normal = i % 3 == 0   ? Vec3d{along, 0, 0}
                         : i % 3 == 1 ? Vec3d{0, along, 0}
                                      : Vec3d{0, 0, along};
    EXPECT_EQ(p.mean_normal, normal);
    EXPECT_EQ(p.peak_deviation, 0);
    EXPECT_EQ(p.sphere.center, normal);
    EXPECT_DOUBLE_EQ(p.sphere.radius, std::sqrt(2));
  }
  EXPECT_DOUBLE_EQ(properties[0].mean_saliency, 1);
  EXPECT_DOUBLE_EQ(properties[3].total_saliency, 1);
  EXPECT_DOUBLE_EQ(properties[1].total_saliency, 2.5);
  EXPECT_DOUBLE_EQ(properties[1].mean_saliency, 0.625);
  EXPECT_DOUBLE_EQ(properties[1].peak_saliency, 1);
  EXPECT_DOUBLE_EQ(properties[1].base_saliency, 0.25);
}

TEST(ClusterProperties, DeviationIsTheLargestAngle) {
  const SceneSurface scene = bare_scene(test::cube());
  Clusters clusters = sides(scene);
  for (std::uint32_t& c : clusters.of_face.values()) c = c < 3 ? 0 : 1;
  clusters.count = 2;
  const auto properties = cluster_properties(scene, VertexField(8), clusters);
  EXPECT_NEAR(properties[0].mean_normal.x, 1 / std::sqrt(3), 1e-12);
  EXPECT_NEAR(properties[0].peak_deviation, std::acos(1 / std::sqrt(3)), 1e-12);
}

TEST(ClusterProperties, WhereNormalsCancelOutThereIsNoMean) {
  const SceneSurface scene = bare_scene(test::icosphere(2));
  Clusters all;
  all.count = 1;
  all.of_face = Field<FaceId, std::uint32_t>(scene.surface.triangles.size());
  const auto properties = cluster_properties(scene, VertexField(scene.surface.positions.size()), all);
  EXPECT_EQ(properties[0].mean_normal, Vec3d());
  EXPECT_EQ(properties[0].peak_deviation, std::numbers::pi);
  EXPECT_NEAR(properties[0].sphere.radius, 1, 0.01);
}

TEST(ClusterProperties, OfTinyAndHugeScenesAreNumbers) {
  for (const float unit : {1e-37f, 1e37f}) {
    SceneSurface scene = bare_scene(test::cube());
    for (Vec3f& p : scene.surface.positions) p = p * unit;
    const ClusterProperties p = cluster_properties(scene, VertexField(8), sides(bare_scene(test::cube())))[0];
    EXPECT_NEAR(p.area / (4 * static_cast<double>(unit) * static_cast<double>(unit)), 1, 1e-6);
    EXPECT_NEAR(p.mean_normal.x, 1, 1e-6);
  }
}

/// Two triangles on one edge, a cluster each: vertices 0, 1, 2 and 0, 2, 3.
SceneSurface square() {
  SceneSurface scene;
  scene.surface = {{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {9, 9, 9}}, {{0, 1, 2}, {0, 2, 3}}};
  return scene;
}
Clusters one_each() {
  Clusters clusters;
  clusters.count = 2;
  clusters.of_face = Field<FaceId, std::uint32_t>(std::vector<std::uint32_t>{0, 1});
  return clusters;
}

TEST(LocalSaliency, IsAsTheFormulaSays) {
  const VertexField saliency(std::vector<float>{0.1f, 0.3f, 0.5f, 0.9f, 0.7f});
  const VertexField local = local_saliency(square(), saliency, one_each());
  // In the first min 0.1, max 0.5, mean 0.3; in the second 0.1, 0.9, 0.5.
  EXPECT_NEAR(local.values()[0], 0.5, 1e-6) << "0.3 there, 0.5 here";
  EXPECT_NEAR(local.values()[1], 0.5 + 0.3, 1e-6);
  EXPECT_NEAR(local.values()[2], 1.3, 1e-6) << "1 + 0.3 there, 0.5 + 0.5 here";
  EXPECT_NEAR(local.values()[3], 1.5, 1e-6);
  EXPECT_EQ(local.values()[4], 0) << "of no triangle";
}

TEST(LocalSaliency, WhereItIsTheSameEverywhereIsTheMean) {
  EXPECT_EQ(local_saliency(square(), VertexField(5, 0.25f), one_each()).values()[2], 0.25f);
}

TEST(LocalSaliency, OfAnotherSceneIsRefused) {
  test::expect_error([] { local_saliency(square(), VertexField(4), one_each()); }, ErrorKind::usage, "",
                     "another scene");
  Clusters wrong = one_each();
  wrong.count = 1;
  test::expect_error([&] { cluster_properties(square(), VertexField(5), wrong); }, ErrorKind::usage, "",
                     "another scene");
}

}  // namespace
}  // namespace fovea
