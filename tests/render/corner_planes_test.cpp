#include "fovea/render/corner_planes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "fovea/base/random.h"
#include "fovea/render/projection.h"
#include "fovea/render/scan_convert.h"

namespace fovea {
namespace {

constexpr int kSize = 96;
constexpr Float4 kUnits = {1, 1, 1, 1};
using Corners = std::array<ScreenVertex, 3>;

double random_number(Random& random) { return random.uniform(-1, 1); }

Vec3d random_point(Random& random) {
  return {random_number(random), random_number(random), random_number(random)};
}

View random_view(Random& random, double fov_deg) {
  return view_onto({{0.3, -0.2, 5}, 2}, normalized(random_point(random)), fov_deg, 0);
}

/// Numbers at three corners, one of each set per lane.
std::array<Float4, 3> random_numbers(Random& random) {
  std::array<Float4, 3> numbers;
  for (Float4& n : numbers) {
    for (int k = 0; k < 4; ++k) n[k] = static_cast<float>(random_number(random));
  }
  return numbers;
}

/// Weights of the corners where the ray through the middle of a pixel meets a triangle, by Cramer's rule.
std::array<double, 3> weights_on_ray(const Projection& projection, const std::array<Vec3d, 3>& p, int x,
                                     int y) {
  const View& view = projection.view();
  const Vec2d plane = projection.to_plane(x + 0.5, y + 0.5);
  const Vec3d aside = view.right * plane.x + view.up * plane.y;
  const Vec3d start = view.perspective ? view.eye : view.eye + aside;
  const Vec3d ray = view.perspective ? aside - view.back : -view.back;
  const auto volume = [](Vec3d a, Vec3d b, Vec3d c) { return dot(cross(a, b), c); };
  const Vec3d a = p[1] - p[0], b = p[2] - p[0], s = start - p[0];
  const double whole = volume(a, b, -ray);
  const double u = volume(s, b, -ray) / whole, v = volume(a, s, -ray) / whole;
  return {1 - u - v, u, v};
}

/// Weights of the corners on the screen, in double precision.
std::array<double, 3> weights_on_screen(const Corners& v, int pixel_x, int pixel_y) {
  const double x = (pixel_x + 0.5) * kSubsamples, y = (pixel_y + 0.5) * kSubsamples;
  std::array<double, 3> weights;
  for (std::size_t k = 0; k < 3; ++k) {
    const ScreenVertex &p = v[(k + 1) % 3], &q = v[(k + 2) % 3];
    weights[k] = ((q.x - p.x) * (y - p.y) - (q.y - p.y) * (x - p.x)) / static_cast<double>(double_area(v));
  }
  return weights;
}

double mixed(const std::array<double, 3>& weights, const std::array<Float4, 3>& numbers, int lane) {
  return weights[0] * numbers[0][lane] + weights[1] * numbers[1][lane] + weights[2] * numbers[2][lane];
}

/// The smallest height of a triangle, in pixels.
double least_height(const Corners& v) {
  double longest = 0;
  for (std::size_t k = 0; k < 3; ++k)
    longest = std::max(longest, std::hypot(v[k].x - v[(k + 1) % 3].x, v[k].y - v[(k + 1) % 3].y));
  return longest > 0 ? std::abs(static_cast<double>(double_area(v))) / longest / kSubsamples : 0;
}

/// Calls pixel(x, y) for those that a triangle covers.
template <class F>
void for_pixels(const Corners& v, F&& pixel) {
  for_spans(v, {0, 0, kSize, kSize}, [&](int y, int x0, int x1, const NearnessPlane&) {
    for (int x = x0; x < x1; ++x) pixel(x, y);
  });
}

/// What single precision leaves of weights: they are rounded at the corner of the picture, where each is up
/// to kSize / height, a few times.
double rounding(const Corners& v) { return 3 * kSize / least_height(v) * 0x1p-22; }

/// How far numbers of −1 … 1 in a triangle may be from those on the ray. Corners are rounded to the grid, by
/// at most δ = √½/256 of a pixel: inside of the triangle that shifts a point by no more, hence each of its
/// three weights by δ over a height, and what it mixes by twice that. The nearest corner counts more.
double tolerance(const Corners& v, bool perspective) {
  const auto [low, high] = std::minmax({v[0].nearness, v[1].nearness, v[2].nearness});
  const double share = perspective ? static_cast<double>(high / low) : 1;
  return share * (3 * 2 * std::sqrt(0.5) / kSubsamples / least_height(v) + rounding(v));
}

/// Compares a triangle in a view with rays; how many of its pixels were compared.
int compare_with_rays(const Projection& projection, const std::array<Vec3d, 3>& p,
                      const std::array<Float4, 3>& numbers) {
  Corners v;
  for (std::size_t k = 0; k < 3; ++k) {
    if (!projection.project(projection.view().to_eye(p[k]), v[k])) return 0;
  }
  if (least_height(v) < 2) return 0;
  const CornerPlanes planes(v, projection.view().perspective);
  const CornerPlanes::Plane plane = planes.plane(numbers), ones = planes.plane({kUnits, kUnits, kUnits});
  const double most = tolerance(v, projection.view().perspective);
  int count = 0;
  for_pixels(v, [&](int x, int y) {
    const std::array<double, 3> weights = weights_on_ray(projection, p, x, y);
    const Float4 result = plane(x, y) / ones(x, y);
    for (int lane = 0; lane < 4; ++lane) EXPECT_NEAR(result[lane], mixed(weights, numbers, lane), most);
    ++count;
  });
  return count;
}

TEST(CornerPlanes, AreWhatRaysMeet) {
  Random random(41);
  for (const double fov_deg : {0.0, 30.0, 100.0}) {
    int count = 0;
    for (int i = 0; i < 200; ++i) {
      const Projection projection(random_view(random, fov_deg), {kSize, kSize, 1});
      const Vec3d center{0.3, -0.2, 5};
      const std::array<Vec3d, 3> p{center + random_point(random), center + random_point(random),
                                   center + random_point(random)};
      count += compare_with_rays(projection, p, random_numbers(random));
    }
    EXPECT_GT(count, 10000) << fov_deg;
  }
}

//  near (1) *---m---*---*---* far (3)     what is in the middle of a beam's picture is a quarter along it
TEST(CornerPlanes, FarHalvesOfAPictureAreLonger) {
  const Corners v{{{kSubsamples / 2, kSubsamples / 2, 1},
                   {kSubsamples / 2 + 8 * kSubsamples, kSubsamples / 2, 1.0f / 3},
                   {kSubsamples / 2, kSubsamples / 2 + 8 * kSubsamples, 1}}};
  const CornerPlanes planes(v, true);
  const Float4 zero = {0, 0, 0, 0};
  const float along = planes.plane({zero, kUnits, zero})(4, 0)[0];
  const float ones = planes.plane({kUnits, kUnits, kUnits})(4, 0)[0];
  EXPECT_NEAR(along / ones, 0.25, 1e-6);
  EXPECT_NEAR(CornerPlanes(v, false).plane({zero, kUnits, zero})(4, 0)[0], 0.5, 1e-6);
}

TEST(CornerPlanes, OnesAreTheNearness) {
  Random random(42);
  for (int i = 0; i < 200; ++i) {
    Corners v;
    for (ScreenVertex& c : v) {
      const auto place = [&] { return static_cast<std::int32_t>(random.below(kSize * kSubsamples)); };
      c = {place(), place(), static_cast<float>(random.uniform(0.5, 2))};
    }
    if (least_height(v) < 2) continue;
    const CornerPlanes::Plane ones = CornerPlanes(v, true).plane({kUnits, kUnits, kUnits});
    const SampleRect all{0, 0, kSize, kSize};
    for_spans(v, all, [&](int y, int x0, int x1, const NearnessPlane& plane) {
      plane.for_row(y, x0, x1, [&](int x, float nearness) {
        EXPECT_NEAR(ones(x, y)[0], nearness, 2 * 2 * rounding(v));  // both are, of numbers up to 2
      });
    });
  }
}

TEST(CornerPlanes, InParallelProjectionNumbersAreAffineOnTheScreen) {
  Random random(43);
  for (int i = 0; i < 200; ++i) {
    Corners v;
    for (ScreenVertex& c : v) {
      const auto place = [&] { return static_cast<std::int32_t>(random.below(kSize * kSubsamples)); };
      c = {place(), place(), static_cast<float>(random.uniform(-9, -1))};  // which plays no part
    }
    if (least_height(v) < 2) continue;
    const CornerPlanes planes(v, false);
    const std::array<Float4, 3> numbers = random_numbers(random);
    const CornerPlanes::Plane plane = planes.plane(numbers), ones = planes.plane({kUnits, kUnits, kUnits});
    const double most = rounding(v);
    for_pixels(v, [&](int x, int y) {
      EXPECT_NEAR(ones(x, y)[0], 1, most);
      EXPECT_NEAR(plane(x, y)[1], mixed(weights_on_screen(v, x, y), numbers, 1), most);
    });
  }
}

TEST(CornerPlanes, CornersHaveTheirNumbers) {
  // In the middles of pixels; either winding.
  const ScreenVertex a{5 * kSubsamples + kSubsamples / 2, 7 * kSubsamples + kSubsamples / 2, 1},
      b{60 * kSubsamples + kSubsamples / 2, 20 * kSubsamples + kSubsamples / 2, 0.25f},
      c{33 * kSubsamples + kSubsamples / 2, 90 * kSubsamples + kSubsamples / 2, 0.5f};
  Random random(44);
  const std::array<Float4, 3> numbers = random_numbers(random);
  for (const bool perspective : {false, true}) {
    for (const bool swapped : {false, true}) {
      const Corners v = swapped ? Corners{a, c, b} : Corners{a, b, c};
      const CornerPlanes planes(v, perspective);
      const CornerPlanes::Plane plane = planes.plane(numbers), ones = planes.plane({kUnits, kUnits, kUnits});
      for (std::size_t k = 0; k < 3; ++k) {
        const int x = v[k].x / kSubsamples, y = v[k].y / kSubsamples;
        for (int lane = 0; lane < 4; ++lane) {
          // Rounding in single precision of a few numbers of up to 3.
          EXPECT_NEAR(plane(x, y)[lane] / ones(x, y)[lane], numbers[k][lane], 5e-6);
        }
      }
    }
  }
}

TEST(CornerPlanes, FourNumbersAtOnceAreFourNumbers) {
  const Corners v{{{100, 300, 1}, {20000, 4000, 0.5f}, {7000, 22000, 0.25f}}};
  const CornerPlanes planes(v, true);
  Random random(45);
  const std::array<Float4, 3> numbers = random_numbers(random);
  const CornerPlanes::Plane together = planes.plane(numbers);
  for (int lane = 0; lane < 4; ++lane) {
    std::array<Float4, 3> alone{};
    for (std::size_t k = 0; k < 3; ++k) alone[k][lane] = numbers[k][lane];
    const CornerPlanes::Plane plane = planes.plane(alone);
    for_pixels(v, [&](int x, int y) {
      EXPECT_EQ(together(x, y)[lane], plane(x, y)[lane]);
      EXPECT_EQ(plane(x, y)[(lane + 1) % 4], 0);
    });
  }
}

}  // namespace
}  // namespace fovea
