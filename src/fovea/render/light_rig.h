#pragma once

#include "fovea/base/math.h"
#include "fovea/texture/mip_map.h"

namespace fovea {

/// What a point of a surface is made of, as the metallic-roughness model wants it.
struct SurfaceLook {
  Rgba base_color;  ///< Light; alpha is coverage.
  float metallic = 0, roughness = 1;
  float occlusion = 1;  ///< Share of the surroundings that it sees.
  Rgba emission{0, 0, 0, 1};
};

/// Light that a point sends to the eye under Fovea's fixed rig, world-fixed, +y up: a room that is bright
/// above and dim below, with five soft lamps around (so that no side is dark). `normal` and `to_eye` are unit
/// vectors. Lambert's diffuse term and the microfacet model with GGX (Walter et al. 2007), Smith's
/// height-correlated masking and Schlick's Fresnel term, as glTF 2.0 (appendix B) has them. A lamp's size
/// widens the lobe that it is seen in; the room is reflected as its gradient, with the split-sum fit of Karis
/// (2014). No function of the C library but sqrt: the same bits on every machine.
Rgba light_to_eye(const SurfaceLook& look, Vec3f normal, Vec3f to_eye);

}  // namespace fovea
