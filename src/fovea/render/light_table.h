#pragma once

#include <vector>

#include "fovea/base/math.h"
#include "fovea/base/wide.h"

namespace fovea {

/// What Fovea's rig (light_rig.h) sends to a far eye from every normal of a material: tabulated, for whoever
/// asks very often. 32 kB.
class LightTable {
 public:
  LightTable() = default;  ///< Of nothing; not to be asked.
  LightTable(float metallic, float roughness, Vec3f to_eye);

  /// Light is base colour × `tinted` + `white`.
  struct Light {
    float tinted = 0, white = 0;
  };
  /// Normals of any length; for one of length 0 any of them. Mixed of four entries: of the normals that face
  /// the eye, with roughness 0.5 and up, 99 in 100 are within 0.03 of the rig, on the mean 0.003. Bright rims
  /// before a lamp, narrower than entries, are the rest.
  void at(const WideFloats& x, const WideFloats& y, const WideFloats& z, WideFloats& tinted,
          WideFloats& white) const;
  Light at(Vec3f normal) const {
    WideFloats x{}, y{}, z{}, tinted, white;
    x[0] = normal.x;
    y[0] = normal.y;
    z[0] = normal.z;
    at(x, y, z, tinted, white);
    return {tinted[0], white[0]};
  }

 private:
  std::vector<Light> lights_;  // [side²] over the octahedron, unfolded
};

}  // namespace fovea
