#include "fovea/judge/surface_distance.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "support/meshes.h"

namespace fovea {
namespace {

Surface soup_of(const TriMesh& mesh, Vec3f shift = {}, float scale = 1) {
  Surface soup;
  for (const Vec3f& p : mesh.positions) soup.positions.push_back(p * scale + shift);
  for (const auto& t : mesh.triangles) soup.triangles.push_back({t[0].value, t[1].value, t[2].value});
  return soup;
}

TEST(SurfaceDistance, OfASurfaceToItselfIsZero) {
  const Surface sphere = soup_of(test::icosphere(3));
  const SurfaceDistance d = surface_distance(sphere, sphere, 2000, {});
  EXPECT_LT(d.hausdorff(), 1e-6);  // samples are rounded to floats when they are asked for
  EXPECT_LT(d.mean(), 1e-7);
}

TEST(SurfaceDistance, OfConcentricSpheresIsTheDifferenceOfTheirRadii) {
  const TriMesh sphere = test::icosphere(5);
  const SurfaceDistance d = surface_distance(soup_of(sphere), soup_of(sphere, {}, 1.1f), 4000, {});
  // Facets of the fifth subdivision lie up to 0.0003 inside of their sphere.
  EXPECT_NEAR(d.mean(), 0.1, 0.0005);
  EXPECT_NEAR(d.hausdorff(), 0.1, 0.0005);
  EXPECT_NEAR(d.forward.rms, d.forward.mean, 1e-4);
}

TEST(SurfaceDistance, KnowsWhatWasLostFromWhatWasAdded) {
  // A square of which half is gone: from the whole to the half up to 0.5 away, the other way nothing.
  const TriMesh whole = test::grid(8, 8);
  Surface half = soup_of(whole);
  std::erase_if(half.triangles, [&](const auto& t) {
    return half.positions[t[0]].x + half.positions[t[1]].x + half.positions[t[2]].x > 1.5f;
  });
  const SurfaceDistance d = surface_distance(soup_of(whole), half, 20000, {});
  EXPECT_NEAR(d.forward.max, 0.5, 1e-6);
  EXPECT_NEAR(d.forward.mean, 0.125, 1e-3);               // half the area, 0.25 away in the mean
  EXPECT_NEAR(d.forward.rms, std::sqrt(1.0 / 24), 1e-3);  // ∫ x² over 0 … 0.5
  EXPECT_LT(d.backward.max, 1e-6);
  EXPECT_EQ(d.hausdorff(), d.forward.max);
}

TEST(SurfaceDistance, VerticesCountForTheMaximum) {
  // A spike too thin for any sample.
  Surface spiked = soup_of(test::grid(2, 2));
  spiked.positions.insert(spiked.positions.end(),
                          {{0.5f, 0.5f, 0}, {0.5f, 0.5f, 1}, {0.5f, 0.5f + 1e-7f, 0}});
  const auto last = static_cast<std::uint32_t>(spiked.positions.size() - 1);
  spiked.triangles.push_back({last - 2, last - 1, last});
  const SurfaceDistance d = surface_distance(soup_of(test::grid(2, 2)), spiked, 1000, {});
  EXPECT_NEAR(d.backward.max, 1, 1e-6);
  EXPECT_LT(d.backward.mean, 1e-6);
}

TEST(SurfaceDistance, TheSameForAnyThreadsAndSeededOtherwise) {
  const Surface a = soup_of(test::torus(20, 10)), b = soup_of(test::torus(14, 7));
  Context one, two, other;
  one.threads = 1;
  two.threads = 2;
  other.seed = 7;
  const SurfaceDistance x = surface_distance(a, b, 3000, one), y = surface_distance(a, b, 3000, two),
                        z = surface_distance(a, b, 3000, other);
  EXPECT_EQ(x.forward.mean, y.forward.mean);
  EXPECT_EQ(x.backward.rms, y.backward.rms);
  EXPECT_NE(x.forward.mean, z.forward.mean);
  EXPECT_NEAR(x.forward.mean, z.forward.mean, 0.05 * x.forward.mean);
}

TEST(SurfaceDistance, SamplesAreSpreadByArea) {
  // A square cut into a large and a small part: 9 : 1.
  test::PartBuilder part;
  part.quad(part.vertex({0, 0, 0}), part.vertex({0.9f, 0, 0}), part.vertex({0.9f, 1, 0}),
            part.vertex({0, 1, 0}));
  part.quad(part.vertex({0.9f, 0, 0}), part.vertex({1, 0, 0}), part.vertex({1, 1, 0}),
            part.vertex({0.9f, 1, 0}));
  const auto points = sample_surface(soup_of(test::weld_part(part.part())), 1000, 1);
  ASSERT_EQ(points.size(), 1000u);
  const auto left = std::count_if(points.begin(), points.end(), [](Vec3d p) { return p.x < 0.9f; });
  EXPECT_NEAR(static_cast<double>(left), 900,
              2);  // shares are stratified: off by the borders between four triangles
}

TEST(SurfaceDistance, EmptySurfacesAreInfinitelyFar) {
  const Surface some = soup_of(test::tetrahedron()), none;
  EXPECT_EQ(surface_distance(some, none, 10, {}).hausdorff(), INFINITY);
  EXPECT_EQ(surface_distance(none, none, 10, {}).hausdorff(), 0);
}

}  // namespace
}  // namespace fovea
