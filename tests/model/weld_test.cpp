#include "fovea/model/weld.h"

#include <gtest/gtest.h>

#include "support/meshes.h"

namespace fovea::test {
namespace {

/// The corner 0 0, 1 0, 0 1 of the plane z = 0 and, for tests to use, a second vertex on 1 0.
PartBuilder corner_part(int material = -1) {
  PartBuilder builder(material);
  builder.vertex({0, 0, 0}, {0, 0});
  builder.vertex({1, 0, 0}, {1, 0});
  builder.vertex({0, 1, 0}, {0, 1});
  builder.vertex({1, 0, 0}, {0.5f, 0});
  return builder;
}

TEST(Weld, DropsTrianglesThatUseAPointTwiceAndSaysHowMany) {
  Context context;
  const SplitPart part = degenerate_part();
  const TriMesh mesh = weld({&part, 1}, context, "file/meshes/0");
  EXPECT_EQ(mesh.face_count(), 1u);
  ASSERT_EQ(context.diagnostics().size(), 1u);
  EXPECT_EQ(context.diagnostics()[0].code, "degenerate-triangles");
  EXPECT_EQ(context.diagnostics()[0].place, "file/meshes/0");
  EXPECT_EQ(context.diagnostics()[0].count, 2u);
}

TEST(Weld, KeepsBothSidesOfASheet) {
  PartBuilder builder = corner_part();
  builder.triangle(0, 1, 2);
  builder.triangle(2, 1, 0);
  const TriMesh mesh = weld_part(builder.part());
  EXPECT_EQ(mesh.face_count(), 2u);
  EXPECT_EQ(mesh.vertex_count(), 3u);
}

TEST(Weld, KeepsADecalOverTheSameTriangle) {
  PartBuilder ground = corner_part(0), decal = corner_part(1);
  ground.triangle(0, 1, 2);
  decal.triangle(0, 1, 2);
  const TriMesh mesh = weld_parts({ground.part(), decal.part()});
  EXPECT_EQ(mesh.face_part, (std::vector<std::uint32_t>{0, 1}));
  EXPECT_EQ(mesh.vertex_count(), 3u);
}

TEST(Weld, KeepsATriangleTwiceInOnePart) {
  PartBuilder builder = corner_part();
  builder.triangle(0, 1, 2);
  builder.triangle(0, 3, 2);  // other texture coordinates: what shows is the viewer's choice
  EXPECT_EQ(weld_part(builder.part()).face_count(), 2u);
}

TEST(Weld, KeepsTrianglesThatAreThinButNotAPoint) {
  PartBuilder builder = corner_part();
  const std::uint32_t middle = builder.vertex({0.5f, 0, 0});
  builder.triangle(0, middle, 1);  // in a line: it closes a T-junction
  EXPECT_EQ(weld_part(builder.part()).face_count(), 1u);
}

//   2
//   | \          3 lies on 1 until the target takes it away
//   0--1=3
TEST(Weld, KeepsTrianglesThatAMorphTargetOpens) {
  PartBuilder builder = corner_part();
  builder.triangle(0, 1, 2);
  builder.triangle(1, 3, 2);
  EXPECT_EQ(weld_part(builder.part()).face_count(), 1u);
  builder.part().position_morphs = {{{}, {}, {}, {0, 0, 1}}};
  builder.part().attribute_morphs.resize(1);
  const TriMesh mesh = weld_part(builder.part());
  EXPECT_EQ(mesh.face_count(), 2u);
  EXPECT_EQ(mesh.vertex_count(), 4u);
}

}  // namespace
}  // namespace fovea::test
