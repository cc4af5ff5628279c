#include "fovea/surface/correspondence.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "fovea/io/read.h"
#include "fovea/surface/pose.h"
#include "support/meshes.h"
#include "support/reading.h"

namespace fovea {
namespace {

using Points = std::vector<Vec3f>;

//  3---4---5   vertex 6 is used by no triangle
//  | / | / |
//  0---1---2
Model strip(const Points& points, const std::vector<std::array<std::uint32_t, 3>>& triangles = {
                                      {0, 1, 4}, {0, 4, 3}, {1, 2, 5}, {1, 5, 4}}) {
  test::PartBuilder part(-1, false);
  for (const Vec3f& p : points) part.vertex(p);
  for (const auto& t : triangles) part.triangle(t[0], t[1], t[2]);
  return test::model_of(test::weld_part(part.part()));
}

const Points kFlat = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {0, 1, 0}, {1, 1, 0}, {2, 1, 0}, {9, 9, 9}};

Points bent() {
  Points points = kFlat;
  for (Vec3f& p : points) p.z = p.x * p.x;
  return points;
}

/// Where each corner of each triangle is.
Points corner_positions(const Surface& surface) {
  Points points;
  for (const auto& t : surface.triangles) {
    for (const std::uint32_t v : t) points.push_back(surface.positions[v]);
  }
  return points;
}

TEST(Correspondence, APoseTakesTheVerticesOfTheFirst) {
  const Points points = bent();
  const Surface surface = surfaces_in(strip(kFlat), strip(points))[0];
  EXPECT_EQ(corner_positions(surface),
            (Points{points[0], points[1], points[4], points[0], points[4], points[3], points[1], points[2],
                    points[5], points[1], points[5], points[4]}));
}

TEST(Correspondence, WhereAPoseWeldsMoreItHasItsTrianglesStill) {
  // Vertices 1 and 4 meet: two of the pose's triangles are gone and its vertices are numbered anew.
  Points points = bent();
  points[4] = points[1];
  const Model first = strip(kFlat), pose = strip(points);
  ASSERT_EQ(pose.meshes[0].surface.face_count(), 2u);
  const Surface surface = surfaces_in(first, pose)[0];
  EXPECT_EQ(surface.positions.size(), 6u);
  EXPECT_EQ(corner_positions(surface),
            (Points{points[0], points[1], points[4], points[0], points[4], points[3], points[1], points[2],
                    points[5], points[1], points[5], points[4]}));
}

TEST(Correspondence, WhereTheFirstWeldsMoreItsWeldingCounts) {
  Points points = kFlat;
  points[5] = points[2];
  const Points posed = bent();
  const Surface surface = surfaces_in(strip(points), strip(posed))[0];
  EXPECT_EQ(surface.positions.size(), 5u);
  // Of the two vertices that are one in the first pose, the earlier.
  EXPECT_EQ(corner_positions(surface), (Points{posed[0], posed[1], posed[4], posed[0], posed[4], posed[3],
                                               posed[1], posed[2], posed[4]}));
}

TEST(Correspondence, BothMayWeldOnTheirOwn) {
  Points first = kFlat, second = bent();
  first[5] = first[2];
  second[3] = second[0];
  EXPECT_NO_THROW(surfaces_in(strip(first), strip(second)));
  EXPECT_NO_THROW(surfaces_in(strip(second), strip(first)));
}

TEST(Correspondence, MeshesThatCameFromNoFileAreTheirOwnSource) {
  Model first = test::model_of(test::wavy_grid(4, 4, 0.1)), pose = test::model_of(test::wavy_grid(4, 4, 0.3));
  first.meshes[0].surface.source_vertex.clear();
  pose.meshes[0].surface.source_vertex.clear();
  EXPECT_EQ(surfaces_in(first, pose)[0].positions, pose.meshes[0].surface.positions);
}

TEST(Correspondence, PosesAreTakenAsTheyAreShown) {
  const Model first = test::skinned_model(4);
  Model pose = first;
  pose.nodes[2].rotation = {0, 0, std::sqrt(0.5), std::sqrt(0.5)};
  const Pose rest = rest_pose(pose);
  EXPECT_EQ(surfaces_in(first, pose)[0].positions,
            posed_surface(pose, rest, instances(pose, rest)[0]).positions);
  // Shown by no node: in its own space.
  pose.scenes[0].nodes = {};
  EXPECT_EQ(surfaces_in(first, pose)[0].positions, first.meshes[0].surface.positions);
}

TEST(Correspondence, TheFirstDifferenceIsNamed) {
  const Model first = strip(kFlat);
  const auto expect_difference = [&](const Model& pose, const std::string& message) {
    test::expect_error([&] { surfaces_in(first, pose); }, ErrorKind::unsupported, "mesh 0", message);
  };
  expect_difference(strip(Points(kFlat.begin(), kFlat.end() - 1)),
                    "there are 6 vertices but the first pose has 7");
  expect_difference(strip(kFlat, {{0, 1, 4}, {0, 4, 3}, {1, 2, 5}, {1, 5, 6}}),
                    "vertex 6 belongs to a triangle but to none in the first pose");
  expect_difference(strip(kFlat, {{0, 1, 4}, {0, 4, 3}, {1, 2, 5}}),
                    "there are 3 triangles but the first pose has 4");
  expect_difference(strip(kFlat, {{0, 1, 4}, {0, 4, 3}, {1, 2, 4}, {2, 5, 4}}),
                    "triangle 2 joins other vertices than in the first pose");
  test::expect_error(
      [&] {
        surfaces_in(first, test::model_of({test::cube(), test::cube()}));
      },
      ErrorKind::unsupported, "", "there are 2 meshes but the first pose has 1");
}

TEST(Correspondence, OfRealPoses) {
  struct Case {
    const char *first, *second;
    std::size_t triangles;
  };
  for (const Case& c :
       {Case{"cesiumman_walk/cesiumman_walk_00.ply", "cesiumman_walk/cesiumman_walk_05.ply", 4672},
        Case{"fox_run/fox_run_00.ply", "fox_run/fox_run_03.ply", 576},
        Case{"knight_run/knight_run_00.ply", "knight_run/knight_run_07.ply", 6952},
        Case{"cloth/cloth_01.glb", "cloth/cloth_02.ply", 115200},
        Case{"cylinder_bend/cylinder_bend_000.ply", "cylinder_bend/cylinder_bend_180.ply", 20304}}) {
    const auto first_path = test::corpus_file(std::string("poses/") + c.first),
               second_path = test::corpus_file(std::string("poses/") + c.second);
    if (!first_path) GTEST_SKIP() << "FOVEA_DATA is not set";
    Context context;
    const Model first = read_model(*first_path, {}, context), second = read_model(*second_path, {}, context);
    for (const auto& [a, b] : {std::pair(&first, &second), std::pair(&second, &first)}) {
      const std::vector<Surface> surfaces = surfaces_in(*a, *b);
      ASSERT_EQ(surfaces.size(), 1u);
      EXPECT_EQ(surfaces[0].triangles.size(), c.triangles) << c.second;
      EXPECT_NEAR(diagonal(surfaces[0]), bounds(*b).diagonal(), 1e-4 * bounds(*b).diagonal());
    }
  }
}

}  // namespace
}  // namespace fovea
