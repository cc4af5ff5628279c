#pragma once

#include <cmath>
#include <cstddef>
#include <cstring>
#include <vector>

#include "fovea/base/math.h"
#include "fovea/render/float4.h"

namespace fovea {

/// What Fovea's rig (light_rig.h) sends to a far eye from every normal of a material: tabulated, for whoever
/// asks very often. 32 kB.
class LightTable {
 public:
  LightTable(float metallic, float roughness, Vec3f to_eye);

  /// Light is base colour × `tinted` + `white`.
  struct Light {
    float tinted = 0, white = 0;
  };
  /// `normal` of any length but 0. Mixed of four entries: of the normals that face the eye, with roughness
  /// 0.5 and up, 99 in 100 are within 0.03 of the rig, on the mean 0.003. Bright rims before a lamp, narrower
  /// than entries, are the rest.
  Light at(Vec3f normal) const {
    const float inverse = 1 / (std::abs(normal.x) + std::abs(normal.y) + std::abs(normal.z));
    float x = normal.x * inverse, y = normal.y * inverse;
    if (normal.z < 0) {  // the lower half of the octahedron is folded outwards
      const float fx = (1 - std::abs(y)) * (x < 0 ? -1.0f : 1.0f);
      y = (1 - std::abs(x)) * (y < 0 ? -1.0f : 1.0f);
      x = fx;
    }
    constexpr float kHalf = 0.5f * (kSide - 1);
    const float u = (x + 1) * kHalf, v = (y + 1) * kHalf;
    const int i = u < kSide - 2 ? static_cast<int>(u) : kSide - 2,
              j = v < kSide - 2 ? static_cast<int>(v) : kSide - 2;
    const float s = u - static_cast<float>(i), t = v - static_cast<float>(j);
    // Neighbours in a row lie together.
    Float4 above, below;
    const Light* const p = lights_.data() + static_cast<std::size_t>(j) * kSide + static_cast<std::size_t>(i);
    std::memcpy(&above, p, sizeof(above));
    std::memcpy(&below, p + kSide, sizeof(below));
    const Float4 row = above + (below - above) * t;
    return {row[0] + (row[2] - row[0]) * s, row[1] + (row[3] - row[1]) * s};
  }

 private:
  static constexpr int kSide = 64;
  std::vector<Light> lights_;  // [kSide²] over the octahedron, unfolded
};

}  // namespace fovea
