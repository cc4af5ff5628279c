#include "fovea/simplify/collapse_mesh.h"

#include <gtest/gtest.h>

#include <set>

#include "support/meshes.h"

namespace fovea {
namespace {

CollapseMesh make(const TriMesh& mesh) {
  CollapseMesh out;
  out.vertices.resize(mesh.vertex_count());
  for (const auto& t : mesh.triangles) {
    CollapseFace& f = out.faces.emplace_back();
    for (std::size_t k = 0; k < 3; ++k) f.vertex[k] = t[k].value;
  }
  out.link();
  return out;
}

TEST(CollapseMesh, RingsHoldEveryCornerOnce) {
  for (const test::NamedMesh& family : test::all_families()) {
    const CollapseMesh mesh = make(family.mesh);
    std::size_t corners = 0;
    for (std::uint32_t v = 0; v < mesh.vertices.size(); ++v) {
      std::set<std::uint32_t> seen;
      mesh.for_ring(v, [&](std::uint32_t c) {
        EXPECT_EQ(mesh.vertex(c), v) << family.name;
        EXPECT_TRUE(seen.insert(c).second) << family.name;
      });
      corners += seen.size();
    }
    EXPECT_EQ(corners, 3 * mesh.faces.size()) << family.name;
  }
}

TEST(CollapseMesh, EveryCornerKnowsTheEdgeToItsNext) {
  for (const auto& [name, source] : test::all_families()) {
    const CollapseMesh mesh = make(source);
    std::set<std::pair<std::uint32_t, std::uint32_t>> pairs;
    for (std::uint32_t c = 0; c < 3 * mesh.faces.size(); ++c) {
      const std::pair<std::uint32_t, std::uint32_t> ends =
          std::minmax({mesh.vertex(c), mesh.vertex(CollapseMesh::next(c))});
      pairs.insert(ends);
      const auto [v, w] = mesh.edges[mesh.edge(c)].ends;
      EXPECT_EQ(std::pair(v, w), std::pair(ends.first, ends.second)) << name;
    }
    EXPECT_EQ(mesh.edges.size(), pairs.size()) << name;
  }
}

TEST(CollapseMesh, UnlinkingEmptiesARing) {
  CollapseMesh mesh = make(test::single_triangle());
  mesh.unlink_corner(0);
  EXPECT_TRUE(mesh.ring(mesh.vertex(0)).empty());
  CollapseMesh fan = make(test::tetrahedron());
  std::vector<std::uint32_t> ring;
  fan.for_ring(0, [&](std::uint32_t c) { ring.push_back(c); });
  ASSERT_EQ(ring.size(), 3u);
  fan.unlink_corner(ring[1]);
  std::size_t left = 0;
  fan.for_ring(0, [&](std::uint32_t c) {
    EXPECT_NE(c, ring[1]);
    ++left;
  });
  EXPECT_EQ(left, 2u);
}

TEST(CollapseMesh, JoinedRingsHoldTheCornersOfBoth) {
  CollapseMesh mesh = make(test::icosphere(2));
  std::multiset<std::uint32_t> expected;
  const std::uint32_t to = 0;
  for (const std::uint32_t c : mesh.ring(to)) expected.insert(c);
  // One ring after the other goes to the same vertex, so that it outgrows its room again and again.
  for (std::uint32_t from = 1; from < 60; ++from) {
    for (const std::uint32_t c : mesh.ring(from)) expected.insert(c);
    mesh.join_rings(from, to);
    EXPECT_TRUE(mesh.ring(from).empty());
    const auto ring = mesh.ring(to);
    EXPECT_EQ(std::multiset<std::uint32_t>(ring.begin(), ring.end()), expected);
  }
  for (std::uint32_t v = 60; v < mesh.vertices.size(); ++v) {
    for (const std::uint32_t c : mesh.ring(v)) EXPECT_EQ(mesh.vertex(c), v);
  }
}

TEST(CollapseMesh, RingsKeepTheRoomOfCornersThatLeave) {
  CollapseMesh mesh = make(test::icosphere(3));
  const std::size_t corners = mesh.corners.size();
  const auto inside = [&](const CollapseEdge& e) {
    return mesh.ring(e.ends[0]).size() == 6 && mesh.ring(e.ends[1]).size() == 6;
  };
  const auto found = std::find_if(mesh.edges.begin(), mesh.edges.end(), inside);
  ASSERT_NE(found, mesh.edges.end());
  const auto [a, b] = found->ends;
  const EdgeCorners shared = mesh.edge_corners(static_cast<std::uint32_t>(found - mesh.edges.begin()), a);
  ASSERT_EQ(shared.count, 2u);
  for (std::size_t i = 0; i < shared.count; ++i) {
    for (const std::uint32_t c : shared.pairs[i]) mesh.unlink_corner(c);
  }
  mesh.join_rings(a, b);
  EXPECT_EQ(mesh.ring(b).size(), 8u);
  EXPECT_EQ(mesh.corners.size(), corners);
}

TEST(CollapseMesh, CountsFacesOnEdges) {
  const CollapseMesh mesh = make(test::non_manifold_edge());
  const auto edges_with = [&](std::uint32_t faces) {
    return std::count_if(mesh.edges.begin(), mesh.edges.end(),
                         [&](const CollapseEdge& e) { return e.face_count() == faces; });
  };
  EXPECT_EQ(edges_with(3), 1);
  EXPECT_EQ(edges_with(1), 6);
  EXPECT_EQ(mesh.edges.size(), 7u);
}

TEST(CollapseMesh, FindsComponents) {
  const FaceComponents two = find_components(make(test::tetrahedra(3)));
  ASSERT_EQ(two.count(), 3u);
  for (std::size_t i = 0; i < 3; ++i) EXPECT_EQ(two.first[i + 1] - two.first[i], 4u);
  EXPECT_EQ(find_components(make(test::bow_tie())).count(), 1u);
  EXPECT_EQ(find_components(make(test::empty_mesh())).count(), 0u);
}

}  // namespace
}  // namespace fovea
