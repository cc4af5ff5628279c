#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "fovea/base/math.h"
#include "fovea/model/model.h"
#include "fovea/texture/atlas.h"
#include "fovea/texture/mip_map.h"

// Shared inside Fovea, not installed.

namespace fovea {

/// What a normal map's channels stand for at a place: orthogonal unit vectors. Pictures have green pointing
/// up, so the bitangent runs against v.
struct TangentFrame {
  Vec3d tangent, bitangent, normal;

  Vec3d out(Vec3d mapped) const { return tangent * mapped.x + bitangent * mapped.y + normal * mapped.z; }
  Vec3d in(Vec3d direction) const {
    return {dot(direction, tangent), dot(direction, bitangent), dot(direction, normal)};
  }
};

/// By how much normal maps turn from one frame to the other: the angle from the old tangent towards the old
/// bitangent, in radians.
float turn(const TangentFrame& from, const TangentFrame& to);

/// A texel of a normal map as a frame stores it that is turned by `angle`, radians, and mirrored or not.
Rgba turned(Rgba normal, float angle, bool is_mirrored);

/// The frames of an atlas's triangles in the pose at rest, in the space of their meshes: of the meshes' own
/// normals and tangents; without normals triangles are flat, without tangents these follow the coordinates,
/// averaged by area over triangles that share a value.
class TangentFrames {
 public:
  /// O(#F). `faces` must be those of the model.
  TangentFrames(const Model& model, std::span<const AtlasFace> faces);

  TangentFrame at(std::uint32_t face, const std::array<double, 3>& weights) const;
  Vec3d normal(std::uint32_t face, const std::array<double, 3>& weights) const;
  /// Of the triangle's plane; unit, or zero if it has no area.
  Vec3d face_normal(std::uint32_t face) const { return corners_[face].face_normal; }
  /// Tangent and side (1, -1) of a corner, as a layer of tangents has them.
  std::array<float, 4> corner_tangent(std::uint32_t face, std::size_t corner) const;

 private:
  struct Corners {
    Vec3d face_normal;
    std::array<Vec3f, 3> normals, tangents;
    double side = 1;  // bitangent = side · normal × tangent
  };
  void add_normals(const Model& model, std::span<const AtlasFace> faces);
  void add_tangents(const Model& model, std::span<const AtlasFace> faces);

  std::vector<Corners> corners_;  // [#faces]
};

/// By how much normal maps turn at each corner of triangles whose coordinates change from `from[i]` to
/// `to[i]`, against frames that follow the coordinates; 0 where a mesh has tangents of its own, which stay.
/// O(#F).
std::vector<std::array<float, 3>> tangent_turns(const Model& model, std::span<const AtlasFace> from,
                                                std::span<const AtlasFace> to);

}  // namespace fovea
