#include "fovea/surface/topology.h"

#include <gtest/gtest.h>

#include <cstdint>

#include "support/meshes.h"

namespace fovea::test {
namespace {

/// V - E + F: 2 per closed component without handles, 1 per disc, 0 per torus or open cylinder.
std::int64_t euler(const TriMesh& mesh) {
  return static_cast<std::int64_t>(mesh.vertex_count() + mesh.face_count()) -
         static_cast<std::int64_t>(count_edges(mesh).total);
}

void expect_edges(const EdgeCounts& c, std::uint64_t boundary, std::uint64_t interior,
                  std::uint64_t non_manifold) {
  EXPECT_EQ(c.boundary, boundary);
  EXPECT_EQ(c.interior, interior);
  EXPECT_EQ(c.non_manifold, non_manifold);
}

TEST(Edges, EmptyMeshHasNone) { EXPECT_EQ(count_edges(empty_mesh()).total, 0u); }

TEST(Edges, SingleTriangleIsAllBoundary) { expect_edges(count_edges(single_triangle()), 3, 0, 0); }

TEST(Edges, TetrahedronIsClosed) {
  const EdgeCounts c = count_edges(tetrahedron());
  expect_edges(c, 0, 6, 0);
  EXPECT_EQ(c.seam, 0u);
}

TEST(Edges, CubeHasASeamOnEachOfItsEdgesAndOnNoDiagonal) {
  const EdgeCounts c = count_edges(cube());
  expect_edges(c, 0, 18, 0);
  EXPECT_EQ(c.seam, 12u);
}

TEST(Edges, GridCountsItsRim) {
  // 4 columns, 3 rows: 4·4 + 5·3 straight edges and 12 diagonals, of which the rim is 2 (4 + 3).
  const EdgeCounts c = count_edges(grid(4, 3));
  EXPECT_EQ(c.total, 43u);
  expect_edges(c, 14, 29, 0);
  EXPECT_EQ(c.seam + c.part_border, 0u);
}

TEST(Edges, CylinderSeamIsALine) { EXPECT_EQ(count_edges(open_cylinder(12, 5)).seam, 5u); }

TEST(Edges, TorusHasTwoSeamLoops) { EXPECT_EQ(count_edges(torus(12, 8)).seam, 20u); }

TEST(Edges, MirroredTextureIsASeam) { EXPECT_EQ(count_edges(mirrored_strip(3)).seam, 1u); }

TEST(Edges, PartBorderIsNoSeamWhenValuesAgree) {
  const EdgeCounts c = count_edges(two_part_grid(4, 3));
  EXPECT_EQ(c.part_border, 3u);
  EXPECT_EQ(c.seam, 0u);
}

TEST(Edges, LayerThatOnePartLacksIsASeamAtTheBorder) {
  PartBuilder left, right(-1, false);
  for (PartBuilder* builder : {&left, &right}) {
    const float x = builder == &left ? -1.0f : 1.0f;
    builder->vertex({0, 0, 0});
    builder->vertex({0, 1, 0});
    builder->vertex({x, 0, 0});
  }
  left.triangle(0, 1, 2);
  right.triangle(1, 0, 2);
  const EdgeCounts c = count_edges(weld_parts({left.part(), right.part()}));
  EXPECT_EQ(c.part_border, 1u);
  EXPECT_EQ(c.seam, 1u);
}

TEST(Edges, NonManifoldFamilies) {
  expect_edges(count_edges(non_manifold_edge()), 6, 0, 1);
  expect_edges(count_edges(inconsistent_edge()), 4, 0, 1);
  expect_edges(count_edges(duplicate_faces()), 0, 0, 3);
  expect_edges(count_edges(two_sided_triangle()), 0, 3, 0);
}

TEST(Edges, KindsAddUpOnEveryFamily) {
  for (const auto& [name, mesh] : all_families()) {
    const EdgeCounts c = count_edges(mesh);
    EXPECT_EQ(c.total, c.boundary + c.interior + c.non_manifold) << name;
    EXPECT_LE(c.seam, c.interior) << name;
  }
}

TEST(Edges, EulerNumbers) {
  EXPECT_EQ(euler(icosphere(2)), 2);
  EXPECT_EQ(euler(cube()), 2);
  EXPECT_EQ(euler(torus(9, 7)), 0);
  EXPECT_EQ(euler(open_cylinder(9, 2)), 0);
  EXPECT_EQ(euler(grid(5, 5)), 1);
  EXPECT_EQ(euler(tetrahedra(3)), 6);
}

TEST(Components, AreNumberedByFirstFace) {
  const Components c = components(tetrahedra(3));
  ASSERT_EQ(c.count, 3u);
  for (std::size_t f = 0; f < 12; ++f) EXPECT_EQ(c.of_face[FaceId{f}], f / 4);
}

TEST(Components, MeetThroughASingleVertex) { EXPECT_EQ(components(bow_tie()).count, 1u); }

TEST(Components, MeetAcrossSeamsAndParts) {
  EXPECT_EQ(components(cube()).count, 1u);
  EXPECT_EQ(components(two_part_grid(4, 2)).count, 1u);
}

TEST(Components, EmptyMeshHasNone) { EXPECT_EQ(components(empty_mesh()).count, 0u); }

TEST(BowTies, OneVertexWithTwoFans) { EXPECT_EQ(count_bow_ties(bow_tie()), 1u); }

TEST(BowTies, NotWhereTrianglesShareAnEdgeOfAnyKind) {
  for (const auto& [name, mesh] : all_families()) {
    EXPECT_EQ(count_bow_ties(mesh), name == "bow_tie" ? 1u : 0u) << name;
  }
}

}  // namespace
}  // namespace fovea::test
