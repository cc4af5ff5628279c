#include "fovea/surface/half_edges.h"

#include <gtest/gtest.h>

#include "support/meshes.h"

namespace fovea {
namespace {

TEST(HalfEdges, ThoseOfAnEdgeAreTogether) {
  const TriMesh mesh = test::tetrahedron();
  std::size_t edges = 0;
  for_each_edge(sorted_half_edges(mesh.triangles), [&](std::span<const HalfEdge> edge) {
    ++edges;
    ASSERT_EQ(edge.size(), 2u);
    EXPECT_NE(edge[0].forward, edge[1].forward);
    EXPECT_LT(edge[0].corner, edge[1].corner);
    for (const HalfEdge& half : edge) {
      EXPECT_EQ(half.triangle(), half.corner / 3);
      EXPECT_EQ(mesh.vertex(CornerId{half.low_corner()}).value, half.ends >> 32);
      EXPECT_EQ(mesh.vertex(CornerId{half.high_corner()}).value, half.ends & 0xFFFFFFFF);
    }
  });
  EXPECT_EQ(edges, 6u);
}

}  // namespace
}  // namespace fovea
