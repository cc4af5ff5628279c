#pragma once

#include <cstddef>
#include <set>
#include <span>
#include <string>
#include <vector>

#include "fovea/io/side_files.h"
#include "fovea/model/material.h"

namespace fovea {

/// Reads a Wavefront material library. Kd and d become the base colour, Ns the roughness
/// ((2 / (Ns + 2))^¼, from the width of a Blinn-Phong highlight), Ke the emission; Pr and Pm, where
/// given, roughness and metal. Images: map_Kd, map_Ke, norm, and map_Bump unless it is grey (a height map).
/// Colours are taken as amounts of light. Options -s, -o, -clamp, -bm of a map are honoured.
///
/// Reads only the materials named in `wanted`, so that no image comes in that nothing shows.
///
/// Never throws for content: what cannot be used is a diagnostic with `place`.
std::vector<Material> read_mtl(std::span<const std::byte> bytes, const std::string& place,
                               const std::set<std::string>& wanted, TextureLoader& textures,
                               Context& context);

/// Roughness of a Blinn-Phong exponent, and back (at most 1000).
double roughness_of_exponent(double exponent);
double exponent_of_roughness(double roughness);

}  // namespace fovea
