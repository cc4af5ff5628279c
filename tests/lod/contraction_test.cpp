#include "fovea/lod/contraction.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "fovea/base/random.h"
#include "fovea/lod/cut.h"
#include "fovea/lod/live_level.h"
#include "lod/leveled.h"
#include "support/any_model.h"
#include "support/meshes.h"

namespace fovea {
namespace {

using test::bits_of;
using test::Leveled;
using test::leveled;
using test::random_cut;

using Soup = std::vector<std::vector<float>>;  // [#corners], all numbers of a corner, triangles in order

/// By the record itself.
Soup soup(const LiveLevel& live, std::size_t m, std::uint32_t part) {
  const TriMesh& mesh = live.mesh(m);
  Soup result;
  for (std::size_t c = 0; c < 3 * mesh.face_count(); ++c) {
    if (!live.is_there(m, FaceId{c / 3}) || mesh.face_part[c / 3] != part) continue;
    const VertexId v = mesh.vertex(CornerId{c});
    const Vec3f p = mesh.positions[v.index()];
    std::vector<float>& numbers = result.emplace_back(std::vector{p.x, p.y, p.z});
    for (const auto& morph : mesh.position_morphs) {
      const Vec3f d = morph[v.index()];
      numbers.insert(numbers.end(), {d.x, d.y, d.z});
    }
    for (const AttributeLayer& layer : mesh.layers) {
      const ValueId value = layer.corner_value[c];
      const auto add = [&](const std::vector<float>& values) {
        for (int i = 0; i < layer.width; ++i)
          numbers.push_back(value.valid() ? values[value.index() * static_cast<std::size_t>(layer.width) +
                                                   static_cast<std::size_t>(i)]
                                          : 0);
      };
      add(layer.values);
      for (const auto& morph : layer.morphs) {
        if (!morph.empty()) add(morph);
      }
    }
  }
  return result;
}

/// By vertices that never change and indices.
Soup soup(const LevelVertices& vertices, std::span<const std::uint32_t> indices) {
  Soup result;
  for (const std::uint32_t i : indices) {
    const Vec3f p = vertices.positions.at(i);
    std::vector<float>& numbers = result.emplace_back(std::vector{p.x, p.y, p.z});
    for (const auto& morph : vertices.position_morphs)
      numbers.insert(numbers.end(), {morph[i].x, morph[i].y, morph[i].z});
    for (const AttributeLayer& layer : vertices.layers) {
      const auto add = [&](const std::vector<float>& values) {
        const auto from = values.begin() + static_cast<std::ptrdiff_t>(i) * layer.width;
        numbers.insert(numbers.end(), from, from + layer.width);
      };
      add(layer.values);
      for (const auto& morph : layer.morphs) {
        if (!morph.empty()) add(morph);
      }
    }
  }
  return result;
}

void expect_same_levels(const Leveled& model, const std::string& name) {
  Context context;
  const VertexHierarchy hierarchy = make_vertex_hierarchy(model.original, model.levels, context);
  Contraction contraction(hierarchy);
  LiveLevel live(model.original, model.levels);
  for (std::uint64_t seed = 0; seed < 14; ++seed) {
    const Cut cut = seed == 12   ? Cut(model.levels.step_count(), 0)
                    : seed == 13 ? Cut(model.levels.step_count(), 1)
                                 : random_cut(model.levels, seed);
    live.go_to(cut);
    const StepBits taken = bits_of(cut);
    contraction.begin(taken);
    EXPECT_TRUE(contraction.advance(contraction.total_work()));
    const LevelIndices& level = contraction.level();
    EXPECT_EQ(level.triangle_count(), live.triangle_count()) << name;
    for (std::size_t p = 0; p < hierarchy.parts.size(); ++p) {
      const LevelPart& part = hierarchy.parts[p];
      EXPECT_EQ(soup(hierarchy.vertices[part.mesh], level.of_part(hierarchy, p)),
                soup(live, part.mesh, part.part))
          << name << " " << seed;
    }
  }
}

TEST(Contraction, GivesWhatTheRecordGives) {
  for (const Placement placement : {Placement::optimal, Placement::half_edge}) {
    for (const auto& [name, mesh] : test::all_families())
      expect_same_levels(leveled(test::model_of(mesh), 0, 2, placement), name);
  }
}

/// How many corners of the original's triangles, be they there or not, are not led to where the first `count`
/// steps put their vertex.
std::size_t strays(const Leveled& model, const VertexHierarchy& hierarchy, std::size_t count) {
  std::vector<std::vector<std::uint32_t>> now;
  std::vector<std::vector<Vec3f>> positions;
  for (const Mesh& mesh : model.original.meshes) {
    now.emplace_back(mesh.surface.vertex_count());
    std::iota(now.back().begin(), now.back().end(), 0u);
    positions.push_back(mesh.surface.positions);
  }
  const CollapseRecord& record = model.levels.record;
  for (std::size_t s = 0; s < count; ++s) {
    const CollapseStep& step = record.steps[s];
    if (step.kind != StepKind::collapse) continue;
    for (std::uint32_t& v : now[step.mesh]) v = v == step.removed.value ? step.kept.value : v;
    if (step.moved) positions[step.mesh][step.kept.index()] = step.position;
  }
  std::size_t strays = 0;
  for (const LevelPart& part : hierarchy.parts) {
    const TriMesh& mesh = model.original.meshes[part.mesh].surface;
    std::size_t f = part.first_face;
    for (std::size_t face = 0; face < mesh.face_count(); ++face) {
      if (mesh.face_part[face] != part.part) continue;
      for (std::size_t k = 0; k < 3; ++k) {
        std::uint32_t node = hierarchy.corners[f][k];
        while (hierarchy.step[node] != kInvalid && hierarchy.step[node] < count)
          node = hierarchy.parent[node];
        const Vec3f there = hierarchy.vertices[part.mesh].positions[hierarchy.vertex[node]];
        strays += there != positions[part.mesh][now[part.mesh][mesh.triangles[face][k].index()]];
      }
      ++f;
    }
  }
  return strays;
}

TEST(Contraction, CornersOfTrianglesThatAreGoneFollow) {
  for (std::uint64_t seed = 1; seed <= 200; ++seed) {
    test::Choices choices(seed);
    const Placement placement = seed % 2 == 0 ? Placement::half_edge : Placement::optimal;
    const Leveled model = leveled(test::any_model(choices), 0, 1, placement);
    Context context;
    const VertexHierarchy hierarchy = make_vertex_hierarchy(model.original, model.levels, context);
    const std::size_t steps = model.levels.step_count();
    // The last vertex of a piece moves after its last triangle has gone.
    for (std::size_t i = 0; i <= 8; ++i) EXPECT_EQ(strays(model, hierarchy, i * steps / 8), 0u) << seed;
  }
}

TEST(Contraction, OfSeveralMeshesAndParts) {
  Model model = test::model_of(test::torus(24, 12));
  model.meshes.push_back(model.meshes[0]);
  TriMesh& second = model.meshes[1].surface;
  for (Vec3f& p : second.positions) p.x += 5;
  second.parts.push_back(second.parts[0]);
  for (std::size_t f = 0; f < second.face_count(); f += 3) second.face_part[f] = 1;
  expect_same_levels(leveled(std::move(model), 40), "two tori");
}

TEST(Contraction, InPiecesIsTheSame) {
  const Leveled model = leveled(test::model_of(test::torus(24, 12)), 40);
  Context context;
  const VertexHierarchy hierarchy = make_vertex_hierarchy(model.original, model.levels, context);
  const StepBits taken = bits_of(random_cut(model.levels, 3));
  Contraction contraction(hierarchy);
  contraction.begin(taken);
  contraction.advance(contraction.total_work());
  const LevelIndices whole = contraction.level();
  contraction.begin(taken);
  std::size_t count = 1;
  while (!contraction.advance(17)) ++count;
  EXPECT_EQ(count, (contraction.total_work() + 16) / 17);
  const LevelIndices& pieces = contraction.level();
  for (std::size_t p = 0; p < hierarchy.parts.size(); ++p)
    EXPECT_TRUE(std::ranges::equal(pieces.of_part(hierarchy, p), whole.of_part(hierarchy, p)));
}

}  // namespace
}  // namespace fovea
