#include "fovea/simplify/legality.h"

#include <gtest/gtest.h>

#include "collapse_states.h"

namespace fovea {
namespace {

TEST(Legality, AnEdgeOfATetrahedronIsItsLast) {
  CollapseState state = test::state_of(test::tetrahedron());
  Legality legality(state);
  EXPECT_FALSE(legality.look_at(0, 1));
  EXPECT_EQ(legality.topology(), Block::last);
}

TEST(Legality, EveryEdgeOfASphereMayCollapse) {
  CollapseState state = test::state_of(test::icosphere(2));
  Legality legality(state);
  for (const CollapseEdge& edge : state.mesh.edges) {
    EXPECT_TRUE(legality.look_at(edge.ends[0], edge.ends[1]));
    EXPECT_EQ(legality.topology(), Block::none);
    EXPECT_FALSE(legality.leaves_scrap());
  }
}

TEST(Legality, AnInnerEdgeMustNotJoinTwoBoundaries) {
  // One column of quads: the rungs between are inner edges with both ends on the boundary.
  CollapseState state = test::state_of(test::grid(1, 4));
  Legality legality(state);
  const std::uint32_t left = test::vertex_at(state, {0, 0.5f, 0}),
                      right = test::vertex_at(state, {1, 0.5f, 0}),
                      above = test::vertex_at(state, {0, 0.75f, 0});
  EXPECT_FALSE(legality.look_at(left, right));
  EXPECT_EQ(legality.topology(), Block::topology);
  EXPECT_TRUE(legality.look_at(left, above));
}

TEST(Legality, ARingOfThreeEdgesDoesNotClose) {
  // Three around: the ends of an edge on a ring share the third vertex of it, which is across no
  // triangle of theirs.
  CollapseState state = test::state_of(test::open_cylinder(3, 4));
  Legality legality(state);
  std::vector<std::uint32_t> middle;
  for (std::uint32_t v = 0; v < state.mesh.vertices.size(); ++v) {
    if (std::abs(state.mesh.vertices[v].position.z) < 1e-6) middle.push_back(v);
  }
  ASSERT_EQ(middle.size(), 3u);
  EXPECT_FALSE(legality.look_at(middle[0], middle[1]));
  EXPECT_EQ(legality.topology(), Block::topology);
}

TEST(Legality, OneTriangleOfThreeIsAScrap) {
  test::PartBuilder part;
  const std::uint32_t centre = part.vertex({0, 0, 0}, {0, 0}), x = part.vertex({1, 0, 0}, {1, 0}),
                      y = part.vertex({0, 1, 0}, {0, 1}), z = part.vertex({0, 0, 1}, {1, 1});
  part.triangle(centre, x, y);
  part.triangle(centre, y, z);
  part.triangle(centre, z, x);
  CollapseState fan = test::state_of(test::weld_part(part.part()));
  Legality legality(fan);
  legality.look_at(test::vertex_at(fan, {0, 0, 0}), test::vertex_at(fan, {1, 0, 0}));
  EXPECT_TRUE(legality.leaves_scrap());
}

TEST(Legality, ATriangleMustNotTurnOver) {
  CollapseState state = test::state_of(test::grid(4, 4));
  Legality legality(state);
  const std::uint32_t a = test::vertex_at(state, {0.5f, 0.5f, 0}),
                      b = test::vertex_at(state, {0.75f, 0.5f, 0});
  legality.look_at(a, b);
  EXPECT_TRUE(legality.shape(state.slots[0].to_engine({0.6f, 0.5f, 0})));
  EXPECT_FALSE(legality.shape(state.slots[0].to_engine({0.1f, 0.5f, 0})));  // beyond the neighbours
  EXPECT_FALSE(legality.shape(state.slots[0].to_engine({0.6f, 0.5f, 3})));  // steep walls
}

TEST(Legality, ATriangleMustNotTurnOverInTheTexture) {
  // A flat hexagon around the edge a–b; in the texture b lies far below the others.
  test::PartBuilder part;
  const std::uint32_t a = part.vertex({0, 0, 0}, {0, 0}), b = part.vertex({1, 0, 0}, {1, -5});
  const std::uint32_t left = part.vertex({-1, 0, 0}, {-0.1f, 0}), right = part.vertex({2, 0, 0}, {2, 0});
  const std::uint32_t top = part.vertex({0.5f, 1, 0}, {-2, 1}),
                      bottom = part.vertex({0.5f, -1, 0}, {0.5f, -9});
  part.triangle(a, b, top);
  part.triangle(b, a, bottom);
  part.triangle(left, a, top);
  part.triangle(a, left, bottom);
  part.triangle(b, right, top);
  part.triangle(right, b, bottom);
  SimplifyOptions options;
  options.uv_weight = 0;  // values are mixed along the edge
  CollapseState state = test::state_of(test::weld_part(part.part()), options);
  Legality legality(state);
  const std::uint32_t at_a = test::vertex_at(state, {0, 0, 0}), at_b = test::vertex_at(state, {1, 0, 0});
  ValueMerge merge(state, Placement::optimal);
  legality.look_at(at_a, at_b);
  const std::uint32_t edge = test::edge_between(state, at_a, at_b);
  merge.plan(edge, at_a, at_b, state.mesh.position(at_a));
  EXPECT_TRUE(legality.texture(merge));
  merge.plan(edge, at_a, at_b, state.mesh.position(at_b));
  EXPECT_FALSE(legality.texture(merge));
}

/// A sheet with an ear at its left end, and a strap from its lower corners to a triangle of its own below.
TriMesh sheet_with_ear_and_strap() {
  test::PartBuilder part;
  const std::uint32_t a = part.vertex({0, 0, 0}, {0, 0}), b = part.vertex({1, 0, 0}, {1, 0}),
                      c = part.vertex({1, 1, 0}, {1, 1}), d = part.vertex({0, 1, 0}, {0, 1}),
                      ear = part.vertex({-1, 0.5f, 0}, {-1, 0.5f}),
                      low = part.vertex({0.5f, -1, 0}, {0.5f, -1}), left = part.vertex({0, -2, 0}, {0, -2}),
                      right = part.vertex({1, -2, 0}, {1, -2});
  part.quad(a, b, c, d);
  part.triangle(a, d, ear);
  part.triangle(a, low, b);
  part.triangle(low, left, right);
  return test::weld_part(part.part());
}

TEST(Legality, ALockedVertexKeepsItsLastTriangle) {
  CollapseState state = test::state_of(sheet_with_ear_and_strap());
  Legality legality(state);
  const std::uint32_t a = test::vertex_at(state, {0, 0, 0}), d = test::vertex_at(state, {0, 1, 0}),
                      ear = test::vertex_at(state, {-1, 0.5f, 0});
  legality.look_at(a, d);
  EXPECT_FALSE(legality.loses_locked());
  state.mesh.vertices[ear].locked = 1;
  EXPECT_TRUE(legality.loses_locked());
  EXPECT_FALSE(legality.cuts_strap()) << "an ear may shrink";
}

TEST(Legality, AStrapIsCutWithItsOnlyTriangle) {
  CollapseState state = test::state_of(sheet_with_ear_and_strap());
  Legality legality(state);
  legality.look_at(test::vertex_at(state, {0, 0, 0}), test::vertex_at(state, {1, 0, 0}));
  EXPECT_TRUE(legality.cuts_strap());
  legality.look_at(test::vertex_at(state, {1, 0, 0}), test::vertex_at(state, {1, 1, 0}));
  EXPECT_FALSE(legality.cuts_strap());
}

}  // namespace
}  // namespace fovea
