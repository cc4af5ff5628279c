#include "fovea/simplify/simplify.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <map>
#include <set>

#include "fovea/base/error.h"
#include "support/by_quadrics.h"
#include "support/meshes.h"

namespace fovea {
namespace {

SimplifyResult run(const Model& model, const SimplifyOptions& options, const Importance& importance = {}) {
  Context context;
  context.threads = 1;
  SimplifyResult result = simplify(model, options, importance, context);
  for (const Mesh& mesh : result.model.meshes) check(mesh.surface);
  return result;
}

SimplifyResult run_ratio(const Model& model, double ratio) {
  SimplifyOptions options = test::by_quadrics();
  options.ratio = ratio;
  return run(model, options);
}

const TriMesh& surface(const SimplifyResult& result, std::size_t m = 0) {
  return result.model.meshes[m].surface;
}

std::size_t boundary_edges(const TriMesh& mesh) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> count;
  for (const auto& t : mesh.triangles) {
    for (std::size_t k = 0; k < 3; ++k) ++count[std::minmax({t[k].value, t[(k + 1) % 3].value})];
  }
  std::size_t boundary = 0;
  for (const auto& [edge, faces] : count) boundary += faces == 1;
  return boundary;
}

double area(const TriMesh& mesh) {
  double sum = 0;
  for (const auto& t : mesh.triangles) {
    const auto p = [&](std::size_t k) { return Vec3d(mesh.positions[t[k].index()]); };
    sum += 0.5 * length(cross(p(1) - p(0), p(2) - p(0)));
  }
  return sum;
}

// --- Targets ---------------------------------------------------------------------------------------

TEST(Simplify, ReachesTheTriangleCountOnEveryFamily) {
  for (const auto& [name, mesh] : test::all_families()) {
    if (mesh.face_count() < 8) continue;
    const SimplifyResult result = run_ratio(test::model_of(mesh), 0.5);
    EXPECT_LE(result.triangles_after, mesh.face_count() / 2) << name;
    EXPECT_GT(result.triangles_after, 0u) << name;
    EXPECT_EQ(result.stop, StopReason::target) << name;
    EXPECT_EQ(result.triangles_after, surface(result).face_count()) << name;
  }
}

TEST(Simplify, KeepsEverythingAtRatioOne) {
  const TriMesh mesh = test::torus(16, 8);
  const SimplifyResult result = run_ratio(test::model_of(mesh), 1.0);
  EXPECT_EQ(surface(result).positions, mesh.positions);
  EXPECT_EQ(surface(result).triangles, mesh.triangles);
  EXPECT_TRUE(result.record.steps.empty());
}

TEST(Simplify, TheLargerOfTwoCountsWins) {
  SimplifyOptions options = test::by_quadrics();
  options.ratio = 0.5;
  options.triangles = 100;
  const SimplifyResult result = run(test::model_of(test::icosphere(3)), options);  // 1280 triangles
  EXPECT_EQ(result.triangles_target, 640u);
  EXPECT_LE(result.triangles_after, 640u);
  EXPECT_GE(result.triangles_after, 638u);
}

TEST(Simplify, StopsAtTheErrorBound) {
  SimplifyOptions options = test::by_quadrics();
  options.error = 0.01;
  const SimplifyResult result = run(test::model_of(test::icosphere(4)), options);
  EXPECT_EQ(result.stop, StopReason::error);
  EXPECT_LE(result.error_rel, 0.01);
  EXPECT_LT(result.triangles_after, result.triangles_before / 4);
  options.error = 0.001;
  EXPECT_GT(run(test::model_of(test::icosphere(4)), options).triangles_after, result.triangles_after);
}

TEST(Simplify, ErrorAbsIsInSceneUnits) {
  SimplifyOptions relative = test::by_quadrics(), absolute = test::by_quadrics();
  relative.error = 0.01;
  absolute.error_abs = 0.01 * 2 * std::sqrt(3.0);  // the unit sphere's box has diagonal 2 √3
  const Model model = test::model_of(test::icosphere(3));
  EXPECT_EQ(run(model, relative).triangles_after, run(model, absolute).triangles_after);
}

TEST(Simplify, AFlatSheetCostsNothing) {
  const SimplifyResult result = run_ratio(test::model_of(test::grid(20, 20)), 0.01);
  EXPECT_LE(result.triangles_after, 8u);
  EXPECT_LT(result.error_rel, 0.02);              // the pull towards old vertices counts a little: sqrt(1e-4)
  EXPECT_NEAR(area(surface(result)), 1.0, 1e-3);  // the pull rounds the corners by as little
}

TEST(Simplify, WithoutATargetThereIsAnError) {
  Context context;
  try {
    simplify(test::model_of(test::cube()), {}, {}, context);
    FAIL();
  } catch (const Error& e) {
    EXPECT_EQ(e.kind(), ErrorKind::usage);
    EXPECT_NE(e.hint().find("--ratio"), std::string::npos);
  }
}

TEST(Simplify, RefusesValuesOutOfRange) {
  Context context;
  SimplifyOptions options = test::by_quadrics();
  options.ratio = 1.5;
  EXPECT_THROW(simplify(test::model_of(test::cube()), options, {}, context), Error);
}

TEST(Simplify, AnEmptyModelIsDoneAtOnce) {
  const SimplifyResult result = run_ratio(Model{}, 0.5);
  EXPECT_EQ(result.triangles_after, 0u);
  EXPECT_EQ(result.stop, StopReason::target);
}

TEST(Simplify, SaysWhatIsInTheWay) {
  SimplifyOptions options = test::by_quadrics();
  options.triangles = 0;
  options.keep_topology = true;
  const SimplifyResult result = run(test::model_of(test::icosphere(1)), options);
  EXPECT_EQ(result.stop, StopReason::stuck);
  EXPECT_GT(result.blocked.edges, 0u);
  EXPECT_EQ(result.blocked.edges,
            result.blocked.topology + result.blocked.flip + result.blocked.locked + result.blocked.last);
  EXPECT_GT(result.blocked.last, 0u);
}

TEST(Simplify, CancellingGivesTheLevelReached) {
  Context context;
  int calls = 0;
  context.progress = [&](std::string_view, double) { return ++calls < 2; };
  SimplifyOptions options = test::by_quadrics();
  options.ratio = 0.001;
  const SimplifyResult result = simplify(test::model_of(test::icosphere(6)), options, {}, context);
  EXPECT_EQ(result.stop, StopReason::cancelled);
  EXPECT_LT(result.triangles_after, result.triangles_before);
  EXPECT_GT(result.triangles_after, result.triangles_before / 1000);
  check(surface(result));
}

// --- Shape -----------------------------------------------------------------------------------------

TEST(Simplify, ASphereStaysASphere) {
  const SimplifyResult result = run_ratio(test::model_of(test::icosphere(4)), 0.1);  // 512 triangles
  EXPECT_EQ(boundary_edges(surface(result)), 0u);
  for (const Vec3f& p : surface(result).positions) {
    // An inscribed polyhedron of 512 triangles deviates by about 2π / (512 · √3) ≈ 0.7 %.
    EXPECT_NEAR(length(Vec3d(p)), 1.0, 0.02);
  }
}

TEST(Simplify, NoTriangleTurnsInwards) {
  const SimplifyResult result = run_ratio(test::model_of(test::icosphere(4)), 0.02);
  const TriMesh& mesh = surface(result);
  for (const auto& t : mesh.triangles) {
    const Vec3d a(mesh.positions[t[0].index()]), b(mesh.positions[t[1].index()]),
        c(mesh.positions[t[2].index()]);
    EXPECT_GT(dot(cross(b - a, c - a), a + b + c), 0);
  }
}

TEST(Simplify, HalfEdgeKeepsOriginalVertices) {
  const TriMesh mesh = test::wavy_grid(16, 16, 0.1);
  std::set<std::array<float, 3>> original;
  for (const Vec3f& p : mesh.positions) original.insert({p.x, p.y, p.z});
  SimplifyOptions options = test::by_quadrics();
  options.ratio = 0.2;
  options.placement = Placement::half_edge;
  const SimplifyResult result = run(test::model_of(mesh), options);
  for (const Vec3f& p : surface(result).positions) {
    EXPECT_TRUE(original.contains({p.x, p.y, p.z}));
  }
}

TEST(Simplify, OptimalPlacementIsCloserThanHalfEdge) {
  SimplifyOptions options = test::by_quadrics();
  options.ratio = 0.1;
  const Model model = test::model_of(test::icosphere(4));
  const double optimal = run(model, options).error_rel;
  options.placement = Placement::half_edge;
  EXPECT_LT(optimal, run(model, options).error_rel);
}

TEST(Simplify, DoesNotDependOnPlaceOrSize) {
  const TriMesh mesh = test::wavy_grid(24, 24, 0.1);
  TriMesh moved = mesh;
  // Powers of two keep every bit, so that the same collapses must follow.
  for (Vec3f& p : moved.positions) p = p * 64.0f;
  const SimplifyResult a = run_ratio(test::model_of(mesh), 0.1), b = run_ratio(test::model_of(moved), 0.1);
  ASSERT_EQ(a.record.steps.size(), b.record.steps.size());
  EXPECT_EQ(surface(a).triangles, surface(b).triangles);
  EXPECT_NEAR(a.error_rel, b.error_rel, 1e-6);
}

TEST(Simplify, SameBytesForAnyNumberOfThreads) {
  const Model model = test::model_of({test::torus(64, 32), test::wavy_grid(50, 50, 0.05)});
  SimplifyOptions options = test::by_quadrics();
  options.ratio = 0.1;
  Context one, four;
  one.threads = 1;
  four.threads = 4;
  const SimplifyResult a = simplify(model, options, {}, one), b = simplify(model, options, {}, four);
  for (std::size_t m = 0; m < 2; ++m) {
    EXPECT_EQ(surface(a, m).positions, surface(b, m).positions);
    EXPECT_EQ(surface(a, m).triangles, surface(b, m).triangles);
    EXPECT_EQ(surface(a, m).layers[0].values, surface(b, m).layers[0].values);
  }
}

// --- Boundaries and seams --------------------------------------------------------------------------

TEST(Simplify, AnOpenBoundaryIsSimplifiedAndStaysInPlace) {
  const SimplifyResult result = run_ratio(test::model_of(test::open_cylinder(64, 32)), 0.05);
  const TriMesh& mesh = surface(result);
  const Box box = bounds(mesh);
  // Both rims stay in their planes (z = ±1 up to the compromise with the pull inwards).
  EXPECT_NEAR(box.low.z, bounds(test::open_cylinder(64, 32)).low.z, 0.02);
  EXPECT_NEAR(box.high.z, bounds(test::open_cylinder(64, 32)).high.z, 0.02);
  EXPECT_GT(boundary_edges(mesh), 8u);
  EXPECT_LT(boundary_edges(mesh), 128u);
}

TEST(Simplify, LockBoundaryKeepsEveryBoundaryVertex) {
  SimplifyOptions options = test::by_quadrics();
  options.ratio = 0.05;
  options.lock_boundary = true;
  const SimplifyResult result = run(test::model_of(test::open_cylinder(32, 16)), options);
  EXPECT_EQ(boundary_edges(surface(result)), 64u);
}

TEST(Simplify, TextureFollowsTheSurfaceOnBothSidesOfASeam) {
  // On the cylinder u is the angle / 2π; the seam at angle 0 has u = 0 on one side and 1 on the other.
  const SimplifyResult result = run_ratio(test::model_of(test::open_cylinder(64, 32)), 0.1);
  const TriMesh& mesh = surface(result);
  const AttributeLayer* uv = mesh.find(Semantic::uv);
  ASSERT_NE(uv, nullptr);
  for (std::size_t c = 0; c < uv->corner_value.size(); ++c) {
    const Vec3f p = mesh.positions[mesh.vertex(CornerId{c}).index()];
    double angle = std::atan2(p.y, p.x) / (2 * M_PI);
    if (angle < 0) angle += 1;
    const double u = uv->value(uv->corner_value[c])[0];
    // Some 20 triangles go around, so that a linear map misses the angle by less than 0.01 of a turn.
    const double off = std::abs(u - angle);
    EXPECT_LT(std::min(off, std::abs(off - 1)), 0.02);
  }
}

/// A wavy sheet whose left and right halves are two charts with a gutter of 0.1 between them; the border
/// between the charts zigzags over the sheet.
TriMesh two_charts() {
  constexpr int kCells = 24;
  test::PartBuilder part;
  const auto is_left = [](int x, int y) { return x < kCells / 2 + (y % 4 < 2 ? 2 : -2); };
  const auto corner = [&](int x, int y, bool left) {
    const float s = static_cast<float>(x) / kCells, t = static_cast<float>(y) / kCells;
    const float z = 0.05f * std::sin(9 * s) * std::sin(7 * t);
    return part.vertex({s, t, z}, {left ? 0.75f * s : 0.35f + 0.75f * s, t});
  };
  for (int y = 0; y < kCells; ++y) {
    for (int x = 0; x < kCells; ++x) {
      const bool left = is_left(x, y);
      part.quad(corner(x, y, left), corner(x + 1, y, left), corner(x + 1, y + 1, left),
                corner(x, y + 1, left));
    }
  }
  return test::weld_part(part.part());
}

TEST(Simplify, NothingFromBetweenTheChartsOfATextureComesIn) {
  const TriMesh source = two_charts();
  const auto range = [](const TriMesh& mesh) {
    // Highest u of the left chart, lowest of the right: charts are told apart by where u is on x.
    const AttributeLayer& uv = *mesh.find(Semantic::uv);
    std::pair<double, double> edges{0, 1};
    for (std::size_t f = 0; f < mesh.face_count(); ++f) {
      double x = 0, u = 0;
      for (std::size_t c = 3 * f; c < 3 * f + 3; ++c) {
        x += mesh.positions[mesh.vertex(CornerId{c}).index()].x / 3;
        u += uv.value(uv.corner_value[c])[0] / 3;
      }
      const bool left = u < 0.75 * x + 0.175;
      for (std::size_t c = 3 * f; c < 3 * f + 3; ++c) {
        const double value = uv.value(uv.corner_value[c])[0];
        if (left) {
          edges.first = std::max(edges.first, value);
        } else {
          edges.second = std::min(edges.second, value);
        }
      }
    }
    return edges;
  };
  const auto [left, right] = range(source);
  for (const double ratio : {0.3, 0.1, 0.05}) {
    const auto [now_left, now_right] = range(surface(run_ratio(test::model_of(source), ratio)));
    EXPECT_LE(now_left, left + 1e-6) << ratio;
    EXPECT_GE(now_right, right - 1e-6) << ratio;
  }
}

TEST(Simplify, AChartThatEndsLeavesNoErrorBehind) {
  // A flat sheet with one quad whose texture lies elsewhere. Collapsing all of it moves nothing but that
  // quad's texture; what a chart's values made up for must not count as error once the chart is gone.
  constexpr int kCells = 12;
  test::PartBuilder part;
  const auto corner = [&](int x, int y, float offset) {
    const float s = static_cast<float>(x) / kCells, t = static_cast<float>(y) / kCells;
    return part.vertex({s, t, 0}, {s + offset, t});
  };
  for (int y = 0; y < kCells; ++y) {
    for (int x = 0; x < kCells; ++x) {
      const float offset = x == 5 && y == 6 ? 3.0f : 0.0f;
      part.quad(corner(x, y, offset), corner(x + 1, y, offset), corner(x + 1, y + 1, offset),
                corner(x, y + 1, offset));
    }
  }
  SimplifyOptions options = test::by_quadrics();
  options.ratio = 0.02;
  options.seam_weight = 0;  // nothing but values
  const SimplifyResult result = run(test::model_of(test::weld_part(part.part())), options);
  EXPECT_EQ(result.stop, StopReason::target);
  // A slide by three quads counts as 0.018 of that; what the island's values made up for is twice as much.
  EXPECT_LT(result.error_rel, 0.018 * 3 / kCells / std::sqrt(2.0));
}

TEST(Simplify, NoTriangleTurnsOverInTheTexture) {
  for (const auto& [name, mesh] : test::all_families()) {
    if (mesh.face_count() < 16 || mesh.find(Semantic::uv) == nullptr) continue;
    const auto flipped = [](const TriMesh& m) {
      const AttributeLayer& uv = *m.find(Semantic::uv);
      std::size_t count = 0;
      for (std::size_t f = 0; f < m.face_count(); ++f) {
        const float *a = uv.value(uv.corner_value[3 * f]), *b = uv.value(uv.corner_value[3 * f + 1]),
                    *c = uv.value(uv.corner_value[3 * f + 2]);
        count += (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]) < 0;
      }
      return count;
    };
    if (flipped(mesh) > 0) continue;  // mirrored on purpose
    EXPECT_EQ(flipped(surface(run_ratio(test::model_of(mesh), 0.2))), 0u) << name;
  }
}

TEST(Simplify, AMirroredTextureStaysMirrored) {
  const SimplifyResult result = run_ratio(test::model_of(test::mirrored_strip(16)), 0.25);
  const TriMesh& mesh = surface(result);
  const AttributeLayer& uv = *mesh.find(Semantic::uv);
  std::size_t sides[2] = {0, 0};
  for (std::size_t f = 0; f < mesh.face_count(); ++f) {
    const float *a = uv.value(uv.corner_value[3 * f]), *b = uv.value(uv.corner_value[3 * f + 1]),
                *c = uv.value(uv.corner_value[3 * f + 2]);
    ++sides[(b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]) < 0];
  }
  EXPECT_GT(sides[0], 0u);
  EXPECT_GT(sides[1], 0u);
}

TEST(Simplify, MaterialsKeepTheirArea) {
  const SimplifyResult result = run_ratio(test::model_of(test::two_part_grid(20, 20)), 0.05);
  const TriMesh& mesh = surface(result);
  double part_area[2] = {0, 0};
  for (std::size_t f = 0; f < mesh.face_count(); ++f) {
    const auto p = [&](std::size_t k) { return Vec3d(mesh.positions[mesh.triangles[f][k].index()]); };
    part_area[mesh.face_part[f]] += 0.5 * length(cross(p(1) - p(0), p(2) - p(0)));
  }
  EXPECT_NEAR(part_area[0], 0.5, 0.01);
  EXPECT_NEAR(part_area[1], 0.5, 0.01);
}

TEST(Simplify, NormalsAreUnitAndFollowTheSurface) {
  const SimplifyResult result = run_ratio(test::model_of(test::icosphere(4)), 0.1);
  const TriMesh& mesh = surface(result);
  const AttributeLayer& normal = *mesh.find(Semantic::normal);
  for (std::size_t c = 0; c < normal.corner_value.size(); ++c) {
    const float* n = normal.value(normal.corner_value[c]);
    const Vec3d unit{n[0], n[1], n[2]};
    EXPECT_NEAR(length(unit), 1, 1e-5);
    EXPECT_GT(dot(unit, normalized(Vec3d(mesh.positions[mesh.vertex(CornerId{c}).index()]))), 0.98);
  }
}

TEST(Simplify, TangentsAreUnitAndKeepTheirSide) {
  // They turn by a right angle along the strip, so that mixed ones are shorter than one.
  test::PartBuilder builder(-1, true, true);
  VertexArray tangents;
  tangents.semantic = Semantic::tangent;
  tangents.width = 4;
  constexpr int kQuads = 16;
  for (int i = 0; i <= kQuads; ++i) {
    const float x = static_cast<float>(i) / kQuads, angle = 1.5f * x;
    for (const float y : {0.0f, 1.0f}) {
      builder.vertex({x, y, 0}, {x, y});
      tangents.values.insert(tangents.values.end(), {std::cos(angle), std::sin(angle), 0, -1});
    }
  }
  for (std::uint32_t i = 0; i < kQuads; ++i) builder.quad(2 * i, 2 * i + 2, 2 * i + 3, 2 * i + 1);
  builder.part().attributes.push_back(tangents);
  const SimplifyResult result = run_ratio(test::model_of(test::weld_part(builder.part())), 0.2);
  const AttributeLayer& layer = *surface(result).find(Semantic::tangent);
  for (std::size_t i = 0; i < layer.size(); ++i) {
    const float* t = layer.value(ValueId{i});
    EXPECT_NEAR(length(Vec3d{t[0], t[1], t[2]}), 1, 1e-5);
    EXPECT_EQ(t[3], -1);
  }
}

TEST(Simplify, WhatLiesOnEachOtherIsNotLost) {
  // Every triangle of a ball twice, once either way round.
  Model model = test::model_of(test::icosphere(1));
  TriMesh& mesh = model.meshes[0].surface;
  for (std::size_t f = mesh.face_count(); f-- > 0;) {
    auto [a, b, c] = mesh.triangles[f];
    mesh.triangles.push_back({a, c, b});
    mesh.face_part.push_back(0);
    for (AttributeLayer& layer : mesh.layers) {
      for (const std::size_t k : {0, 2, 1}) layer.corner_value.push_back(layer.corner_value[3 * f + k]);
    }
  }
  EXPECT_GT(run_ratio(model, 0).triangles_after, 0u);
}

// --- Importance ------------------------------------------------------------------------------------

TEST(Simplify, ImportanceKeepsTriangles) {
  const TriMesh mesh = test::wavy_grid(40, 40, 0.05);
  VertexField field(mesh.vertex_count(), 1.0f);
  for (std::size_t v = 0; v < mesh.vertex_count(); ++v) {
    if (mesh.positions[v].x < 0.5f) field[VertexId{v}] = 100.0f;
  }
  SimplifyOptions options = test::by_quadrics();
  options.ratio = 0.2;
  const auto left = [](const TriMesh& m) {
    return std::count_if(m.positions.begin(), m.positions.end(), [](Vec3f p) { return p.x < 0.5f; });
  };
  const SimplifyResult plain = run(test::model_of(mesh), options),
                       weighted = run(test::model_of(mesh), options, {field});
  EXPECT_GT(left(surface(weighted)), 3 * left(surface(plain)) / 2);
}

TEST(Simplify, InfiniteImportanceLocks) {
  const TriMesh mesh = test::icosphere(3);
  VertexField field(mesh.vertex_count(), 1.0f);
  std::vector<Vec3f> locked;
  for (std::size_t v = 0; v < mesh.vertex_count(); v += 20) {
    field[VertexId{v}] = std::numeric_limits<float>::infinity();
    locked.push_back(mesh.positions[v]);
  }
  SimplifyOptions options = test::by_quadrics();
  options.ratio = 0.1;
  const SimplifyResult result = run(test::model_of(mesh), options, {field});
  for (const Vec3f& p : locked) {
    EXPECT_EQ(std::count(surface(result).positions.begin(), surface(result).positions.end(), p), 1);
  }
}

TEST(Simplify, RefusesImportanceOfTheWrongSizeOrSign) {
  Context context;
  SimplifyOptions options = test::by_quadrics();
  options.ratio = 0.5;
  const Model model = test::model_of(test::cube());
  EXPECT_THROW(simplify(model, options, {VertexField(3, 1.0f)}, context), Error);
  EXPECT_THROW(simplify(model, options, {VertexField(8, -1.0f)}, context), Error);
  EXPECT_THROW(simplify(model, options, {VertexField(8, std::nanf(""))}, context), Error);
  EXPECT_THROW(simplify(model, options, {VertexField(8, 1.0f), VertexField(8, 1.0f)}, context), Error);
}

// --- Scenes ----------------------------------------------------------------------------------------

TEST(Simplify, TrianglesGoWhereTheSceneNeedsThem) {
  // The same wavy sheet twice, once a hundredth of the size: the small one gives its triangles away.
  Model model = test::model_of({test::wavy_grid(30, 30, 0.1), test::wavy_grid(30, 30, 0.1)});
  for (Node& node : model.nodes) {
    if (node.mesh == 1) node.scale = {0.01, 0.01, 0.01};
  }
  const SimplifyResult scene = run_ratio(model, 0.3);
  EXPECT_GT(surface(scene, 0).face_count(), 5 * surface(scene, 1).face_count());
  SimplifyOptions options = test::by_quadrics();
  options.ratio = 0.3;
  options.per_mesh = true;
  const SimplifyResult apart = run(model, options);
  EXPECT_EQ(surface(apart, 0).face_count(), surface(apart, 1).face_count());
}

TEST(Simplify, SmallComponentsVanishWhenTheirErrorSaysSo) {
  Model model = test::model_of(test::tetrahedra(8));  // sizes 1, 1/2, … 1/128
  SimplifyOptions options = test::by_quadrics();
  options.triangles = 12;
  const SimplifyResult result = run(model, options);
  EXPECT_EQ(result.triangles_after, 12u);
  // The three largest are left: the smallest size is 1/4.
  EXPECT_GT(bounds(surface(result)).diagonal(), 0.9 * bounds(test::tetrahedra(3)).diagonal());
  options.keep_topology = true;
  EXPECT_EQ(run(model, options).stop, StopReason::stuck);
}

TEST(Simplify, NeverLosesTheLastComponent) {
  const SimplifyResult result = run_ratio(test::model_of(test::tetrahedra(3)), 0.0);
  EXPECT_GT(result.triangles_after, 0u);
  EXPECT_EQ(result.stop, StopReason::stuck);
}

// --- Animation -------------------------------------------------------------------------------------

TEST(Simplify, InfluencesStayNormalisedAndFollowTheSurface) {
  const SimplifyResult result = run_ratio(test::skinned_model(32), 0.25);
  const TriMesh& mesh = surface(result);
  const AttributeLayer &joints = *mesh.find(Semantic::joints), &weights = *mesh.find(Semantic::weights);
  const Box box = bounds(mesh);
  for (std::size_t c = 0; c < weights.corner_value.size(); ++c) {
    const float *j = joints.value(joints.corner_value[c]), *w = weights.value(weights.corner_value[c]);
    float sum = 0, second = 0;
    for (int k = 0; k < weights.width; ++k) {
      sum += w[k];
      if (j[k] == 1) second += w[k];
    }
    EXPECT_NEAR(sum, 1, 1e-5);
    // Weights run linearly along x; mixing along edges keeps them so.
    const double x = mesh.positions[mesh.vertex(CornerId{c}).index()].x;
    EXPECT_NEAR(second, (x - box.low.x) / (box.high.x - box.low.x), 0.02);
  }
}

TEST(Simplify, MorphTargetsFollowTheSurface) {
  const SimplifyResult result = run_ratio(test::model_of(test::morph_strip(64)), 0.25);
  const TriMesh& mesh = surface(result);
  ASSERT_EQ(mesh.target_count(), 2u);
  for (std::size_t v = 0; v < mesh.vertex_count(); ++v) {
    const double x = mesh.positions[v].x;
    // z = x² / 64 over [0, 64]; straight pieces of length h miss by h² / (8 · 64), which is 1 for the
    // mean piece of 8 · 64 / 16 and a few times that for longer ones.
    EXPECT_NEAR(mesh.position_morphs[0][v].z, x * x / 64, 2);
  }
}

}  // namespace
}  // namespace fovea
