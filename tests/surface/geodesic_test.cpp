#include "fovea/surface/geodesic.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>

#include "fovea/base/random.h"
#include "oracle/geodesic_oracle.h"
#include "support/meshes.h"

namespace fovea {
namespace {

constexpr double kNever = std::numeric_limits<double>::infinity();

/// Distances from one vertex; infinite where the radius does not reach.
std::vector<double> distances(const Surface& surface, std::uint32_t source, double radius = 1e9) {
  const Context context;
  const Adjacency adjacency(surface, context);
  const GeodesicSurface prepared(surface, adjacency, context);
  GeodesicSearch search(prepared);
  std::vector<double> result(surface.positions.size(), kNever);
  for (const auto& [vertex, distance] : search.from(source, radius)) {
    EXPECT_EQ(result[vertex], kNever) << "reported once";
    result[vertex] = distance;
  }
  return result;
}

/// A grid of squares in the plane [0, columns] × [0, rows], without those that `left_out` names.
Surface sheet(int columns, int rows, const std::function<bool(int, int)>& left_out = {}) {
  Surface surface;
  for (int y = 0; y <= rows; ++y) {
    for (int x = 0; x <= columns; ++x)
      surface.positions.push_back({static_cast<float>(x), static_cast<float>(y), 0});
  }
  const auto at = [&](int x, int y) { return static_cast<std::uint32_t>(y * (columns + 1) + x); };
  for (int y = 0; y < rows; ++y) {
    for (int x = 0; x < columns; ++x) {
      if (left_out && left_out(x, y)) continue;
      surface.triangles.push_back({at(x, y), at(x + 1, y), at(x + 1, y + 1)});
      surface.triangles.push_back({at(x, y), at(x + 1, y + 1), at(x, y + 1)});
    }
  }
  return surface;
}

TEST(Geodesic, InThePlaneItIsTheStraightLine) {
  const Surface surface = sheet(12, 9);
  for (const std::uint32_t source : {0u, 5u, 58u, 129u}) {
    const std::vector<double> d = distances(surface, source);
    for (std::uint32_t v = 0; v < d.size(); ++v)
      EXPECT_NEAR(d[v], length(surface.position(v) - surface.position(source)), 1e-12)
          << source << " to " << v;
  }
}

TEST(Geodesic, StopsAtTheRadius) {
  const Surface surface = sheet(12, 9);
  const std::vector<double> d = distances(surface, 58, 3.5);
  int reached = 0;
  for (std::uint32_t v = 0; v < d.size(); ++v) {
    const double straight = length(surface.position(v) - surface.position(58));
    EXPECT_EQ(d[v] < kNever, straight <= 3.5) << v;
    if (d[v] < kNever) {
      EXPECT_NEAR(d[v], straight, 1e-12);
      ++reached;
    }
  }
  EXPECT_EQ(reached, 37);  // points of the integer grid within 3.5
}

TEST(Geodesic, BendsAtTheCornersOfAHole) {
  //  A wall stands across the sheet from the bottom up to y = 6, two squares wide.
  const Surface surface = sheet(10, 9, [](int x, int y) { return (x == 4 || x == 5) && y < 6; });
  const std::vector<double> d = distances(surface, 0);
  // From (0, 0) over the corners (4, 6) and (6, 6) down to (10, 0).
  EXPECT_NEAR(d[10], 2 * std::hypot(4, 6) + 2, 1e-12);
  EXPECT_NEAR(d[3 * 11 + 9], std::hypot(4, 6) + 2 + std::hypot(3, 3), 1e-12);
  EXPECT_NEAR(d[9 * 11 + 4], std::hypot(4, 9), 1e-12);  // in sight
}

TEST(Geodesic, UnrollsACylinder) {
  const TriMesh mesh = test::open_cylinder(16, 6);
  const Surface surface = surface_of(mesh);
  const double chord = 2 * std::sin(std::numbers::pi / 16);
  const std::vector<double> d = distances(surface, 0);
  for (std::uint32_t v = 0; v < d.size(); ++v) {
    const Vec3d p = surface.position(0), q = surface.position(v);
    const double turn = std::acos(std::clamp(p.x * q.x + p.y * q.y, -1.0, 1.0));
    const double around = std::round(turn / (2 * std::numbers::pi / 16)) * chord;
    // Corners are floats.
    EXPECT_NEAR(d[v], std::hypot(around, q.z - p.z), 1e-6) << v;
  }
}

TEST(Geodesic, CrossesTheEdgesOfACube) {
  const Surface surface = surface_of(test::cube());
  const std::vector<double> d = distances(surface, 0);
  for (std::uint32_t v = 0; v < d.size(); ++v) {
    const Vec3d way = surface.position(v) - surface.position(0);
    const int apart = (way.x != 0) + (way.y != 0) + (way.z != 0);
    const double expected[] = {0, 2, std::sqrt(8.0), std::sqrt(20.0)};
    EXPECT_NEAR(d[v], expected[apart], 1e-12) << v;
  }
}

TEST(Geodesic, UnrollsACone) {
  // 12 triangles around a tip with 20° each: lines over the tip's side, or over the tip where that is more
  // than half a turn of the unrolled cone away (it is not: 240° in all).
  const double flat = 20 * std::numbers::pi / 180, half = std::sin(flat / 2);
  const double radius = half / std::sin(std::numbers::pi / 12);  // of the rim, for sides of length 1
  Surface cone;
  cone.positions.push_back({0, 0, static_cast<float>(std::sqrt(1 - radius * radius))});
  for (std::uint32_t i = 0; i < 12; ++i) {
    const double turn = i * std::numbers::pi / 6;
    cone.positions.push_back(
        {static_cast<float>(radius * std::cos(turn)), static_cast<float>(radius * std::sin(turn)), 0});
    cone.triangles.push_back({0, 1 + i, 1 + (i + 1) % 12});
  }
  const std::vector<double> d = distances(cone, 1);
  for (int i = 0; i < 12; ++i) {
    const int steps = std::min(i, 12 - i);
    EXPECT_NEAR(d[static_cast<std::size_t>(1 + i)], 2 * std::sin(steps * flat / 2), 1e-6) << i;
  }
}

TEST(Geodesic, GoesOnIntoEverySheetOfAnEdge) {
  // Three half-planes that meet in the line x = z = 0: from one into the others it is as if they were one
  // plane.
  Surface surface;
  const auto add = [&](Vec3d direction) {
    std::vector<std::uint32_t> column[2];
    for (int y = 0; y <= 4; ++y) {
      column[0].push_back(static_cast<std::uint32_t>(y));
      column[1].push_back(static_cast<std::uint32_t>(surface.positions.size()));
      surface.positions.push_back(Vec3f(direction + Vec3d{0, static_cast<double>(y), 0}));
    }
    for (std::size_t y = 0; y < 4; ++y) {
      surface.triangles.push_back({column[0][y], column[1][y], column[1][y + 1]});
      surface.triangles.push_back({column[0][y], column[1][y + 1], column[0][y + 1]});
    }
  };
  for (int y = 0; y <= 4; ++y) surface.positions.push_back({0, static_cast<float>(y), 0});
  add({1, 0, 0});
  add({-0.6, 0, 0.8});
  add({-0.6, 0, -0.8});
  const std::vector<double> d = distances(surface, 5);  // (1, 0, 0)
  for (std::uint32_t y = 0; y <= 4; ++y) {
    EXPECT_NEAR(d[5 + y], y, 1e-6);
    EXPECT_NEAR(d[10 + y], std::hypot(2, y), 1e-6);
    EXPECT_NEAR(d[15 + y], std::hypot(2, y), 1e-6);
  }
}

TEST(Geodesic, EqualsTheDefinitionOnBumpySurfaces) {
  Random random(4);
  int compared = 0;
  for (const TriMesh& mesh : {test::icosphere(1), test::grid(5, 4), test::torus(7, 5), test::bow_tie(),
                              test::non_manifold_edge(), test::cube()}) {
    Surface surface = surface_of(mesh);
    for (Vec3f& p : surface.positions) {
      p = p + Vec3f(Vec3d{random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)} *
                    (0.05 * diagonal(surface)));
    }
    const double radius = 0.5 * diagonal(surface);
    const auto expected = test::all_geodesics(surface, radius);
    for (std::uint32_t v = 0; v < surface.positions.size(); ++v) {
      const std::vector<double> d = distances(surface, v, radius);
      for (std::uint32_t w = 0; w < d.size(); ++w) {
        if (expected[v][w] == kNever) {
          EXPECT_EQ(d[w], kNever) << v << " to " << w;
        } else {
          EXPECT_NEAR(d[w], expected[v][w], 1e-10) << v << " to " << w;
          ++compared;
        }
      }
    }
  }
  EXPECT_GT(compared, 1000);
}

TEST(Geodesic, IsolatedVerticesAndOtherPiecesAreNotReached) {
  Surface surface = surface_of(test::tetrahedra(2));
  surface.positions.push_back({9, 9, 9});
  const auto alone = static_cast<std::uint32_t>(surface.positions.size() - 1);
  EXPECT_EQ(distances(surface, alone)[alone], 0);
  const std::vector<double> d = distances(surface, 0);
  EXPECT_EQ(std::count(d.begin(), d.end(), kNever), 5);
}

}  // namespace
}  // namespace fovea
