#include "fovea/budget/height_field.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>
#include <vector>

#include "fovea/base/error.h"
#include "fovea/base/random.h"
#include "fovea/io/read.h"
#include "fovea/io/write.h"
#include "fovea/sample/sample.h"
#include "fovea/surface/topology.h"
#include "support/meshes.h"
#include "support/reading.h"
#include "support/textured.h"

namespace fovea {
namespace {

using testing::HasSubstr;

/// Land on x and z as `grid` has it on x and y, with heights along y.
TriMesh land(int columns, int rows, std::uint64_t seed, double amplitude = 0.3) {
  TriMesh mesh = test::grid(columns - 1, rows - 1);
  Random random(seed);
  for (Vec3f& p : mesh.positions) {
    const double hill = std::sin(5 * static_cast<double>(p.x)) * std::cos(4 * static_cast<double>(p.y));
    p = {p.x, static_cast<float>(amplitude * (hill + random.uniform())), -p.y};
  }
  return mesh;
}

HeightField field_of(const TriMesh& mesh) {
  HeightFieldSearch search = find_height_field(test::model_of(mesh));
  EXPECT_EQ(search.why_not, "");
  return std::move(*search.field);
}

/// A vertex's place in the grid of a field whose points are known by their positions.
struct Place {
  int x = 0, y = 0;
  friend auto operator<=>(const Place&, const Place&) = default;
};
std::vector<Place> places(const HeightField& field, const TriMesh& level) {
  std::map<std::tuple<float, float, float>, Place> known;
  for (int y = 0; y < field.rows; ++y) {
    for (int x = 0; x < field.columns; ++x) {
      const Vec3f p = field.points[static_cast<std::size_t>(y * field.columns + x)];
      known[{p.x, p.y, p.z}] = {x, y};
    }
  }
  std::vector<Place> result;
  for (const Vec3f p : level.positions) result.push_back(known.at({p.x, p.y, p.z}));
  return result;
}

std::int64_t doubled_area(Place a, Place b, Place c) {
  return std::int64_t{b.x - a.x} * (c.y - a.y) - std::int64_t{b.y - a.y} * (c.x - a.x);
}

/// Slowly: all triangles turn the same way, they fill the grid, and no vertex lies inside of an edge.
void expect_no_cracks(const HeightField& field, const TriMesh& level) {
  const std::vector<Place> at = places(field, level);
  std::int64_t area = 0;
  for (const auto& t : level.triangles) {
    const Place a = at[t[0].index()], b = at[t[1].index()], c = at[t[2].index()];
    const std::int64_t part = (field.turned ? -1 : 1) * doubled_area(a, b, c);
    ASSERT_GT(part, 0);
    area += part;
    for (const auto& [p, q] : {std::pair{a, b}, {b, c}, {c, a}}) {
      for (const Place v : at) {
        if (doubled_area(p, q, v) != 0 || v == p || v == q) continue;
        const bool between = std::min(p.x, q.x) <= v.x && v.x <= std::max(p.x, q.x) &&
                             std::min(p.y, q.y) <= v.y && v.y <= std::max(p.y, q.y);
        ASSERT_FALSE(between) << "a T-junction";
      }
    }
  }
  ASSERT_EQ(area, std::int64_t{2} * (field.columns - 1) * (field.rows - 1));
}

/// The largest distance along y that a point of the field has from a level, slowly.
double largest_distance(const HeightField& field, const TriMesh& level) {
  const std::vector<Place> at = places(field, level);
  double largest = 0;
  for (int y = 0; y < field.rows; ++y) {
    for (int x = 0; x < field.columns; ++x) {
      const double height = field.points[static_cast<std::size_t>(y * field.columns + x)].y;
      double nearest = 1e9;
      for (const auto& t : level.triangles) {
        const Place a = at[t[0].index()], b = at[t[1].index()], c = at[t[2].index()], p{x, y};
        const auto whole = static_cast<double>(doubled_area(a, b, c));
        const double u = static_cast<double>(doubled_area(p, b, c)) / whole,
                     v = static_cast<double>(doubled_area(a, p, c)) / whole, w = 1 - u - v;
        if (u < -1e-9 || v < -1e-9 || w < -1e-9) continue;
        const double flat = u * level.positions[t[0].index()].y + v * level.positions[t[1].index()].y +
                            w * level.positions[t[2].index()].y;
        nearest = std::min(nearest, std::abs(flat - height));
      }
      largest = std::max(largest, nearest);
    }
  }
  return largest;
}

TEST(HeightField, ReadsTheGridOfAModel) {
  const TriMesh mesh = land(6, 4, 1);
  Model model = test::textured(mesh, 1);
  model.nodes[0].translation = {1, 2, 3};
  const HeightFieldSearch search = find_height_field(model);
  ASSERT_TRUE(search.field) << search.why_not;
  const HeightField& field = *search.field;
  EXPECT_EQ(field.columns, 6);
  EXPECT_EQ(field.rows, 4);
  EXPECT_EQ(field.up, 1);
  EXPECT_EQ(field.other_faces, 0u);
  EXPECT_EQ(field.to_world(1, 3), 2);
  const TriMesh level = QuadtreeLevels(field, HeightError::largest)
                            .level(QuadtreeLevels(field, HeightError::largest).split_count());
  EXPECT_NO_THROW(check(level));
  EXPECT_EQ(level.face_count(), mesh.face_count());
  EXPECT_EQ(level.vertex_count(), mesh.vertex_count());
  // Texture coordinates come along: of `grid` they are (x, y).
  const AttributeLayer& uv = *level.find(Semantic::uv);
  for (std::uint32_t c = 0; c < 3 * level.face_count(); ++c) {
    const Vec3f p = level.positions[level.vertex(CornerId{c}).index()];
    EXPECT_EQ(uv.value(uv.corner_value[c])[0], p.x);
    EXPECT_EQ(uv.value(uv.corner_value[c])[1], -p.z);
  }
  const Model simple = with_level(model, field, level);
  EXPECT_EQ(simple.nodes[0].translation, model.nodes[0].translation);
  EXPECT_EQ(simple.images, model.images);
}

TEST(HeightField, AlongAnyAxisAndShuffled) {
  for (int turn = 0; turn < 3; ++turn) {
    TriMesh mesh = land(9, 5, 7);
    for (Vec3f& p : mesh.positions) {
      for (int i = 0; i < turn; ++i) p = {p.z, p.x, p.y};
    }
    const HeightField field = field_of(test::shuffled(mesh));
    EXPECT_EQ(field.up, (1 + turn) % 3);
    const QuadtreeLevels levels(field, HeightError::largest);
    const TriMesh whole = levels.level(levels.split_count());
    Vec3d sum, original;
    const auto area = [](const TriMesh& m, Vec3d& total) {
      for (const auto& t : m.triangles) {
        const Vec3d a(m.positions[t[0].index()]);
        total += cross(Vec3d(m.positions[t[1].index()]) - a, Vec3d(m.positions[t[2].index()]) - a);
      }
    };
    area(whole, sum);
    area(mesh, original);
    // The sum of normals of a surface with this rim, whichever way its cells are cut; so it is not turned
    // over.
    EXPECT_LT(length(sum - original), 1e-5);
  }
}

TEST(HeightField, SaysWhyAModelIsNone) {
  const auto why = [](const Model& model) { return find_height_field(model).why_not; };
  EXPECT_THAT(why(test::model_of(test::icosphere(2))), HasSubstr("regular grid"));
  EXPECT_THAT(why(test::model_of({test::grid(2, 2), test::grid(2, 2)})), HasSubstr("more than one mesh"));
  EXPECT_THAT(why(test::model_of(std::vector<TriMesh>{})), HasSubstr("no triangles"));
  EXPECT_THAT(why(test::skinned_model(4)), HasSubstr("moves"));
  EXPECT_THAT(why(test::model_of(test::two_part_grid(4, 4))), HasSubstr("several materials"));
  TriMesh bent = land(5, 5, 1);
  bent.positions[12].x += 0.1f;
  EXPECT_THAT(why(test::model_of(bent)), HasSubstr("regular grid"));
  TriMesh holed = land(5, 5, 1);
  holed.triangles.pop_back();
  holed.face_part.pop_back();
  for (AttributeLayer& layer : holed.layers) layer.corner_value.resize(3 * holed.face_count());
  EXPECT_THAT(why(test::model_of(holed)), HasSubstr("holes"));
  TriMesh doubled = land(5, 5, 1);
  doubled.triangles[1] = doubled.triangles[0];
  EXPECT_THAT(why(test::model_of(doubled)), HasSubstr("overlap"));
}

TEST(HeightField, OfABlockOnlyTheTopCounts) {
  const HeightField cube = field_of(test::cube());
  EXPECT_EQ(cube.columns, 2);
  EXPECT_EQ(cube.rows, 2);
  EXPECT_EQ(cube.other_faces, 10u);
}

TEST(HeightField, OfTheSampleAlsoFromAFileOfIntegers) {
  Context context;
  const Model sample = make_sample("terrain", 0.05, context);
  const test::TempFolder folder;
  WriteOptions options;
  options.quantize = true;
  write_model(sample, folder.path() / "land.glb", options, context);
  const Model read = read_model(folder.path() / "land.glb", {}, context);
  for (const Model* model : {&sample, &read}) {
    const HeightFieldSearch search = find_height_field(*model);
    ASSERT_TRUE(search.field) << search.why_not;
    EXPECT_EQ(search.field->columns, 46);  // 200 √0.05 cells
    EXPECT_EQ(search.field->rows, 46);
    EXPECT_EQ(search.field->layers.size(), 2u);
    EXPECT_EQ(search.field->other_faces, counts(*model).triangles - 2 * 45 * 45) << "walls and underside";
    const QuadtreeLevels levels(*search.field, HeightError::largest);
    const TriMesh level = levels.level(levels.splits_to(500));
    EXPECT_NO_THROW(check(level));
    expect_no_cracks(*search.field, level);
  }
}

class Grids : public testing::TestWithParam<std::array<int, 2>> {};

TEST_P(Grids, EveryLevelIsWithoutCracksAndAsNearAsItSays) {
  const auto [columns, rows] = GetParam();
  const HeightField field = field_of(land(columns, rows, 3));
  const QuadtreeLevels levels(field, HeightError::largest);
  const std::size_t stride = std::max<std::size_t>(1, levels.split_count() / 40);
  std::set<Place> before;
  for (std::size_t splits = 0; splits <= levels.split_count(); splits += stride) {
    const TriMesh level = levels.level(splits);
    EXPECT_NO_THROW(check(level));
    EXPECT_EQ(level.face_count(), levels.triangles_after(splits));
    expect_no_cracks(field, level);
    EXPECT_EQ(count_edges(level).non_manifold, 0u);
    EXPECT_LE(largest_distance(field, level), levels.error_after(splits) + 1e-6);
    const std::vector<Place> at = places(field, level);
    const std::set<Place> now(at.begin(), at.end());
    EXPECT_TRUE(std::ranges::includes(now, before)) << "a finer level keeps all vertices";
    before = now;
  }
  const TriMesh finest = levels.level(levels.split_count());
  EXPECT_EQ(finest.face_count(), static_cast<std::size_t>(2 * (columns - 1) * (rows - 1)));
  EXPECT_EQ(levels.error_after(levels.split_count()), 0);
}

INSTANTIATE_TEST_SUITE_P(Sizes, Grids,
                         testing::Values(std::array{2, 2}, std::array{3, 3}, std::array{17, 17},
                                         std::array{12, 7}, std::array{2, 9}, std::array{20, 20},
                                         std::array{18, 33}, std::array{5, 31}));

/// The restricted quadtree of a square grid, slowly: triangles in a list, of which those that are needed are
/// split, after their neighbours if these are larger.
class SlowQuadtree {
 public:
  using Corners = std::array<Place, 3>;  // the longest edge is the first two

  SlowQuadtree(const HeightField& field, double error) : field_(field) {
    const int side = field.columns - 1;
    triangles_ = {{Place{side, side}, Place{0, 0}, Place{side, 0}},
                  {Place{0, 0}, Place{side, side}, Place{0, side}}};
    collect(triangles_[0], error);
    collect(triangles_[1], error);
    for (const Place v : needed_) insert(v);
  }
  std::size_t size() const { return triangles_.size(); }

 private:
  static Place middle(const Corners& t) { return {(t[0].x + t[1].x) / 2, (t[0].y + t[1].y) / 2}; }
  static bool can_split(const Corners& t) {
    return std::abs(t[0].x - t[1].x) > 1 || std::abs(t[0].y - t[1].y) > 1;
  }
  static std::array<Corners, 2> halves(const Corners& t) {
    return {{{t[2], t[0], middle(t)}, {t[1], t[2], middle(t)}}};
  }
  double height(Place p) const {
    return field_.points[static_cast<std::size_t>(p.y * field_.columns + p.x)].y;
  }
  static bool contains(const Corners& t, Place p) {
    const auto whole = doubled_area(t[0], t[1], t[2]);
    for (const auto part :
         {doubled_area(p, t[1], t[2]), doubled_area(t[0], p, t[2]), doubled_area(t[0], t[1], p)}) {
      if (part * whole < 0) return false;
    }
    return true;
  }
  /// Middles of all triangles that a point is farther from than `error`.
  void collect(const Corners& t, double error) {
    if (!can_split(t)) return;
    const auto whole = static_cast<double>(doubled_area(t[0], t[1], t[2]));
    for (int y = 0; y < field_.rows; ++y) {
      for (int x = 0; x < field_.columns; ++x) {
        const Place p{x, y};
        if (!contains(t, p)) continue;
        const double flat = (static_cast<double>(doubled_area(p, t[1], t[2])) * height(t[0]) +
                             static_cast<double>(doubled_area(t[0], p, t[2])) * height(t[1]) +
                             static_cast<double>(doubled_area(t[0], t[1], p)) * height(t[2])) /
                            whole;
        if (std::abs(flat - height(p)) > error) needed_.insert(middle(t));
      }
    }
    for (const Corners& half : halves(t)) collect(half, error);
  }
  void insert(Place v) {
    while (true) {
      const auto around = std::ranges::find_if(triangles_, [&](const Corners& t) {
        return contains(t, v) && v != t[0] && v != t[1] && v != t[2];
      });
      if (around == triangles_.end()) return;
      split(*around);
    }
  }
  void split(Corners t) {
    while (true) {
      const auto neighbor = std::ranges::find_if(triangles_, [&](const Corners& o) {
        return o != t && std::ranges::count(o, t[0]) == 1 && std::ranges::count(o, t[1]) == 1;
      });
      const bool is_alone = neighbor == triangles_.end();
      if (!is_alone && middle(*neighbor) != middle(t)) {
        split(*neighbor);
        continue;
      }
      if (!is_alone) replace(*neighbor);
      replace(t);
      return;
    }
  }
  void replace(Corners t) {
    std::erase(triangles_, t);
    for (const Corners& half : halves(t)) triangles_.push_back(half);
  }

  const HeightField& field_;
  std::vector<Corners> triangles_;
  std::set<Place> needed_;
};

TEST(HeightField, AThresholdGivesTheRestrictedQuadtree) {
  for (const std::uint64_t seed : {1u, 2u, 3u}) {
    const HeightField field = field_of(land(17, 17, seed, 0.2));
    const QuadtreeLevels levels(field, HeightError::largest);
    for (const double error : {0.5, 0.3, 0.2, 0.15, 0.1, 0.05, 0.0}) {
      const std::size_t splits = levels.splits_for(error);
      EXPECT_EQ(levels.level(splits).face_count(), SlowQuadtree(field, error).size()) << seed << " " << error;
    }
  }
}

TEST(HeightField, NumbersOfTrianglesInGeometricProgression) {
  const HeightField field = field_of(land(65, 65, 5));
  for (const HeightError error : {HeightError::largest, HeightError::squares}) {
    const QuadtreeLevels levels(field, error);
    for (double triangles = 8192; triangles >= 2; triangles /= 1.5) {
      const std::size_t splits = levels.splits_to(static_cast<std::uint64_t>(triangles));
      const auto got = static_cast<double>(levels.level(splits).face_count());
      EXPECT_LE(got, triangles);
      EXPECT_GT(got, triangles - 2) << "a split adds two at most";
    }
    EXPECT_EQ(levels.splits_to(0), 0u);
  }
}

TEST(HeightField, WithoutWeightNothingIsSplit) {
  const HeightField field = field_of(land(33, 33, 5));
  std::vector<float> weights(field.points.size(), 0.0f);
  for (std::size_t i = 0; i < weights.size(); ++i) weights[i] = i % 33 < 16 ? 1.0f : 0.0f;
  const QuadtreeLevels levels(field, HeightError::squares, weights);
  const TriMesh level = levels.level(levels.splits_for(0));
  const auto right = std::ranges::count_if(places(field, level), [](Place p) { return p.x > 17; });
  const auto left = std::ranges::count_if(places(field, level), [](Place p) { return p.x < 16; });
  EXPECT_EQ(left, 16 * 33);
  EXPECT_LT(right, 60) << "what the other half needs";
  expect_no_cracks(field, level);
  EXPECT_THROW(QuadtreeLevels(field, HeightError::squares, std::vector<float>(3)), Error);
}

}  // namespace
}  // namespace fovea
