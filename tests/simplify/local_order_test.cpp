#include "fovea/simplify/local_order.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "collapse_states.h"
#include "fovea/base/random.h"

namespace fovea {
namespace {

template <class Id>
std::vector<Id> shuffled_ids(std::size_t count, Random& random) {
  std::vector<Id> ids;
  for (std::size_t i = 0; i < count; ++i) ids.push_back(Id{i});
  for (std::size_t i = count; i > 1; --i)
    std::swap(ids[i - 1], ids[random.below(static_cast<std::uint32_t>(i))]);
  return ids;
}

/// The same mesh with vertices, triangles and values in random order.
TriMesh shuffled(const TriMesh& mesh) {
  Random random(11);
  TriMesh result = mesh;
  const auto vertices = shuffled_ids<VertexId>(mesh.vertex_count(), random);  // old -> new
  for (std::size_t v = 0; v < vertices.size(); ++v) {
    result.positions[vertices[v].index()] = mesh.positions[v];
    for (std::size_t t = 0; t < mesh.target_count(); ++t)
      result.position_morphs[t][vertices[v].index()] = mesh.position_morphs[t][v];
  }
  const auto faces = shuffled_ids<FaceId>(mesh.face_count(), random);
  for (std::size_t f = 0; f < faces.size(); ++f) {
    for (std::size_t k = 0; k < 3; ++k)
      result.triangles[faces[f].index()][k] = vertices[mesh.triangles[f][k].index()];
    result.face_part[faces[f].index()] = mesh.face_part[f];
  }
  for (std::size_t l = 0; l < mesh.layers.size(); ++l) {
    const AttributeLayer& from = mesh.layers[l];
    AttributeLayer& to = result.layers[l];
    const auto values = shuffled_ids<ValueId>(from.size(), random);
    for (std::size_t v = 0; v < values.size(); ++v) {
      for (int k = 0; k < from.width; ++k) to.value(values[v])[k] = from.value(ValueId{v})[k];
    }
    for (std::size_t f = 0; f < faces.size(); ++f) {
      for (int k = 0; k < 3; ++k) {
        const ValueId value = from.corner_value[corner(FaceId{f}, k).index()];
        to.corner_value[corner(faces[f], k).index()] = value.valid() ? values[value.index()] : value;
      }
    }
  }
  result.source_vertex.clear();
  check(result);
  return result;
}

/// Sum of the distances in memory from each corner's vertex to the next's.
double way(const TriMesh& mesh, const LocalOrder& order) {
  std::vector<double> place(mesh.vertex_count());
  for (std::size_t i = 0; i < order.vertices.size(); ++i)
    place[order.vertices[i].index()] = static_cast<double>(i);
  double sum = 0, last = 0;
  for (const FaceId f : order.faces) {
    for (const VertexId v : mesh.triangles[f.index()]) {
      sum += std::abs(place[v.index()] - last);
      last = place[v.index()];
    }
  }
  return sum;
}

LocalOrder own_order(const TriMesh& mesh) {
  LocalOrder order;
  for (std::size_t v = 0; v < mesh.vertex_count(); ++v) order.vertices.push_back(VertexId{v});
  for (std::size_t f = 0; f < mesh.face_count(); ++f) order.faces.push_back(FaceId{f});
  return order;
}

TEST(LocalOrder, NamesEveryVertexAndTriangleOnce) {
  const TriMesh mesh = shuffled(test::torus(96, 48));
  const LocalOrder order = local_order(mesh);
  std::vector<int> vertices(mesh.vertex_count()), faces(mesh.face_count());
  for (const VertexId v : order.vertices) ++vertices[v.index()];
  for (const FaceId f : order.faces) ++faces[f.index()];
  EXPECT_EQ(vertices, std::vector<int>(mesh.vertex_count(), 1));
  EXPECT_EQ(faces, std::vector<int>(mesh.face_count(), 1));
}

TEST(LocalOrder, BringsScatteredNeighboursTogether) {
  // In random order the next corner is a third of all vertices away; on a Z-order curve most are within the
  // square root of them.
  const TriMesh mesh = shuffled(test::torus(96, 48));
  EXPECT_LT(way(mesh, local_order(mesh)), 0.1 * way(mesh, own_order(mesh)));
}

TEST(LocalOrder, KeepsAnOrderThatIsLocal) {
  const TriMesh mesh = test::grid(64, 64);
  const LocalOrder order = local_order(mesh), own = own_order(mesh);
  EXPECT_EQ(order.vertices, own.vertices);
  EXPECT_EQ(order.faces, own.faces);
}

TEST(LocalOrder, PutsUpWithMeshesOfNoSize) {
  EXPECT_TRUE(local_order(test::empty_mesh()).faces.empty());
  TriMesh mesh = shuffled(test::grid(64, 64));
  for (Vec3f& p : mesh.positions) p = {1, 2, 3};
  EXPECT_EQ(local_order(mesh).faces.size(), mesh.face_count());
}

/// Whatever the order inside, the engine works on the mesh's own triangles and values.
TEST(LocalOrder, TheEngineKnowsWhereThingsAreInTheirMesh) {
  const TriMesh one = shuffled(test::two_part_grid(48, 48)), two = shuffled(test::morph_strip(1500));
  const TriMesh* const meshes[] = {&one, &two};
  const double scales[] = {1, 1};
  const VertexField* const importance[] = {nullptr, nullptr};
  const CollapseState state = make_collapse_state(meshes, scales, importance, 1.0, {}, {});
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

TEST(LocalOrder, AScatteredMeshSimplifiesLikeAnother) {
  // A flat sheet whose texture coordinates are its place and whose parts are its halves, one vertex locked.
  const TriMesh mesh = shuffled(test::two_part_grid(64, 64));
  std::vector<float> weights(mesh.vertex_count(), 1.0f);
  std::size_t locked = 0;
  while (!(mesh.positions[locked].x > 0.3f && mesh.positions[locked].x < 0.4f)) ++locked;
  weights[locked] = std::numeric_limits<float>::infinity();
  SimplifyOptions options;
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
