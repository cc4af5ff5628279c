#include "fovea/lod/cut.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <limits>
#include <map>
#include <set>

#include "fovea/base/error.h"
#include "fovea/base/random.h"
#include "fovea/lod/live_level.h"
#include "lod/leveled.h"
#include "support/meshes.h"

namespace fovea {
namespace {

using test::Leveled;
using test::leveled;

/// Closed under needs; each step that could be taken is, with this chance.
Cut random_cut(const MultiTessellation& levels, std::uint64_t seed, double chance) {
  Random random(seed);
  Cut cut(levels.step_count(), 0);
  for (std::size_t s = 0; s < cut.size(); ++s) {
    const auto needs = levels.needs_of(s);
    const bool can = std::all_of(needs.begin(), needs.end(), [&](std::uint32_t n) { return cut[n] != 0; });
    cut[s] = can && random.uniform() < chance;
  }
  return cut;
}

/// How often each edge is used by a triangle.
std::map<std::pair<std::uint32_t, std::uint32_t>, int> edge_uses(const TriMesh& mesh) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> uses;
  for (const auto& t : mesh.triangles) {
    for (std::size_t k = 0; k < 3; ++k) ++uses[std::minmax(t[k].value, t[(k + 1) % 3].value)];
  }
  return uses;
}

std::vector<float> everywhere(const MultiTessellation& levels, float allowed) {
  return std::vector<float>(levels.first_vertex.back(), allowed);
}

TEST(Cut, OfAllAndOfNoStepsAreBothEnds) {
  for (const auto& [name, mesh] : test::all_families()) {
    const Leveled model = leveled(test::model_of(mesh), 0);
    const std::size_t count = model.levels.step_count();
    EXPECT_EQ(triangles_of(model.levels, Cut(count, 0)), mesh.face_count()) << name;
    EXPECT_EQ(triangles_of(model.levels, Cut(count, 1)), model.levels.record.triangles_after(count)) << name;
    const Model fine = level_of(model.original, model.levels, Cut(count, 0));
    EXPECT_EQ(fine.meshes[0].surface.triangles, mesh.triangles) << name;
  }
}

TEST(Cut, FirstStepsGiveTheLevelsOfTheRecord) {
  const TriMesh mesh = test::torus(24, 12);
  const Leveled model = leveled(test::model_of(mesh), 40);
  const TriMesh* source = &mesh;
  for (const std::uint64_t triangles : {570u, 300u, 100u, 41u}) {
    const Cut cut = cut_at_triangles(model.levels, triangles);
    const auto steps = static_cast<std::size_t>(std::count(cut.begin(), cut.end(), 1));
    const auto level = replay(std::span(&source, 1), model.levels.record, steps);
    EXPECT_LE(level[0].face_count(), triangles);
    EXPECT_GE(level[0].face_count() + 2, triangles);
    const TriMesh same = level_of(model.original, model.levels, cut).meshes[0].surface;
    EXPECT_EQ(same.triangles, level[0].triangles);
    EXPECT_EQ(same.positions, level[0].positions);
  }
}

TEST(Cut, AnySetThatIsClosedIsAMeshLikeTheOriginal) {
  for (const auto& [name, mesh] : test::all_families()) {
    const Leveled model = leveled(test::model_of(mesh), 0);
    for (std::uint64_t seed = 0; seed < 20; ++seed) {
      const Cut cut = random_cut(model.levels, seed, seed % 2 == 0 ? 0.9 : 0.6);
      const TriMesh level = level_of(model.original, model.levels, cut).meshes[0].surface;
      check(level);
      EXPECT_EQ(level.face_count(), triangles_of(model.levels, cut)) << name;
    }
  }
}

/// What each vertex of a mesh has become.
std::vector<VertexId> targets(const MultiTessellation& levels, const Cut& cut) {
  std::vector<VertexId> target(levels.first_vertex.back());
  for (std::size_t v = 0; v < target.size(); ++v) target[v] = VertexId{v};
  for (std::size_t s = cut.size(); s-- > 0;) {
    const CollapseStep& step = levels.record.steps[s];
    if (cut[s] != 0 && step.kind == StepKind::collapse)
      target[step.removed.index()] = target[step.kept.index()];
  }
  return target;
}

/// A sheet that has lost many of its triangles: full of borders, flaps and loose pieces.
TriMesh tattered(std::uint64_t seed) {
  const TriMesh sheet = test::wavy_grid(16, 16, 0.1);
  SplitPart part;
  part.positions = sheet.positions;
  Random random(seed);
  for (const auto& t : sheet.triangles) {
    if (random.uniform() < 0.3) continue;
    for (const VertexId v : t) part.indices.push_back(v.value);
  }
  return test::shuffled(test::weld_part(part));
}

TEST(Cut, NothingOpensThatWasClosed) {
  // An edge of an odd number of triangles is what such edges of the original have become; and a level that
  // goes from cut to cut, where each step changes the triangles that it knows, is the one read from the
  // record.
  for (const Placement placement : {Placement::optimal, Placement::half_edge}) {
    for (std::uint64_t seed = 0; seed < 10; ++seed) {
      const TriMesh mesh = tattered(seed);
      const Leveled model = leveled(test::model_of(mesh), 0, 2, placement);
      LiveLevel live(model.original, model.levels);
      for (std::uint64_t i = 0; i < 10; ++i) {
        const Cut cut = random_cut(model.levels, i, i % 2 == 0 ? 0.9 : 0.6);
        live.go_to(cut);
        TriMesh level;
        for (std::size_t f = 0; f < mesh.face_count(); ++f) {
          if (live.is_there(0, FaceId{f})) level.triangles.push_back(live.mesh(0).triangles[f]);
        }
        const std::vector<VertexId> target = targets(model.levels, cut);
        std::set<std::pair<std::uint32_t, std::uint32_t>> borders;
        for (const auto& [edge, uses] : edge_uses(mesh)) {
          if (uses % 2 == 1) borders.insert(std::minmax(target[edge.first].value, target[edge.second].value));
        }
        for (const auto& [edge, uses] : edge_uses(level))
          EXPECT_TRUE(uses % 2 == 0 || borders.contains(edge)) << seed << " " << i;
        const TriMesh read = level_of(model.original, model.levels, cut).meshes[0].surface;
        ASSERT_EQ(read.face_count(), level.face_count());
        for (std::size_t f = 0; f < read.face_count(); ++f) {
          for (std::size_t k = 0; k < 3; ++k) {
            EXPECT_EQ(read.positions[read.triangles[f][k].index()],
                      live.mesh(0).positions[level.triangles[f][k].index()]);
          }
        }
      }
    }
  }
}

TEST(Cut, ClosedSurfacesStayClosed) {
  for (const TriMesh& mesh : {test::torus(24, 12), test::icosphere(3), test::cube()}) {
    const Leveled model = leveled(test::model_of(mesh), 20);
    for (std::uint64_t seed = 0; seed < 50; ++seed) {
      const TriMesh level =
          level_of(model.original, model.levels, random_cut(model.levels, seed, 0.8)).meshes[0].surface;
      for (const auto& [edge, uses] : edge_uses(level)) EXPECT_EQ(uses, 2) << seed;
      std::set<std::array<VertexId, 3>> seen;
      for (std::array<VertexId, 3> t : level.triangles) {
        std::sort(t.begin(), t.end());
        EXPECT_TRUE(seen.insert(t).second) << seed;
      }
    }
  }
}

TEST(Cut, FlatSurfacesNeitherTearNorFold) {
  // z does not matter: seen from above the triangles of any level fill the square once, none turned over.
  const Leveled model = leveled(test::model_of(test::wavy_grid(24, 24, 0.05)), 60);
  for (std::uint64_t seed = 0; seed < 50; ++seed) {
    const TriMesh level =
        level_of(model.original, model.levels, random_cut(model.levels, seed, 0.9)).meshes[0].surface;
    double area = 0;
    for (const auto& t : level.triangles) {
      const auto at = [&](VertexId v) {
        const Vec3d p(level.positions[v.index()]);
        return Vec2d{p.x, p.y};
      };
      const double doubled = cross(at(t[1]) - at(t[0]), at(t[2]) - at(t[0]));
      EXPECT_GT(doubled, 0) << seed;
      area += doubled / 2;
    }
    EXPECT_NEAR(area, 1, 0.02) << seed;  // borders may give way a little
  }
}

TEST(Cut, TheSameAllowedEverywhereIsOneError) {
  const Leveled model = leveled(test::model_of(test::torus(48, 24)), 100);
  for (const float error : {0.0f, 0.003f, 0.01f, 0.1f})
    EXPECT_EQ(cut_within(model.levels, everywhere(model.levels, error)), cut_at_error(model.levels, error));
}

/// The largest closed set whose triangles keep to what is allowed, by its definition: takes out what breaks
/// the rule until nothing does. Knows each vertex as the set of those that were merged into it.
Cut cut_oracle(const MultiTessellation& levels, const std::vector<float>& allowed) {
  Cut cut(levels.step_count(), 1);
  for (bool changed = true; changed;) {
    changed = false;
    std::vector<std::set<std::uint32_t>> merged(allowed.size());
    for (std::uint32_t v = 0; v < allowed.size(); ++v) merged[v] = {v};
    for (std::size_t s = 0; s < cut.size(); ++s) {
      if (cut[s] == 0) continue;
      bool good = true;
      for (const std::uint32_t n : levels.needs_of(s)) good &= cut[n] != 0;
      const CollapseStep& step = levels.record.steps[s];
      const std::uint32_t removed = levels.vertex(step.mesh, step.removed),
                          kept = levels.vertex(step.mesh, step.kept);
      merged[kept].insert(merged[removed].begin(), merged[removed].end());
      for (const std::uint32_t v : levels.corners_of(s)) {
        for (const std::uint32_t original : merged[v]) good &= levels.error[s] <= allowed[original];
      }
      if (good) continue;
      cut[s] = 0;
      changed = true;
      break;
    }
  }
  return cut;
}

TEST(Cut, IsTheSmallestMeshThatKeepsToWhatIsAllowed) {
  const Leveled model = leveled(test::model_of(test::torus(16, 10)), 40);
  Random random(7);
  for (int round = 0; round < 5; ++round) {
    std::vector<float> allowed = everywhere(model.levels, 0.3f);
    for (float& a : allowed) {
      if (random.uniform() < 0.1) a = static_cast<float>(0.1 * random.uniform());
    }
    EXPECT_EQ(cut_within(model.levels, allowed), cut_oracle(model.levels, allowed)) << round;
  }
}

TEST(Cut, WhatMayNotChangeStaysAsItIs) {
  // In the order of a scan: edges that cost the same go in the order of their numbers, here once around the
  // torus, and each would need the one before.
  const TriMesh mesh = test::shuffled(test::torus(48, 24));
  const Leveled model = leveled(test::model_of(mesh), 60, 2, Placement::half_edge);
  std::vector<float> allowed = everywhere(model.levels, 1.0f);
  std::set<std::array<float, 9>> kept;
  const auto key = [](const TriMesh& m, const std::array<VertexId, 3>& t) {
    std::array<float, 9> k{};
    for (std::size_t i = 0; i < 3; ++i) {
      const Vec3f p = m.positions[t[i].index()];
      k[3 * i] = p.x, k[3 * i + 1] = p.y, k[3 * i + 2] = p.z;
    }
    return k;
  };
  for (const auto& t : mesh.triangles) {
    bool inside = false;
    for (const VertexId v : t) inside |= mesh.positions[v.index()].x > 0.9f;
    if (!inside) continue;
    kept.insert(key(mesh, t));
    for (const VertexId v : t) {
      if (mesh.positions[v.index()].x > 0.9f) allowed[v.index()] = 0;
    }
  }
  const Cut cut = cut_within(model.levels, allowed);
  const TriMesh level = level_of(model.original, model.levels, cut).meshes[0].surface;
  ASSERT_FALSE(kept.empty());
  EXPECT_LT(level.face_count(), mesh.face_count() / 2);  // an island and its slopes
  for (const auto& t : level.triangles) kept.erase(key(level, t));
  EXPECT_TRUE(kept.empty()) << kept.size();
}

TEST(Cut, BudgetsAreMetByOneFactor) {
  const Leveled model = leveled(test::model_of(test::torus(48, 24)), 60);
  std::vector<float> allowed = everywhere(model.levels, 1.0f);
  for (std::size_t v = 0; v < allowed.size(); v += 3) allowed[v] = 0.25f;
  for (const std::uint64_t triangles : {2304u, 1500u, 400u, 80u}) {
    double factor = 0;
    const Cut cut = cut_within(model.levels, allowed, triangles, &factor);
    EXPECT_LE(triangles_of(model.levels, cut), triangles);
    std::vector<float> scaled = allowed;
    for (float& a : scaled) a *= static_cast<float>(factor * 0.998);
    EXPECT_GT(triangles_of(model.levels, cut_within(model.levels, scaled)),
              std::min(triangles, std::uint64_t{2303}))
        << triangles;
  }
}

TEST(Cut, ABudgetThatCannotBeMetGivesTheCoarsest) {
  const Leveled model = leveled(test::model_of(test::torus(24, 12)), 60);
  const Cut all(model.levels.step_count(), 1);
  EXPECT_EQ(cut_within(model.levels, everywhere(model.levels, 1e-6f), 1), all);
  // What may not change at all cannot be bought.
  const Cut none(model.levels.step_count(), 0);
  EXPECT_EQ(cut_within(model.levels, everywhere(model.levels, 0), 1), none);
}

TEST(Cut, WrongFieldsAreRefused) {
  const Leveled model = leveled(test::model_of(test::torus(24, 12)), 60);
  EXPECT_THROW(cut_within(model.levels, std::vector<float>(3, 1.0f)), Error);
  std::vector<float> allowed = everywhere(model.levels, 1.0f);
  allowed[5] = -1;
  EXPECT_THROW(cut_within(model.levels, allowed), Error);
  allowed[5] = std::numeric_limits<float>::quiet_NaN();
  EXPECT_THROW(cut_within(model.levels, allowed), Error);
}

}  // namespace
}  // namespace fovea
