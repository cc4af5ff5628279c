#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "fovea/base/math.h"
#include "fovea/base/wide.h"

namespace fovea {

namespace light_table {

constexpr int kSide = 64;

/// Where a normal is in the table: the first of its four entries, and shares of the next column and row.
struct TablePlaces {
  WideInts first;
  WideFloats across, down;
};

FOVEA_WIDE_PART void find_places(const WideFloats& nx, const WideFloats& ny, const WideFloats& nz,
                                 TablePlaces& out) {
  constexpr float kHalf = 0.5f * (kSide - 1);
  WideFloats length_x = nx, length_y = ny, length_z = nz;
  take_sign_off(length_x);
  take_sign_off(length_y);
  take_sign_off(length_z);
  const WideFloats inverse = 1 / (length_x + length_y + length_z);
  const WideFloats x = nx * inverse, y = ny * inverse, one = WideFloats{} + 1.0f;
  // The lower half of the octahedron is folded outwards.
  WideFloats from_x = x, from_y = y;
  take_sign_off(from_x);
  take_sign_off(from_y);
  const WideFloats fx = (1 - from_y) * (x < 0 ? -one : one), fy = (1 - from_x) * (y < 0 ? -one : one);
  const WideFloats u = ((nz < 0 ? fx : x) + 1) * kHalf, v = ((nz < 0 ? fy : y) + 1) * kHalf;
  // What is no number is not less either.
  WideInts column, row;
  convert(u < kSide - 2.0f ? (u > 0 ? u : 0.0f) : kSide - 2.0f, column);
  convert(v < kSide - 2.0f ? (v > 0 ? v : 0.0f) : kSide - 2.0f, row);
  out.first = row * kSide + column;
  convert(column, out.across);
  convert(row, out.down);
  out.across = u - out.across;
  out.down = v - out.down;
}

/// `table`: two numbers for each entry.
FOVEA_WIDE_PART void mix_entries(const float* table, const TablePlaces& places, std::int32_t number,
                                 WideFloats& out) {
  WideFloats a, b, c, d;
  for (std::size_t i = 0; i < kWide; ++i) {
    const float* const entry = table + 2 * places.first[i] + number;
    a[i] = entry[0];
    b[i] = entry[2];
    c[i] = entry[2 * kSide];
    d[i] = entry[2 * kSide + 2];
  }
  const WideFloats left = a + (c - a) * places.down, right = b + (d - b) * places.down;
  out = left + (right - left) * places.across;
}

}  // namespace light_table

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
  Light at(Vec3f normal) const;

 private:
  std::vector<Light> lights_;  // [side²] over the octahedron, unfolded
};

FOVEA_WIDE_PART void LightTable::at(const WideFloats& x, const WideFloats& y, const WideFloats& z,
                                    WideFloats& tinted, WideFloats& white) const {
  static_assert(sizeof(Light) == 2 * sizeof(float));
  light_table::TablePlaces places;
  light_table::find_places(x, y, z, places);
  light_table::mix_entries(&lights_[0].tinted, places, 0, tinted);
  light_table::mix_entries(&lights_[0].tinted, places, 1, white);
}

}  // namespace fovea
