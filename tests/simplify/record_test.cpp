#include "fovea/simplify/record.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <map>
#include <numeric>
#include <vector>

#include "fovea/base/error.h"
#include "fovea/simplify/simplify.h"
#include "support/any_model.h"
#include "support/by_quadrics.h"
#include "support/meshes.h"

namespace fovea {
namespace {

SimplifyResult simplify_to(const Model& model, std::int64_t triangles) {
  SimplifyOptions options = test::by_quadrics();
  options.triangles = triangles;
  Context context;
  context.threads = 1;
  return simplify(model, options, {}, context);
}

void expect_same(const TriMesh& a, const TriMesh& b, const std::string& name) {
  EXPECT_EQ(a.positions, b.positions) << name;
  EXPECT_EQ(a.triangles, b.triangles) << name;
  EXPECT_EQ(a.face_part, b.face_part) << name;
  EXPECT_EQ(a.position_morphs, b.position_morphs) << name;
  EXPECT_EQ(a.source_vertex, b.source_vertex) << name;
  ASSERT_EQ(a.layers.size(), b.layers.size()) << name;
  for (std::size_t l = 0; l < a.layers.size(); ++l) {
    EXPECT_EQ(a.layers[l].values, b.layers[l].values) << name;
    EXPECT_EQ(a.layers[l].corner_value, b.layers[l].corner_value) << name;
    EXPECT_EQ(a.layers[l].morphs, b.layers[l].morphs) << name;
  }
}

TEST(Record, NoStepsGiveTheSource) {
  for (const auto& [name, mesh] : test::all_families()) {
    const TriMesh* source = &mesh;
    const auto level = replay(std::span(&source, 1), {}, 0);
    EXPECT_EQ(level[0].triangles.size(), mesh.triangles.size()) << name;
    check(level[0]);
  }
}

TEST(Record, AnyLevelIsWhatSimplifyingToItGives) {
  for (const auto& [name, mesh] : test::all_families()) {
    if (mesh.face_count() < 16) continue;
    const Model model = test::model_of(mesh);
    const auto faces = static_cast<std::int64_t>(mesh.face_count());
    const SimplifyResult deep = simplify_to(model, faces / 8), half = simplify_to(model, faces / 2);
    ASSERT_LE(half.record.steps.size(), deep.record.steps.size()) << name;
    const TriMesh* source = &mesh;
    const auto level = replay(std::span(&source, 1), deep.record, half.record.steps.size());
    expect_same(level[0], half.model.meshes[0].surface, name);
  }
}

TEST(Record, CountsTrianglesAtEveryStep) {
  const TriMesh mesh = test::torus(24, 12);
  const SimplifyResult result = simplify_to(test::model_of(mesh), 40);
  const TriMesh* source = &mesh;
  for (std::size_t n = 0; n <= result.record.steps.size(); n += 7) {
    const auto level = replay(std::span(&source, 1), result.record, n);
    EXPECT_EQ(level[0].face_count(), result.record.triangles_after(n));
    check(level[0]);
  }
}

TEST(Record, ErrorNeverFalls) {
  const SimplifyResult result = simplify_to(test::model_of(test::icosphere(4)), 50);
  float last = 0;
  for (const CollapseStep& step : result.record.steps) {
    EXPECT_GE(step.error_rel, last);
    last = step.error_rel;
  }
}

TEST(Record, SourceVerticesFollowTheCollapses) {
  const TriMesh mesh = test::wavy_grid(12, 12, 0.1);
  const SimplifyResult result = simplify_to(test::model_of(mesh), 40);
  const TriMesh& level = result.model.meshes[0].surface;
  ASSERT_EQ(level.source_vertex.size(), mesh.source_vertex.size());
  for (std::size_t i = 0; i < mesh.source_vertex.size(); ++i) {
    if (!mesh.source_vertex[i].valid()) continue;
    const VertexId now = level.source_vertex[i];
    ASSERT_TRUE(now.valid());
    // Every source vertex ends at a vertex near it: 40 triangles on a unit square are about 0.3 wide.
    const Vec3d from(mesh.positions[mesh.source_vertex[i].index()]), to(level.positions[now.index()]);
    EXPECT_LT(length(to - from), 0.7);
  }
}

/// Whether the triangles that a collapse takes besides those on its edge come in pairs, back to back: then
/// what is beside them ends where it did.
bool is_closed(const CollapseRecord& record, std::size_t s, const TriMesh& source,
               const std::vector<std::uint32_t>& now) {
  std::map<std::array<std::uint32_t, 2>, int> forward;
  for (std::size_t i = s > 0 ? record.steps[s - 1].faces_end : 0; i < record.steps[s].faces_end; ++i) {
    const auto& t = source.triangles[record.removed_faces[i].index()];
    std::array<std::uint32_t, 3> v{};
    for (std::size_t k = 0; k < 3; ++k) v[k] = now[t[k].index()];
    if (v[0] == v[1] || v[1] == v[2] || v[2] == v[0]) continue;
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t a = v[k], b = v[(k + 1) % 3];
      forward[{std::min(a, b), std::max(a, b)}] += a < b ? 1 : -1;
    }
  }
  return std::all_of(forward.begin(), forward.end(), [](const auto& edge) { return edge.second == 0; });
}

TEST(Record, NoCollapseTearsTheSurface) {
  std::size_t looked_at = 0;
  for (std::uint64_t seed = 1; seed <= 300; ++seed) {
    test::Choices choices(seed);
    const Model model = test::any_model(choices);
    const CollapseRecord record = simplify_to(model, 0).record;
    std::vector<std::vector<std::uint32_t>> now;
    for (const Mesh& mesh : model.meshes) {
      now.emplace_back(mesh.surface.vertex_count());
      std::iota(now.back().begin(), now.back().end(), 0u);
    }
    for (std::size_t s = 0; s < record.steps.size(); ++s) {
      const CollapseStep& step = record.steps[s];
      if (step.kind != StepKind::collapse) continue;
      for (std::uint32_t& v : now[step.mesh]) v = v == step.removed.value ? step.kept.value : v;
      EXPECT_TRUE(is_closed(record, s, model.meshes[step.mesh].surface, now[step.mesh])) << seed << " " << s;
      ++looked_at;
    }
  }
  EXPECT_GT(looked_at, 1000u);
}

TEST(Record, RefusesMoreStepsThanThereAre) {
  const TriMesh mesh = test::cube();
  const TriMesh* source = &mesh;
  EXPECT_THROW(replay(std::span(&source, 1), {}, 1), Error);
}

}  // namespace
}  // namespace fovea
