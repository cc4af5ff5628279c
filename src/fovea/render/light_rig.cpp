#include "fovea/render/light_rig.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace fovea {

namespace {

constexpr float kPiF = std::numbers::pi_v<float>;

struct Lamp {
  Vec3f direction;  ///< To the lamp, unit.
  float strength;   ///< Light that a white surface facing it sends back.
  float width;      ///< Added to the squared width of what it is mirrored in.
};

struct Rig {
  std::array<Lamp, 5> lamps;
  float above = 0.55f, below = 0.22f;  ///< The room straight up and down.

  Rig() {
    const auto lamp = [](Vec3f d, float strength, float width) {
      return Lamp{normalized(d), strength, width};
    };
    lamps = {lamp({0.55f, 0.65f, 0.75f}, 0.50f, 0.03f), lamp({-0.85f, 0.35f, 0.40f}, 0.24f, 0.08f),
             lamp({-0.25f, 0.45f, -0.90f}, 0.32f, 0.05f), lamp({0.90f, 0.15f, -0.50f}, 0.20f, 0.06f),
             lamp({0.10f, -0.90f, 0.20f}, 0.10f, 0.15f)};
  }
  /// Light of the room in a direction, mirrored in a surface of some roughness.
  float room(float y, float roughness) const {
    // The step from floor to ceiling is sharp in a mirror and as wide as the sphere when rough.
    const float sharpness = 1 + 3 * (1 - roughness);
    const float t = std::clamp(0.5f + 0.5f * y * sharpness, 0.0f, 1.0f);
    return below + (above - below) * t * t * (3 - 2 * t);
  }
};

const Rig& rig() {
  static const Rig kRig;
  return kRig;
}

float fifth_power(float x) {
  const float x2 = x * x;
  return x2 * x2 * x;
}

/// Scale and bias of the specular colour for a surface in a uniform room (Karis 2014).
Vec2f room_reflectance(float roughness, float n_dot_v) {
  // 2^(−9.28 x) as the eighth power of e^(−0.804 x), of which the Taylor series is enough.
  const float x = 0.804f * n_dot_v;
  const float e = 1 - x * (1 - x * (0.5f - x * (0.1666667f - x * 0.0416667f)));
  const float e2 = e * e, e4 = e2 * e2, smooth = 1 - roughness;
  const float a = std::min(smooth * smooth, e4 * e4) * smooth + 0.0425f - 0.0275f * roughness;
  return {1.04f - 0.572f * roughness - 1.04f * a, 0.022f * roughness - 0.04f + 1.04f * a};
}

}  // namespace

Rgba light_to_eye(const SurfaceLook& look, Vec3f n, Vec3f v) {
  const float n_dot_v = std::max(dot(n, v), 1e-3f);
  const float roughness = std::clamp(look.roughness, 0.04f, 1.0f),
              alpha2 = roughness * roughness * roughness * roughness;
  const float metallic = std::clamp(look.metallic, 0.0f, 1.0f);
  const Rgba diffuse = look.base_color * (1 - metallic);
  const Rgba mirror = Rgba{0.04f, 0.04f, 0.04f, 0} * (1 - metallic) + look.base_color * metallic;

  float diffuse_light = 0;       // on the surface, of all lamps and the room
  float mirrored = 0, edge = 0;  // what the specular colour and its white edge are multiplied with
  for (const Lamp& lamp : rig().lamps) {
    const float n_dot_l = dot(n, lamp.direction);
    if (n_dot_l <= 0) continue;
    diffuse_light += lamp.strength * n_dot_l;
    const Vec3f h = normalized(v + lamp.direction);
    const float n_dot_h = dot(n, h), v_dot_h = std::max(dot(v, h), 0.0f), a2 = alpha2 + lamp.width;
    const float d = n_dot_h * n_dot_h * (a2 - 1) + 1;
    const float masking = n_dot_l * std::sqrt(n_dot_v * n_dot_v * (1 - a2) + a2) +
                          n_dot_v * std::sqrt(n_dot_l * n_dot_l * (1 - a2) + a2);
    const float specular = a2 / (kPiF * d * d) * 0.5f / masking * kPiF * lamp.strength * n_dot_l;
    const float fresnel = fifth_power(1 - v_dot_h);
    mirrored += specular * (1 - fresnel);
    edge += specular * fresnel;
  }
  const Vec3f r = n * (2 * dot(n, v)) - v;
  const Vec2f split = room_reflectance(roughness, std::min(n_dot_v, 1.0f));
  const float reflected = rig().room(r.y, roughness) * look.occlusion;
  diffuse_light += rig().room(n.y, 1) * look.occlusion;
  mirrored += reflected * split.x;
  edge += reflected * split.y;
  Rgba light = diffuse * diffuse_light + mirror * mirrored + Rgba{edge, edge, edge, 0} + look.emission;
  light.a = look.base_color.a;
  return light;
}

}  // namespace fovea
