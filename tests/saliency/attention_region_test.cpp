#include "fovea/saliency/attention_region.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "support/meshes.h"

namespace fovea {
namespace {

Box box_of(Vec3d a, Vec3d b) {
  Box box;
  box.add(a);
  box.add(b);
  return box;
}

std::vector<VertexField> attended(const Model& model, const AttentionRegions& regions) {
  std::vector<VertexField> shares;
  for (const Mesh& mesh : model.meshes) shares.emplace_back(mesh.surface.vertex_count(), 1.0f);
  attend_regions(model, rest_pose(model), regions, 0.25f, shares);
  return shares;
}

TEST(AttentionRegion, FindsTrianglesWithoutACornerInside) {
  const Vec3d a{0, 0, 0}, b{1, 0, 0}, c{0, 1, 0};
  const auto in_sphere = [&](Vec3d center, double radius) {
    return reaches_into(AttentionRegions{{{center, radius}}, {}}, a, b, c);
  };
  EXPECT_TRUE(in_sphere({0.3, 0.3, 0.1}, 0.11));  // over its middle
  EXPECT_FALSE(in_sphere({0.3, 0.3, 0.1}, 0.09));
  EXPECT_TRUE(in_sphere({0.5, -0.1, 0}, 0.11));  // beside an edge
  EXPECT_FALSE(in_sphere({0.6, 0.6, 0}, 0.14));  // 0.2 / √2 from the long edge
  EXPECT_TRUE(in_sphere({0.6, 0.6, 0}, 0.15));
  const auto in_box = [&](Vec3d low, Vec3d high) {
    return reaches_into(AttentionRegions{{}, {box_of(low, high)}}, a, b, c);
  };
  EXPECT_TRUE(in_box({0.2, 0.2, -1}, {0.3, 0.3, 1}));     // pierced
  EXPECT_TRUE(in_box({-1, 0.4, -1}, {2, 0.5, 1}));        // cut across
  EXPECT_TRUE(in_box({-1, -1, -1}, {2, 2, 2}));           // all of it
  EXPECT_TRUE(in_box({0.2, 0.2, 0}, {0.3, 0.3, 1}));      // touched
  EXPECT_FALSE(in_box({0.2, 0.2, 0.01}, {0.3, 0.3, 1}));  // above
  EXPECT_FALSE(in_box({0.6, 0.6, -1}, {1, 1, 1}));        // in its own box, but beyond the long edge
  EXPECT_FALSE(in_box({1.01, -1, -1}, {2, 2, 2}));
}

TEST(AttentionRegion, IsAsAnyInstanceShowsTheMesh) {
  // A grid from (0, 0) to (1, 1), shown once more three to the right.
  Model model = test::model_of(test::grid(4, 4));
  Node other = model.nodes[0];
  other.translation = {3, 0, 0};
  model.scenes[0].nodes.push_back(static_cast<int>(model.nodes.size()));
  model.nodes.push_back(other);
  const VertexField shares = attended(model, {{{{3, 0, 0}, 0.1}}, {}})[0];
  const std::vector<Vec3f>& positions = model.meshes[0].surface.positions;
  for (std::uint32_t v = 0; v < positions.size(); ++v) {
    const bool at_corner = positions[v].x < 0.3f && positions[v].y < 0.3f;
    EXPECT_EQ(shares[VertexId{v}], at_corner ? 0.25f : 1.0f) << v;
  }
}

TEST(AttentionRegion, LessStays) {
  const Model model = test::model_of(test::grid(4, 4));
  std::vector<VertexField> shares{VertexField(model.meshes[0].surface.vertex_count(), 0.1f)};
  const AttentionRegions everything{{}, {box_of({-1, -1, -1}, {2, 2, 2})}};
  EXPECT_EQ(attend_regions(model, rest_pose(model), everything, 0.25f, shares), 32u);
  for (const float share : shares[0].values()) EXPECT_EQ(share, 0.1f);
}

}  // namespace
}  // namespace fovea
