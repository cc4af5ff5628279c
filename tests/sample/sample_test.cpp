#include "fovea/sample/sample.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <string>

#include "fovea/base/error.h"
#include "fovea/io/image_codec.h"
#include "fovea/surface/topology.h"

namespace fovea {
namespace {

struct Expected {
  std::string name;
  std::uint64_t fewest, most;  ///< Triangles at detail 1, as promised.
  std::uint32_t components;
  bool closed, seams;
};
std::ostream& operator<<(std::ostream& out, const Expected& e) { return out << e.name; }

const Expected kExpected[] = {{"vase", 40'000, 60'000, 3, true, true},
                              {"arm", 20'000, 40'000, 6, true, true},
                              {"spheres", 38'000, 42'000, 2, true, true},
                              {"terrain", 90'000, 99'000, 1, true, true}};

class Samples : public testing::TestWithParam<Expected> {};

void expect_unit_normals(const TriMesh& mesh) {
  const AttributeLayer* normals = mesh.find(Semantic::normal);
  ASSERT_NE(normals, nullptr);
  for (std::size_t i = 0; i < normals->size(); ++i) {
    const float* n = normals->value(ValueId{i});
    // Floats rounded from a unit vector of doubles.
    ASSERT_NEAR(length(Vec3f{n[0], n[1], n[2]}), 1.0f, 1e-6f);
  }
}

void expect_uvs_inside_of_the_image(const TriMesh& mesh) {
  const AttributeLayer* uvs = mesh.find(Semantic::uv);
  ASSERT_NE(uvs, nullptr);
  const auto [low, high] = std::minmax_element(uvs->values.begin(), uvs->values.end());
  EXPECT_GE(*low, 0.0f);
  EXPECT_LE(*high, 1.0f);
}

void expect_textures_decode(const Model& model) {
  ASSERT_FALSE(model.images.empty());
  for (const EncodedImage& image : model.images) {
    EXPECT_EQ(image_info(image.bytes).mime_type, image.mime_type);
    EXPECT_GE(decode_image(image.bytes).width, 1024);
  }
  for (const Material& material : model.materials) EXPECT_TRUE(material.base_color.has_value());
}

/// Everything that a file would hold, but the order of its keys.
bool same(const Model& a, const Model& b) {
  const TriMesh &m = a.meshes[0].surface, &n = b.meshes[0].surface;
  bool equal = m.positions == n.positions && m.triangles == n.triangles && a.images == b.images &&
               m.position_morphs == n.position_morphs && m.layers.size() == n.layers.size();
  for (std::size_t i = 0; equal && i < m.layers.size(); ++i) equal = m.layers[i].values == n.layers[i].values;
  return equal;
}

TEST_P(Samples, AreSoundAndAsPromised) {
  const Expected& expected = GetParam();
  Context context;
  const Model model = make_sample(expected.name, 1, context);
  EXPECT_TRUE(context.diagnostics().empty()) << "nothing had to be repaired";
  ASSERT_EQ(model.meshes.size(), 1u);
  const TriMesh& mesh = model.meshes[0].surface;
  EXPECT_NO_THROW(check(mesh));
  EXPECT_GE(mesh.face_count(), expected.fewest);
  EXPECT_LE(mesh.face_count(), expected.most);
  EXPECT_EQ(components(mesh).count, expected.components);
  EXPECT_EQ(count_bow_ties(mesh), 0u);
  const EdgeCounts edges = count_edges(mesh);
  EXPECT_EQ(edges.non_manifold, 0u);
  EXPECT_EQ(edges.boundary == 0, expected.closed);
  EXPECT_EQ(edges.seam > 0, expected.seams);
  expect_unit_normals(mesh);
  expect_uvs_inside_of_the_image(mesh);
  expect_textures_decode(model);
}

TEST_P(Samples, AreTheSameForAnyNumberOfThreads) {
  Context one, four;
  one.threads = 1;
  four.threads = 4;
  EXPECT_TRUE(same(make_sample(GetParam().name, 0.02, one), make_sample(GetParam().name, 0.02, four)));
}

INSTANTIATE_TEST_SUITE_P(All, Samples, testing::ValuesIn(kExpected),
                         [](const auto& sample) { return sample.param.name; });

TEST(Sample, ListNamesWhatCanBeMade) {
  ASSERT_EQ(samples().size(), std::size(kExpected));
  for (std::size_t i = 0; i < samples().size(); ++i) {
    EXPECT_EQ(samples()[i].name, kExpected[i].name);
    EXPECT_FALSE(samples()[i].description.empty());
  }
}

TEST(Sample, DetailScalesTheTriangles) {
  Context context;
  const auto few = static_cast<double>(make_sample("vase", 0.1, context).meshes[0].surface.face_count());
  const auto many = static_cast<double>(make_sample("vase", 0.4, context).meshes[0].surface.face_count());
  // Columns and rows are rounded to whole numbers, the fewest of them (a lip of 3 rows) by a fifth.
  EXPECT_NEAR(many / few, 4.0, 0.4);
}

TEST(Sample, SeedChangesTheTerrain) {
  Context a, b;
  b.seed = 2;
  EXPECT_FALSE(same(make_sample("terrain", 0.01, a), make_sample("terrain", 0.01, b)));
}

TEST(Sample, UnknownNameIsAUsageErrorWithTheNearest) {
  Context context;
  try {
    make_sample("terain", 1, context);
    FAIL() << "must throw";
  } catch (const Error& e) {
    EXPECT_EQ(e.kind(), ErrorKind::usage);
    EXPECT_NE(e.message().find("terain"), std::string::npos);
    EXPECT_NE(e.hint().find("'terrain'"), std::string::npos);
  }
  try {
    make_sample("teapot-with-lid", 1, context);
    FAIL() << "must throw";
  } catch (const Error& e) {
    EXPECT_NE(e.hint().find("vase, arm"), std::string::npos) << "lists them all if none is near";
  }
}

TEST(Sample, DetailOutOfRangeIsAUsageError) {
  Context context;
  for (const double detail : {0.0, -1.0, 1e9, std::numeric_limits<double>::quiet_NaN()}) {
    EXPECT_THROW(make_sample("vase", detail, context), Error) << detail;
  }
}

TEST(Sample, CanBeCancelled) {
  Context context;
  context.cancel();
  EXPECT_THROW(make_sample("arm", 0.01, context), Error);
}

TEST(Arm, WeightsAreCompleteAndJointsInOrder) {
  Context context;
  const Model model = make_sample("arm", 0.1, context);
  ASSERT_EQ(model.skins.size(), 1u);
  ASSERT_EQ(model.skins[0].joints.size(), 3u);
  ASSERT_TRUE(model.skins[0].inverse_bind.has_value());
  EXPECT_EQ(model.skins[0].inverse_bind->count, 3u);
  EXPECT_EQ(model.nodes[0].skin, 0);
  const TriMesh& mesh = model.meshes[0].surface;
  const AttributeLayer *joints = mesh.find(Semantic::joints), *weights = mesh.find(Semantic::weights);
  ASSERT_NE(joints, nullptr);
  ASSERT_NE(weights, nullptr);
  ASSERT_EQ(joints->size(), weights->size());
  bool used[3] = {false, false, false};
  for (std::size_t i = 0; i < weights->size(); ++i) {
    const float *j = joints->value(ValueId{i}), *w = weights->value(ValueId{i});
    ASSERT_EQ(w[0] + w[1], 1.0f);
    for (int k = 0; k < 2; ++k) {
      ASSERT_GE(w[k], 0.0f);
      if (w[k] > 0) used[static_cast<int>(j[k])] = true;
      ASSERT_TRUE(w[k] > 0 || j[k] == 0.0f) << "glTF: a joint without weight is joint 0";
    }
  }
  EXPECT_TRUE(used[0] && used[1] && used[2]);
}

TEST(Arm, ElbowBendsTo120DegreesAndBack) {
  Context context;
  const Model model = make_sample("arm", 0.01, context);
  ASSERT_EQ(model.animations.size(), 1u);
  const Animation& bend = model.animations[0];
  EXPECT_EQ(bend.channels[0].path, "rotation");
  EXPECT_EQ(model.nodes[static_cast<std::size_t>(bend.channels[0].node)].name, "elbow");
  const std::vector<float> q = bend.samplers[0].output.to_floats();
  double most = 0;
  for (std::size_t i = 0; i + 3 < q.size(); i += 4) most = std::max(most, 2.0 * std::acos(q[i + 3]));
  // acos of a float.
  EXPECT_NEAR(most, 120 * std::numbers::pi / 180, 1e-6);
  EXPECT_EQ(q[3], 1.0f);
  EXPECT_NEAR(q[q.size() - 1], 1.0f, 1e-7f);
}

TEST(Spheres, LieAHundredthOfTheRadiusApartMorphedOrNot) {
  Context context;
  const Model model = make_sample("spheres", 1, context);
  const TriMesh& mesh = model.meshes[0].surface;
  ASSERT_EQ(mesh.target_count(), 1u);
  ASSERT_NE(mesh.find(Semantic::normal), nullptr);
  ASSERT_EQ(mesh.find(Semantic::normal)->morphs.size(), 1u);
  double left = -9, right = 9, right_morphed = 9, moved = 0;
  for (std::size_t v = 0; v < mesh.vertex_count(); ++v) {
    const Vec3f p = mesh.positions[v], d = mesh.position_morphs[0][v];
    if (p.x < 0) {
      left = std::max<double>(left, p.x);
      EXPECT_EQ(d, Vec3f()) << "the left sphere stays";
    } else {
      right = std::min<double>(right, p.x);
      right_morphed = std::min<double>(right_morphed, p.x + d.x);
      moved = std::max<double>(moved, length(d));
    }
  }
  // No vertex lies exactly on the axis (41 quads are odd): a quarter of a quad away the sphere has
  // receded by less than 4e-4 on either side.
  EXPECT_NEAR(right - left, 0.01, 1e-3);
  EXPECT_GE(right_morphed, right - 1e-3);  // bumps rise to less than half of the room before them
  EXPECT_GT(moved, 0.15);
}

}  // namespace
}  // namespace fovea
