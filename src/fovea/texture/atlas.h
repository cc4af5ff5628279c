#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "fovea/base/math.h"
#include "fovea/model/model.h"

namespace fovea {

/// A part of a mesh whose triangles lie in the images of an atlas, and by which coordinates.
struct AtlasPart {
  std::uint32_t mesh = 0, part = 0;
  int uv_set = 0;
  friend auto operator<=>(const AtlasPart&, const AtlasPart&) = default;
};

/// Images that triangles lie in by the same coordinates, over all materials, variants among them: if texels
/// move in one, they have to move in all.
struct Atlas {
  std::vector<int> images;       ///< Rising.
  std::vector<AtlasPart> parts;  ///< In the order of meshes and parts.
  /// Why texels cannot move, in words; empty if they can: images cannot be decoded or mean different things,
  /// coordinates are transformed, missing, morphed or go on beyond the image (tiling), or points and lines
  /// use them too.
  std::string fixed_because;
};

/// The atlases of a model, in the order of their first images. Images that no material uses are in none.
/// O(#F).
std::vector<Atlas> find_atlases(const Model& model);

/// A triangle in the images of an atlas: 0 … 1, v down. Coordinates beyond are brought back by whole repeats
/// of the image, chart by chart (connected by shared values), if the whole chart lies in one repeat.
struct AtlasFace {
  std::uint32_t part = 0;  ///< Index into Atlas::parts.
  std::uint32_t mesh = 0, face = 0;
  std::array<Vec2d, 3> uv;
  /// Of its corners: the same for corners that share a value, from 0 on over the whole atlas.
  std::array<std::uint32_t, 3> value{};
};

/// All triangles of an atlas in the order of its parts and their faces; those without coordinates, or with
/// such as cannot be used, are left out. Of the model that the atlas was found in, or one with other
/// triangles in the same parts. O(#F).
std::vector<AtlasFace> atlas_faces(const Model& model, const Atlas& atlas);

/// The model with the coordinates of an atlas's triangles moved, from `from`, as `atlas_faces` has them, to
/// `to`, which has the same for corners that share a value; a chart stays in its repeat. Values that other
/// triangles use too become two. O(#F).
Model with_moved_coordinates(const Model& model, const Atlas& atlas, std::span<const AtlasFace> from,
                             std::span<const AtlasFace> to);

}  // namespace fovea
