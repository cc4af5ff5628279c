#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <optional>

#include "fovea/base/math.h"
#include "fovea/model/material.h"
#include "fovea/model/tri_mesh.h"

// Private to saliency.

namespace fovea {

/// Where a material finds its texture on a mesh.
struct UvMap {
  /// Turns of a texture beyond which floats know little of where in a texel they are.
  static constexpr double kMostTurns = 1e6;

  const AttributeLayer* layer = nullptr;
  UvMatrix matrix;

  UvMap(const TriMesh& mesh, const TextureRef& ref) : layer(mesh.find(Semantic::uv, ref.uv_set)) {
    if (ref.transform) matrix = fovea::matrix(*ref.transform);
  }

  /// A triangle in the texture; none if it has no place there.
  std::optional<std::array<Vec2d, 3>> triangle(std::uint32_t face) const {
    std::array<Vec2d, 3> corners;
    for (std::size_t k = 0; k < 3; ++k) {
      const ValueId id = layer->corner_value[std::size_t{3} * face + k];
      if (!id.valid()) return {};
      const float* const uv = layer->value(id);
      const Vec2d at = matrix(static_cast<double>(uv[0]), static_cast<double>(uv[1]));
      if (!(std::abs(at.x) <= kMostTurns && std::abs(at.y) <= kMostTurns)) return {};
      corners[k] = at;
    }
    return corners;
  }
};

}  // namespace fovea
