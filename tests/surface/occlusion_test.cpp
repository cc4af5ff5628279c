#include "fovea/surface/occlusion.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "fovea/base/random.h"

namespace fovea {
namespace {

/// The triangle x, y ≥ 0, x + y ≤ 1 at a height; its front is up.
Surface sheet(float z) { return {{{0, 0, z}, {1, 0, z}, {0, 1, z}}, {{0, 1, 2}}}; }

TEST(Occlusion, FrontsHideAndBacksDoNot) {
  const Surface surface = sheet(1);
  const Vec3d below{0.2, 0.2, 0}, above{0.2, 0.2, 2};
  const Occlusion single(surface, {false}), both(surface, {true});
  EXPECT_TRUE(single.hides(below, above)) << "the eye is before its front";
  EXPECT_FALSE(single.hides(above, below)) << "one looks through its back";
  EXPECT_TRUE(both.hides(below, above));
  EXPECT_TRUE(both.hides(above, below));
}

TEST(Occlusion, WhatIsBesideOrBeyondHidesNothing) {
  const Surface surface = sheet(1);
  const Occlusion occlusion(surface, {true});
  EXPECT_FALSE(occlusion.hides({0.8, 0.8, 0}, {0.8, 0.8, 2})) << "beside";
  EXPECT_FALSE(occlusion.hides({0.2, 0.2, 0}, {0.2, 0.2, 0.9})) << "behind the eye";
  EXPECT_FALSE(occlusion.hides({0.2, 0.2, 1.1}, {0.2, 0.2, 2})) << "behind the point";
}

TEST(Occlusion, NothingHidesNothing) {
  const Surface empty;
  EXPECT_FALSE(Occlusion(empty, {}).hides({0, 0, 0}, {1, 1, 1}));
}

/// Whether a segment meets a triangle from its front, by signed volumes. Literal and slow.
bool meets(const Surface& s, std::size_t f, Vec3d p, Vec3d q, bool both) {
  const auto& t = s.triangles[f];
  const Vec3d a = s.position(t[0]), b = s.position(t[1]), c = s.position(t[2]);
  const Vec3d n = cross(b - a, c - a);
  const double from = dot(p - a, n), to = dot(q - a, n);
  if (from * to >= 0 || (!both && to <= 0)) return false;
  const Vec3d at = p + (q - p) * (from / (from - to));
  return dot(cross(b - a, at - a), n) > 0 && dot(cross(c - b, at - b), n) > 0 &&
         dot(cross(a - c, at - c), n) > 0;
}

TEST(Occlusion, IsThatOfAllTrianglesOneByOne) {
  Random random(4);
  const auto point = [&] {
    return Vec3d{random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)};
  };
  Surface surface;
  std::vector<bool> both;
  for (std::uint32_t f = 0; f < 30; ++f) {
    for (int k = 0; k < 3; ++k) surface.positions.push_back(Vec3f(point()));
    surface.triangles.push_back({3 * f, 3 * f + 1, 3 * f + 2});
    both.push_back(f % 3 == 0);
  }
  const Occlusion occlusion(surface, both);
  int hidden = 0;
  for (int i = 0; i < 2000; ++i) {
    const Vec3d p = Vec3d(Vec3f(point())), q = p + Vec3d(Vec3f(point() - p));
    bool expected = false;
    for (std::size_t f = 0; f < 30; ++f) expected = expected || meets(surface, f, p, q, both[f]);
    EXPECT_EQ(occlusion.hides(p, q), expected) << i;
    hidden += expected;
  }
  EXPECT_GT(hidden, 200);
  EXPECT_LT(hidden, 1800);
}

TEST(Occlusion, WorksAtAnySizeAndFromAnyDistance) {
  for (const float size : {1e-30f, 1e-12f, 1.0f, 1e15f, 1e30f}) {
    const Surface surface{{{0, 0, size}, {size, 0, size}, {0, size, size}}, {{0, 1, 2}}};
    const double s = static_cast<double>(size);
    const Occlusion occlusion(surface, {true});
    for (const double far : {2.0, 1e7}) {
      EXPECT_TRUE(occlusion.hides({0.2 * s, 0.2 * s, 0}, {0.2 * s, 0.2 * s, far * s})) << size;
      EXPECT_FALSE(occlusion.hides({0.8 * s, 0.8 * s, 0}, {0.8 * s, 0.8 * s, far * s})) << size;
    }
  }
}

TEST(Occlusion, AnEyeBeyondAllNumbersOfSinglePrecision) {
  const Surface surface = sheet(1);
  EXPECT_TRUE(Occlusion(surface, {true}).hides({0.2, 0.2, 0}, {0.2, 0.2, 1e60}));
}

}  // namespace
}  // namespace fovea
