#include "fovea/simplify/collapse_state.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <vector>

#include "collapse_states.h"
#include "support/by_quadrics.h"

namespace fovea {
namespace {

/// Whatever the order inside, the engine works on the mesh's own triangles and values.
TEST(CollapseState, TheEngineKnowsWhereThingsAreInTheirMesh) {
  const TriMesh one = test::shuffled(test::two_part_grid(48, 48)),
                two = test::shuffled(test::morph_strip(1500));
  const TriMesh* const meshes[] = {&one, &two};
  const double scales[] = {1, 1};
  const VertexField* const importance[] = {nullptr, nullptr};
  const CollapseState state = make_collapse_state(meshes, scales, importance, {}, 1.0, {}, {});
  ASSERT_EQ(state.mesh.faces.size(), one.face_count() + two.face_count());
  EXPECT_FALSE(state.mesh_face[0] == FaceId{0} && state.mesh_face[1] == FaceId{1}) << "nothing was moved";
  for (std::uint32_t f = 0; f < state.mesh.faces.size(); ++f) {
    const std::uint32_t m = state.slot_of_face(f);
    const FaceId face = state.mesh_face[f];
    for (int k = 0; k < 3; ++k) {
      const std::uint32_t c = 3 * f + static_cast<std::uint32_t>(k), v = state.mesh.vertex(c);
      ASSERT_EQ(state.mesh_vertex[v], meshes[m]->vertex(corner(face, k)));
      const Vec3d p(meshes[m]->positions[state.mesh_vertex[v].index()]);
      // The engine keeps floats around the mesh's centre.
      EXPECT_LT(length(Vec3d(state.slots[m].to_local(state.mesh.position(v))) - p), 1e-6);
      for (const Channel& channel : state.channels) {
        if (channel.slices[m].empty()) {
          EXPECT_EQ(channel.corner_value[c], kInvalid);
          continue;
        }
        const std::uint32_t value = channel.corner_value[c];
        if (channel.is_position_morph) {
          EXPECT_EQ(channel.layer_value[value].value, state.mesh_vertex[v].value);
          EXPECT_EQ(channel.value(value)[2], meshes[m]->position_morphs[0][state.mesh_vertex[v].index()].z);
        } else {
          const AttributeLayer& layer = meshes[m]->layers[channel.slices[m][0].layer];
          const ValueId id = layer.corner_value[corner(face, k).index()];
          EXPECT_EQ(channel.layer_value[value], id);
          EXPECT_EQ(channel.value(value)[0], layer.value(id)[0]);
        }
      }
    }
  }
}

TEST(CollapseState, AScatteredMeshSimplifiesLikeAnother) {
  // A flat sheet whose texture coordinates are its place and whose parts are its halves, one vertex locked.
  const TriMesh mesh = test::shuffled(test::two_part_grid(64, 64));
  std::vector<float> weights(mesh.vertex_count(), 1.0f);
  std::size_t locked = 0;
  while (!(mesh.positions[locked].x > 0.3f && mesh.positions[locked].x < 0.4f)) ++locked;
  weights[locked] = std::numeric_limits<float>::infinity();
  SimplifyOptions options = test::by_quadrics();
  options.ratio = 0.02;
  Context context;
  const SimplifyResult result = simplify(test::model_of(mesh), options, {VertexField(weights)}, context);
  const TriMesh& small = result.model.meshes[0].surface;
  check(small);
  EXPECT_EQ(small.face_count(), result.triangles_target);
  EXPECT_NE(std::find(small.positions.begin(), small.positions.end(), mesh.positions[locked]),
            small.positions.end());
  const AttributeLayer& uv = *small.find(Semantic::uv);
  double area[2] = {};
  for (std::size_t f = 0; f < small.face_count(); ++f) {
    Vec3d p[3];
    for (int k = 0; k < 3; ++k) {
      const CornerId c = corner(FaceId{f}, k);
      p[k] = Vec3d(small.positions[small.vertex(c).index()]);
      EXPECT_NEAR(uv.value(uv.corner_value[c.index()])[0], p[k].x, 1e-5);
      EXPECT_NEAR(p[k].z, 0, 1e-6);
    }
    area[small.face_part[f]] += 0.5 * length(cross(p[1] - p[0], p[2] - p[0]));
  }
  // The border between the halves stays within a hundredth of a cell.
  EXPECT_NEAR(area[0], 0.5, 0.01 / 64);
  EXPECT_NEAR(area[1], 0.5, 0.01 / 64);
}

}  // namespace
}  // namespace fovea
