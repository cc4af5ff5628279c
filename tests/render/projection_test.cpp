#include "fovea/render/projection.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <map>
#include <span>
#include <utility>
#include <vector>

#include "fovea/base/random.h"
#include "fovea/render/scan_convert.h"

namespace fovea {
namespace {

constexpr SampleGrid kGrid{60, 40, 2};

View view_along_z(bool perspective) {
  View view;
  view.perspective = perspective;
  view.half_height = perspective ? 0.5 : 3;
  view.near = 0.1;
  return view;
}

TEST(Projection, PutsPointsWhereRaysPassThroughThem) {
  Random random(61);
  for (const bool perspective : {false, true}) {
    const Projection projection(view_along_z(perspective), kGrid);
    for (int i = 0; i < 500; ++i) {
      const double x = random.uniform(0, 60), y = random.uniform(0, 40), z = random.uniform(0.2, 9);
      const Vec2d plane = projection.to_plane(x, y);
      const double scale = perspective ? z : 1;
      ScreenVertex v;
      ASSERT_TRUE(projection.project({plane.x * scale, plane.y * scale, z}, v));
      // Two samples per pixel; rounded to whole units.
      EXPECT_NEAR(v.x, x * 2 * kSubsamples, 0.5 + 1e-6);
      EXPECT_NEAR(v.y, y * 2 * kSubsamples, 0.5 + 1e-6);
      EXPECT_FLOAT_EQ(v.nearness, static_cast<float>(perspective ? 1 / z : -z));
    }
  }
}

TEST(Projection, CornersOfThePictureAreThoseOfTheView) {
  const Projection projection(view_along_z(true), kGrid);
  const Vec2d first = projection.to_plane(0, 0), last = projection.to_plane(60, 40);
  EXPECT_DOUBLE_EQ(first.x, -0.75);
  EXPECT_DOUBLE_EQ(first.y, 0.5);
  EXPECT_DOUBLE_EQ(last.x, 0.75);
  EXPECT_DOUBLE_EQ(last.y, -0.5);
  EXPECT_DOUBLE_EQ(projection.pixel(), 1.0 / 40);
}

TEST(Projection, WhatIsTooNearOrTooFarAsideIsNotPut) {
  for (const bool perspective : {false, true}) {
    const Projection projection(view_along_z(perspective), kGrid);
    ScreenVertex v;
    EXPECT_TRUE(projection.project({0, 0, 0.1}, v));
    EXPECT_FALSE(projection.project({0, 0, 0.0999}, v));
    EXPECT_FALSE(projection.project({0, 0, -4}, v));
    EXPECT_FALSE(projection.project({1e9, 0, 1}, v));
    EXPECT_FALSE(projection.project({0, -1e9, 1}, v));
    EXPECT_FALSE(projection.project({std::nan(""), 0, 1}, v));
  }
}

using Samples = std::map<std::pair<int, int>, int>;

Samples covered(std::span<const ScreenVertex> fan) {
  Samples samples;
  for (std::size_t k = 2; k < fan.size(); ++k) {
    for_spans({fan[0], fan[k - 1], fan[k]}, {0, 0, 120, 80}, [&](int y, int x0, int x1, const auto&) {
      for (int x = x0; x < x1; ++x) ++samples[{x, y}];
    });
  }
  return samples;
}

TEST(Projection, WhatIsAllInSightIsNotClipped) {
  const Projection projection(view_along_z(true), kGrid);
  const std::array<Vec3d, 3> eye{Vec3d{-1, 0, 3}, Vec3d{1, 0.3, 4}, Vec3d{0.2, 1, 2}};
  const std::vector<ScreenVertex> fan = projection.clip(eye);
  ASSERT_EQ(fan.size(), 3u);
  for (std::size_t k = 0; k < 3; ++k) {
    ScreenVertex v;
    ASSERT_TRUE(projection.project(eye[k], v));
    EXPECT_EQ(fan[k].x, v.x);
    EXPECT_EQ(fan[k].y, v.y);
    EXPECT_EQ(fan[k].nearness, v.nearness);
  }
}

TEST(Projection, WhatIsOutOfSightIsClippedAway) {
  for (const bool perspective : {false, true}) {
    const Projection projection(view_along_z(perspective), kGrid);
    EXPECT_TRUE(projection.clip({Vec3d{-1, 0, -3}, Vec3d{1, 0, -4}, Vec3d{0, 1, 0.05}}).empty());
    EXPECT_TRUE(projection.clip({Vec3d{1e12, 0, 1}, Vec3d{2e12, 0, 1}, Vec3d{1e12, 1, 1}}).empty());
  }
}

//        eye
//   ------+------->  floor, far behind and far ahead: below the horizon each sample sees it once
TEST(Projection, AFloorFromBehindToFarAheadFillsTheLowerHalf) {
  const Projection projection(view_along_z(true), kGrid);
  constexpr double kFar = 1e6;
  const std::vector<ScreenVertex> fan =
      projection.clip({Vec3d{-kFar, -1, -kFar}, Vec3d{kFar, -1, -kFar}, Vec3d{0, -1, kFar}});
  ASSERT_GE(fan.size(), 3u);
  const Samples samples = covered(fan);
  for (const auto& [sample, count] : samples) {
    EXPECT_EQ(count, 1);
    EXPECT_GE(sample.second, 40);
  }
  EXPECT_EQ(samples.size(), std::size_t{120} * 40);
}

TEST(Projection, ClippedPartsEndAtTheNearPlane) {
  const Projection projection(view_along_z(true), kGrid);
  const std::vector<ScreenVertex> fan =
      projection.clip({Vec3d{0, -0.02, -1}, Vec3d{0, 0.02, -1}, Vec3d{0.01, 0, 1}});
  ASSERT_EQ(fan.size(), 3u);
  for (const ScreenVertex& v : fan) EXPECT_LE(v.nearness, 10.0f * (1 + 1e-6f));
}

}  // namespace
}  // namespace fovea
