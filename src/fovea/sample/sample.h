#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "fovea/base/context.h"
#include "fovea/model/image.h"
#include "fovea/model/model.h"

namespace fovea {

/// A model that Fovea makes itself, so that it can be tried and tested without any file.
struct SampleInfo {
  std::string name;         ///< "vase"
  std::string description;  ///< One line.
};

/// What `make_sample` knows, in the order of `fovea sample --list`.
std::vector<SampleInfo> samples();

/// Makes a sample: `vase` (a plain figure painted on a busy ground, after Yang et al. 2016), `arm` (a
/// skinned, bending arm, after Munaretti 2007), `spheres` (two near spheres, one of which a morph
/// target deforms, idem figure 3.4), `terrain` (a block of earth whose heights have a photo-like
/// texture, after Horbelt et al. 2001). Each has tens of thousands of triangles, real UV seams and textures
/// made for it. `detail` scales the number of triangles (1 = default). Deterministic in the seed of
/// `context`.
///
/// Throws Error(usage) for an unknown name, with the nearest one.
Model make_sample(const std::string& name, double detail, Context& context);

/// Land by its heights and a picture of it, both with rows from north to south.
struct TerrainMap {
  ImageF heights;        ///< One channel, 0 … 1 (`decode_heights`), 2 × 2 pixels or more.
  EncodedImage texture;  ///< Of the whole map, as its file holds it; it is not looked at.
  double width = 10;     ///< Metres along the longer side,
  double relief = 1;     ///< and from height 0 to 1.
};

/// Decodes a height map: PNG (with all bits of those of 16), JPEG or WebP; grey, black is 0, white is 1.
/// Throws what `decode_image` throws and Error(unsupported) for colours and for less than 2 × 2 pixels.
ImageF decode_heights(std::span<const std::uint8_t> encoded);

/// The surface over a map, open around its rim: a vertex in the middle of each pixel, two triangles between
/// four; x to the east, y up, z to the south, the map's middle at x = z = 0. `detail` scales the number of
/// triangles, 1 at most: heights are then means over pixels. Throws Error(usage) for numbers out of range,
/// Error(limit) for more than 2^26 points.
Model make_terrain(const TerrainMap& map, double detail, Context& context);

}  // namespace fovea
