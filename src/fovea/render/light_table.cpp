#include "fovea/render/light_table.h"

#include <cmath>

#include "fovea/render/light_rig.h"

namespace fovea {

namespace {

constexpr int kSide = 64;

/// Where a normal is in the table: the first of its four entries, and shares of the next column and row.
struct TablePlaces {
  WideInts first;
  WideFloats across, down;
};

FOVEA_WIDE void find_places(const WideFloats& __restrict nx, const WideFloats& __restrict ny,
                            const WideFloats& __restrict nz, TablePlaces& __restrict out) {
  constexpr float kHalf = 0.5f * (kSide - 1);
  for (std::size_t i = 0; i < kWide; ++i) {
    const float inverse = 1 / (std::abs(nx[i]) + std::abs(ny[i]) + std::abs(nz[i]));
    const float x = nx[i] * inverse, y = ny[i] * inverse;
    // The lower half of the octahedron is folded outwards.
    const float fx = (1 - std::abs(y)) * (x < 0 ? -1.0f : 1.0f);
    const float fy = (1 - std::abs(x)) * (y < 0 ? -1.0f : 1.0f);
    const float u = ((nz[i] < 0 ? fx : x) + 1) * kHalf, v = ((nz[i] < 0 ? fy : y) + 1) * kHalf;
    // What is no number is not less either.
    const auto column = static_cast<std::int32_t>(u < kSide - 2 ? (u > 0 ? u : 0.0f) : kSide - 2.0f);
    const auto row = static_cast<std::int32_t>(v < kSide - 2 ? (v > 0 ? v : 0.0f) : kSide - 2.0f);
    out.first[i] = row * kSide + column;
    out.across[i] = u - static_cast<float>(column);
    out.down[i] = v - static_cast<float>(row);
  }
}

/// `table`: two numbers for each entry.
FOVEA_WIDE void mix_entries(const float* __restrict table, const TablePlaces& __restrict places,
                            std::int32_t number, WideFloats& __restrict out) {
  for (std::size_t i = 0; i < kWide; ++i) {
    const std::int32_t at = 2 * places.first[i] + number;
    const float a = table[at], b = table[at + 2], c = table[at + 2 * kSide], d = table[at + 2 * kSide + 2];
    const float left = a + (c - a) * places.down[i], right = b + (d - b) * places.down[i];
    out[i] = left + (right - left) * places.across[i];
  }
}

}  // namespace

void LightTable::at(const WideFloats& x, const WideFloats& y, const WideFloats& z, WideFloats& tinted,
                    WideFloats& white) const {
  static_assert(sizeof(Light) == 2 * sizeof(float));
  TablePlaces places;
  find_places(x, y, z, places);
  mix_entries(&lights_[0].tinted, places, 0, tinted);
  mix_entries(&lights_[0].tinted, places, 1, white);
}

LightTable::LightTable(float metallic, float roughness, Vec3f to_eye) {
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

}  // namespace fovea
