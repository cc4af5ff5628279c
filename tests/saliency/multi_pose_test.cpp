#include "fovea/saliency/multi_pose.h"

#include <gtest/gtest.h>

#include <optional>
#include <string>

#include "fovea/base/random.h"
#include "fovea/io/read.h"
#include "fovea/saliency/mesh_saliency.h"
#include "fovea/surface/correspondence.h"
#include "oracle/saliency_oracle.h"
#include "support/reading.h"

namespace fovea {
namespace {

VertexField field(std::vector<float> values) { return VertexField(std::move(values)); }

TEST(MultiPose, AddsWhatPosesAreAboveTheLeast) {
  const std::vector<VertexField> poses = {field({1, 5, 0}), field({3, 5, 0}), field({2, 5, 4})};
  EXPECT_EQ(multi_pose_base(poses), field({1, 5, 0}));
  EXPECT_EQ(multi_pose_saliency(poses), field({4, 5, 4}));  // 1 + (0 + 2 + 1), 5 + 0, 0 + 4
}

TEST(MultiPose, OfOnePoseIsThatPoses) {
  const std::vector<VertexField> poses = {field({1, 5, 0.25f})};
  EXPECT_EQ(multi_pose_base(poses), poses[0]);
  EXPECT_EQ(multi_pose_saliency(poses), poses[0]);
}

TEST(MultiPose, EqualsTheFormula) {
  Random random(4);
  for (const std::size_t count : {2u, 3u, 8u}) {
    std::vector<VertexField> poses(count, VertexField(500));
    for (VertexField& pose : poses) {
      for (float& x : pose.values()) x = static_cast<float>(random.uniform(0, 3));
    }
    const VertexField found = multi_pose_saliency(poses), expected = test::multi_pose_saliency(poses);
    for (std::size_t v = 0; v < found.size(); ++v) EXPECT_NEAR(found.values()[v], expected.values()[v], 1e-5);
  }
}

TEST(MultiPose, TheOrderOfPosesDoesNotMatter) {
  const VertexField a = field({1, 5, 0}), b = field({3, 2, 0}), c = field({2, 7, 4});
  EXPECT_EQ(multi_pose_saliency(std::vector{a, b, c}), multi_pose_saliency(std::vector{c, a, b}));
}

TEST(MultiPose, PosesMustFit) {
  test::expect_error([] { multi_pose_saliency({}); }, ErrorKind::usage, "", "no poses");
  const std::vector<VertexField> poses = {field({1, 2}), field({1, 2}), field({1, 2, 3})};
  test::expect_error([&] { multi_pose_saliency(poses); }, ErrorKind::usage, "",
                     "pose 2 has 3 values but the first has 2");
  EXPECT_TRUE(multi_pose_saliency(std::vector{VertexField()}).empty());
}

/// The mean over the vertices of a mesh whose height is between two fractions of its own.
double mean_between(const VertexField& saliency, const TriMesh& mesh, double low, double high) {
  const Box box = bounds(mesh);
  double sum = 0;
  int count = 0;
  for (std::size_t v = 0; v < mesh.vertex_count(); ++v) {
    const double height = (static_cast<double>(mesh.positions[v].y) - box.low.y) / (box.high.y - box.low.y);
    if (height < low || height > high) continue;
    sum += static_cast<double>(saliency.values()[v]);
    ++count;
  }
  return sum / count;
}

TEST(MultiPose, WhereACylinderBendsStandsOut) {
  Context context;
  std::optional<Model> straight;
  std::vector<VertexField> poses;
  for (const char* angle_deg : {"000", "060", "120", "180"}) {
    const auto path =
        test::corpus_file(std::string("poses/cylinder_bend/cylinder_bend_") + angle_deg + ".ply");
    if (!path) GTEST_SKIP() << "FOVEA_DATA is not set";
    const Model pose = read_model(*path, {}, context);
    if (!straight) straight = pose;
    poses.push_back(mesh_saliency(surfaces_in(*straight, pose)[0], {}, context).saliency);
  }
  // Its middle bends; the rims stand out in any pose.
  const TriMesh& mesh = straight->meshes[0].surface;
  const VertexField all = multi_pose_saliency(poses);
  EXPECT_LT(mean_between(poses[0], mesh, 0.3, 0.7), 2 * mean_between(poses[0], mesh, 0.1, 0.2));
  EXPECT_GT(mean_between(all, mesh, 0.3, 0.7), 5 * mean_between(all, mesh, 0.1, 0.2));
}

}  // namespace
}  // namespace fovea
