#include "fovea/render/light_table.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

#include "fovea/base/random.h"
#include "fovea/render/light_rig.h"

namespace fovea {
namespace {

constexpr float kMetals[] = {0, 0.3f, 1};
constexpr float kRough[] = {0.5f, 0.7f, 1};

Vec3f random_direction(Random& random) {
  while (true) {
    const Vec3d d{random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)};
    if (length(d) > 0.1 && length(d) < 1) return Vec3f(normalized(d));
  }
}

Rgba lit(float metallic, float roughness, Rgba base_color, Vec3f normal, Vec3f to_eye) {
  SurfaceLook look;
  look.base_color = base_color;
  look.metallic = metallic;
  look.roughness = roughness;
  return light_to_eye(look, normal, to_eye);
}

/// How far tables are from the rig for a white surface, over random eyes and normals that face them by more
/// than `least` (cosine).
std::vector<double> errors(float metallic, float roughness, float least) {
  std::vector<double> result;
  Random random(31);
  for (int eye = 0; eye < 30; ++eye) {
    const Vec3f to_eye = random_direction(random);
    const LightTable table(metallic, roughness, to_eye);
    for (int i = 0; i < 2000; ++i) {
      const Vec3f normal = random_direction(random);
      if (dot(normal, to_eye) <= least) continue;
      const LightTable::Light light = table.at(normal);
      const double expected = lit(metallic, roughness, {1, 1, 1, 1}, normal, to_eye).r;
      result.push_back(std::abs(light.tinted + light.white - expected));
    }
  }
  std::sort(result.begin(), result.end());
  return result;
}

double mean(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

TEST(LightTable, IsNearTheRigWhereNormalsFaceTheEye) {
  for (const float metallic : kMetals) {
    for (const float roughness : kRough) {
      const std::vector<double> sorted = errors(metallic, roughness, 0);
      ASSERT_GT(sorted.size(), 10000u);
      EXPECT_LT(mean(sorted), 0.003) << metallic << ", " << roughness;
      EXPECT_LT(sorted[sorted.size() * 99 / 100], 0.03) << metallic << ", " << roughness;
    }
  }
}

TEST(LightTable, IsWorstAtOutlinesBeforeALamp) {
  // Highlights there are as wide as a few entries; where the light comes from the side of the eye they are
  // an order of magnitude wider. The whole of the light goes up to 8.
  for (const float metallic : kMetals) {
    for (const float roughness : kRough) {
      EXPECT_LT(errors(metallic, roughness, 0.5f).back(), 0.13) << metallic << ", " << roughness;
      EXPECT_GT(errors(metallic, roughness, 0).back(), errors(metallic, roughness, 0.5f).back());
    }
  }
}

TEST(LightTable, LightIsLinearInTheBaseColor) {
  const Vec3f normal{0, 0, -1};  // an entry of the table, the corners of the unfolded octahedron
  Random random(32);
  for (const float metallic : kMetals) {
    for (int i = 0; i < 50; ++i) {
      Vec3f to_eye = random_direction(random);
      to_eye.z = -std::abs(to_eye.z);
      const Rgba color{static_cast<float>(random.uniform()), static_cast<float>(random.uniform()),
                       static_cast<float>(random.uniform()), 1};
      const LightTable::Light light = LightTable(metallic, 0.6f, to_eye).at(normal);
      const Rgba expected = lit(metallic, 0.6f, color, normal, to_eye);
      // Single precision; light is up to 1 there.
      EXPECT_NEAR(color.r * light.tinted + light.white, expected.r, 1e-6);
      EXPECT_NEAR(color.g * light.tinted + light.white, expected.g, 1e-6);
      EXPECT_NEAR(color.b * light.tinted + light.white, expected.b, 1e-6);
    }
  }
}

TEST(LightTable, TheLengthOfTheNormalDoesNotMatter) {
  const LightTable table(0.3f, 0.6f, normalized(Vec3f{1, 2, 3}));
  Random random(33);
  for (int i = 0; i < 500; ++i) {
    const Vec3f normal = random_direction(random);
    const LightTable::Light light = table.at(normal);
    for (const float scale : {0x1p-60f, 0.5f, 0x1p60f}) {
      const LightTable::Light other = table.at(normal * scale);
      EXPECT_EQ(other.tinted, light.tinted);  // powers of two round alike
      EXPECT_EQ(other.white, light.white);
    }
    // Others round differently: by a few 10⁻⁶ of the way between entries, which differ by less than 1.
    const LightTable::Light third = table.at(normal * 0.3f);
    EXPECT_NEAR(third.tinted, light.tinted, 4e-6);
    EXPECT_NEAR(third.white, light.white, 4e-6);
  }
}

// The octahedron unfolded: the middle square is the upper half, the four corners are the lower half folded
// outwards, so that halves of each side are glued together.
//
//   +----^----+
//   |  / | \  |
//   |/   |   \|
//   <----+---->
//   |\   |   /|
//   |  \ | /  |
//   +----v----+
TEST(LightTable, HasNoSeams) {
  const LightTable table(0.3f, 0.5f, normalized(Vec3f{1, -2, -3}));
  Random random(34);
  const auto expect_joined = [&](Vec3f a, Vec3f b) {
    // 10⁻⁵ apart is less than a thousandth of an entry; differences between entries are at most 1.
    EXPECT_NEAR(table.at(a).tinted, table.at(b).tinted, 1e-3);
    EXPECT_NEAR(table.at(a).white, table.at(b).white, 1e-3);
  };
  constexpr float kStep = 5e-6f;
  for (int i = 0; i < 500; ++i) {
    const Vec3f n = random_direction(random);
    const float below = -std::abs(n.z);
    expect_joined({kStep, n.y, below}, {-kStep, n.y, below});
    expect_joined({n.x, kStep, below}, {n.x, -kStep, below});
    expect_joined({n.x, n.y, kStep}, {n.x, n.y, -kStep});
  }
}

TEST(LightTable, AxesHaveTheirLight) {
  const Vec3f axes[] = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
  for (const Vec3f axis : axes) {
    const LightTable::Light light = LightTable(0, 1, axis).at(axis);
    const float expected = lit(0, 1, {1, 1, 1, 1}, axis, axis).r;
    EXPECT_NEAR(light.tinted + light.white, expected, 0.02);  // within the mix of four entries
  }
}

}  // namespace
}  // namespace fovea
