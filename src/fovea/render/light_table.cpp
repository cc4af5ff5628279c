#include "fovea/render/light_table.h"

#include <cmath>

#include "fovea/render/light_rig.h"

namespace fovea {

LightTable::LightTable(float metallic, float roughness, Vec3f to_eye) {
  using light_table::kSide;
  lights_.reserve(std::size_t{kSide} * kSide);
  SurfaceLook look;
  look.metallic = metallic;
  look.roughness = roughness;
  for (int j = 0; j < kSide; ++j) {
    for (int i = 0; i < kSide; ++i) {
      const float x = 2.0f * static_cast<float>(i) / (kSide - 1) - 1,
                  y = 2.0f * static_cast<float>(j) / (kSide - 1) - 1;
      Vec3f n{x, y, 1 - std::abs(x) - std::abs(y)};
      if (n.z < 0) {
        n.x = (1 - std::abs(y)) * (x < 0 ? -1.0f : 1.0f);
        n.y = (1 - std::abs(x)) * (y < 0 ? -1.0f : 1.0f);
      }
      n = normalized(n);
      // Light is linear in the base colour.
      look.base_color = {0, 0, 0, 1};
      const float white = light_to_eye(look, n, to_eye).r;
      look.base_color = {1, 1, 1, 1};
      lights_.push_back({light_to_eye(look, n, to_eye).r - white, white});
    }
  }
}

LightTable::Light LightTable::at(Vec3f normal) const {
  WideFloats x{}, y{}, z{}, tinted, white;
  x[0] = normal.x;
  y[0] = normal.y;
  z[0] = normal.z;
  at(x, y, z, tinted, white);
  return {tinted[0], white[0]};
}

}  // namespace fovea
