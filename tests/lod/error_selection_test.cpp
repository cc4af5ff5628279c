#include "fovea/lod/error_selection.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <initializer_list>
#include <limits>
#include <map>
#include <set>
#include <utility>
#include <vector>

#include "fovea/base/error.h"
#include "fovea/io/read.h"
#include "fovea/lod/contraction.h"
#include "fovea/lod/cut.h"
#include "fovea/lod/level_cracks.h"
#include "fovea/surface/half_edges.h"
#include "lod/leveled.h"
#include "support/any_model.h"
#include "support/meshes.h"
#include "support/reading.h"

namespace fovea {
namespace {

using test::is_closed;
using test::Leveled;
using test::leveled;

LevelCamera camera_from(Vec3d eye, Vec3d target = {}) { return {view_from(eye, target, 40), 800, 600}; }

/// A model with all that a level is read by.
struct Selected {
  explicit Selected(TriMesh mesh) : model(leveled(test::model_of(std::move(mesh)), 0)) {}

  Leveled model;
  Context context;
  VertexHierarchy hierarchy = make_vertex_hierarchy(model.original, model.levels, context);
  Vec3d center = (bounds(model.original).low + bounds(model.original).high) * 0.5;

  Cut cut(LevelSelection& selection, const LevelCamera& camera, const LevelBudget& budget,
          std::size_t work = std::numeric_limits<std::size_t>::max()) const {
    selection.begin(camera, budget);
    while (!selection.advance(work)) {
    }
    Cut cut(model.levels.step_count());
    for (std::size_t s = 0; s < cut.size(); ++s) cut[s] = selection.taken().has(s);
    return cut;
  }
  /// Corners of the triangles that are left.
  std::vector<Vec3f> corners(const Cut& cut) const {
    const StepBits taken = test::bits_of(cut);
    Contraction contraction(hierarchy);
    contraction.begin(taken);
    contraction.advance(contraction.total_work());
    std::vector<Vec3f> corners;
    for (std::size_t p = 0; p < hierarchy.parts.size(); ++p) {
      for (const std::uint32_t i : contraction.level().of_part(hierarchy, p))
        corners.push_back(hierarchy.vertices[hierarchy.parts[p].mesh].positions[i]);
    }
    return corners;
  }
  /// How many triangles begin below the middle in x, and how many beyond.
  std::pair<std::size_t, std::size_t> sides(const Cut& cut) const {
    const std::vector<Vec3f> c = corners(cut);
    std::size_t below = 0;
    for (std::size_t i = 0; i < c.size(); i += 3) below += c[i].x < static_cast<float>(center.x);
    return {below, c.size() / 3 - below};
  }
};

/// Edges with an odd number of triangles, by where their ends are.
std::size_t odd_edges(const std::vector<Vec3f>& corners) {
  using Point = std::array<float, 3>;
  std::map<std::pair<Point, Point>, int> count;
  for (std::size_t c = 0; c < corners.size(); ++c) {
    const Vec3f a = corners[c], b = corners[next_corner(c)];
    const Point from{a.x, a.y, a.z}, to{b.x, b.y, b.z};
    ++count[std::minmax(from, to)];
  }
  return static_cast<std::size_t>(
      std::ranges::count_if(count, [](const auto& e) { return e.second % 2 == 1; }));
}

TEST(ErrorSelection, HasAsManyTrianglesAsAllowed) {
  for (const auto& [name, mesh] : test::all_families()) {
    const Selected it(mesh);
    const MultiTessellation& levels = it.model.levels;
    ErrorSelection selection(it.model.original, levels);
    std::uint32_t most = 1;
    for (std::size_t s = 0; s < levels.step_count(); ++s) most = std::max(most, levels.removed_by(s));
    const std::uint64_t coarsest = triangles_of(levels, Cut(levels.step_count(), 1));
    for (const double share : {0.0, 0.05, 0.35, 0.6, 1.0}) {
      LevelBudget budget;
      budget.triangles = static_cast<std::uint64_t>(share * static_cast<double>(levels.triangles));
      const Cut cut = it.cut(selection, camera_from({2, 3, 1.5}), budget);
      const std::uint64_t left = triangles_of(levels, cut);
      EXPECT_EQ(it.corners(cut).size(), 3 * left) << name;
      EXPECT_LE(left, std::max(budget.triangles, coarsest)) << name << " " << share;
      if (share < 1) {
        EXPECT_GE(left + most, budget.triangles) << name << " " << share;
      }
    }
  }
}

TEST(ErrorSelection, NoCracksAroundAnOrbit) {
  const Selected it(test::shuffled(test::torus(64, 32)));
  ErrorSelection selection(it.model.original, it.model.levels);
  ASSERT_EQ(odd_edges(it.corners(Cut(it.model.levels.step_count(), 0))), 0u);
  bool folds_are_possible = false;
  for (int i = 0; i < 24; ++i) {
    const double angle = i * 0.3;
    LevelBudget budget;
    budget.triangles = static_cast<std::uint64_t>(100 + 150 * i);
    const Cut cut = it.cut(
        selection, camera_from(it.center + Vec3d(2 * std::cos(angle), 0.5, 2 * std::sin(angle)), it.center),
        budget);
    folds_are_possible = folds_are_possible || !is_closed(it.model.levels, cut);
    EXPECT_EQ(odd_edges(it.corners(cut)), 0u) << i;
  }
  EXPECT_TRUE(folds_are_possible);  // or the test says nothing
}

/// Cracks of all levels along an orbit.
std::size_t cracks_around(const Leveled& model, std::initializer_list<double> shares) {
  Context context;
  const VertexHierarchy hierarchy = make_vertex_hierarchy(model.original, model.levels, context);
  const CrackFinder finder(hierarchy);
  ErrorSelection selection(model.original, model.levels);
  const Box box = bounds(model.original);
  std::size_t cracks = 0;
  for (const double share : shares) {
    LevelBudget budget;
    budget.triangles = static_cast<std::uint64_t>(share * static_cast<double>(model.levels.triangles));
    for (int i = 0; i < 12; ++i) {
      const double angle = i * 0.55, away = (0.3 + 0.1 * i) * box.diagonal();
      const Vec3d eye = box.center() + Vec3d(std::cos(angle), 0.3, std::sin(angle)) * away;
      selection.begin(camera_from(eye, box.center()), budget);
      selection.advance(selection.total_work());
      cracks += finder.count(selection.taken());
    }
  }
  return cracks;
}

// Surfaces in any disorder, sheets that pass through each other or lie on each other among them.
TEST(ErrorSelection, NoCracksInAnyModel) {
  for (std::uint64_t seed = 1; seed <= 150; ++seed) {
    for (const Placement placement : {Placement::optimal, Placement::half_edge}) {
      test::Choices choices(seed);
      const Leveled model = leveled(test::any_model(choices), 0, 1, placement);
      if (bounds(model.original).empty()) continue;
      EXPECT_EQ(cracks_around(model, {0.1, 0.35, 0.6}), 0u) << seed;
    }
  }
}

TEST(ErrorSelection, NoCracksInARealModelOfManySheets) {
  const auto path = test::corpus_file("textured/AcousticGuitar.glb");
  if (!path) GTEST_SKIP() << "FOVEA_DATA is not set";
  Context context;
  Model guitar = read_model(*path, {}, context);
  EXPECT_EQ(cracks_around(leveled(std::move(guitar), 100), {0.02, 0.05, 0.35}), 0u);
}

TEST(ErrorSelection, WhatIsAllInSightIsACut) {
  // One side of a sheet.
  const Selected it(test::shuffled(test::grid(40, 40)));
  ErrorSelection selection(it.model.original, it.model.levels);
  LevelBudget budget;
  budget.triangles = 700;
  const Cut cut = it.cut(selection, camera_from(it.center + Vec3d(0.1, 0, 4), it.center), budget);
  EXPECT_TRUE(is_closed(it.model.levels, cut));
}

TEST(ErrorSelection, ErrorsInPixels) {
  const Selected it(test::shuffled(test::torus(48, 24)));
  const MultiTessellation& levels = it.model.levels;
  ErrorSelection selection(it.model.original, levels, {}, {.unseen = 1});
  LevelBudget budget;
  budget.error_px = 1.5;
  const LevelCamera camera = camera_from({0, 0, 5});
  const Cut cut = it.cut(selection, camera, budget);
  EXPECT_EQ(selection.bound_px(), 1.5);
  // No error is smaller on the screen than from the farthest point.
  const double pixels = camera.height / (2 * camera.view.half_height);
  const double reach = bounds(it.model.original).diagonal();
  std::size_t taken = 0;
  for (std::size_t s = 0; s < cut.size(); ++s) {
    if (cut[s] == 0) continue;
    EXPECT_LE(levels.error[s] * pixels / (5 + reach), 1.5);
    ++taken;
  }
  EXPECT_GT(taken, 0u);
  EXPECT_LT(taken, cut.size());
  // From farther away more steps are too small to see.
  const Cut far = it.cut(selection, camera_from({0, 0, 50}), budget);
  EXPECT_LT(triangles_of(levels, far), triangles_of(levels, cut) / 2);
}

TEST(ErrorSelection, NearIsFinerThanFar) {
  const Selected it(test::shuffled(test::torus(64, 32)));
  ErrorSelection selection(it.model.original, it.model.levels, {}, {.unseen = 1});
  const double width = bounds(it.model.original).high.x - bounds(it.model.original).low.x;
  LevelBudget budget;
  budget.triangles = it.model.levels.triangles / 4;
  const auto [far, near] =
      it.sides(it.cut(selection, camera_from(it.center + Vec3d(0.8 * width, 0, 0), it.center), budget));
  EXPECT_GT(near, 1.3 * static_cast<double>(far));
}

TEST(ErrorSelection, WhatIsTurnedAwayCountsLess) {
  const Selected it(test::shuffled(test::torus(64, 32)));
  const LevelCamera camera = camera_from(it.center + Vec3d(100, 0, 0), it.center);  // all equally far
  LevelBudget budget;
  budget.triangles = it.model.levels.triangles / 4;
  const auto away_share = [&](double unseen) {
    ErrorSelection selection(it.model.original, it.model.levels, {}, {.unseen = unseen});
    const std::vector<Vec3f> c = it.corners(it.cut(selection, camera, budget));
    std::size_t away = 0;
    for (std::size_t i = 0; i < c.size(); i += 3) away += cross(c[i + 1] - c[i], c[i + 2] - c[i]).x < 0;
    return 3 * static_cast<double>(away) / static_cast<double>(c.size());
  };
  EXPECT_NEAR(away_share(1), 0.5, 0.05);
  EXPECT_LT(away_share(0), 0.75 * away_share(1));
}

TEST(ErrorSelection, ImportanceKeepsAndLocks) {
  const Selected it(test::shuffled(test::torus(48, 24)));
  const TriMesh& mesh = it.model.original.meshes[0].surface;
  Importance importance{VertexField(mesh.vertex_count(), 1.0f)};
  const auto middle = static_cast<float>(it.center.x);
  for (std::size_t v = 0; v < mesh.vertex_count(); ++v) {
    if (mesh.positions[v].x < middle) importance[0][VertexId{v}] = 100;
  }
  LevelBudget budget;
  budget.triangles = it.model.levels.triangles / 4;
  const LevelCamera camera = camera_from({0, 0, 100});
  ErrorSelection weighed(it.model.original, it.model.levels, importance, {.unseen = 1});
  const auto [heavy, light] = it.sides(it.cut(weighed, camera, budget));
  EXPECT_GT(heavy, 1.1 * static_cast<double>(light));

  for (float& w : importance[0].values()) w = w > 1 ? std::numeric_limits<float>::infinity() : w;
  ErrorSelection locked(it.model.original, it.model.levels, importance);
  budget.triangles = 0;
  std::set<std::array<float, 3>> left;
  for (const Vec3f c : it.corners(it.cut(locked, camera, budget))) left.insert({c.x, c.y, c.z});
  for (const Vec3f p : mesh.positions) {
    if (p.x < middle) {
      EXPECT_TRUE(left.contains({p.x, p.y, p.z}));
    }
  }
}

TEST(ErrorSelection, InPiecesIsTheSame) {
  const Selected it(test::shuffled(test::torus(48, 24)));
  ErrorSelection selection(it.model.original, it.model.levels);
  LevelBudget budget;
  budget.triangles = 500;
  const LevelCamera camera = camera_from({0, 2, 5});
  EXPECT_EQ(it.cut(selection, camera, budget, 101), it.cut(selection, camera, budget));
}

TEST(ErrorSelection, ParallelProjectionsAreAlikeFromAnyDistance) {
  const Selected it(test::shuffled(test::torus(48, 24)));
  ErrorSelection selection(it.model.original, it.model.levels);
  LevelBudget budget;
  budget.triangles = 500;
  const auto from = [&](double distance) {
    LevelCamera camera{view_from({0, 0, distance}, {}, 0), 600, 600};
    camera.view.half_height = 2;
    return it.cut(selection, camera, budget);
  };
  EXPECT_EQ(from(16), from(1024));
}

TEST(ErrorSelection, WhatDoesNotFitIsRefused) {
  const Leveled model = leveled(test::model_of(test::torus(24, 12)), 0);
  EXPECT_THROW(ErrorSelection(model.original, model.levels, {}, {.unseen = 2}), Error);
  EXPECT_THROW(ErrorSelection(model.original, model.levels, {VertexField(3)}), Error);
  EXPECT_THROW(ErrorSelection(test::model_of(test::grid(3, 3)), model.levels), Error);
}

}  // namespace
}  // namespace fovea
