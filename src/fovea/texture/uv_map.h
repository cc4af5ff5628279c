#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <optional>

#include "fovea/base/math.h"
#include "fovea/model/texture_use.h"
#include "fovea/model/tri_mesh.h"
#include "fovea/model/wrap.h"

// Shared inside Fovea, not installed.

namespace fovea {

/// Where the triangles of a mesh lie in a texture; without a layer they lie nowhere.
struct UvMap {
  const AttributeLayer* layer = nullptr;
  UvMatrixd matrix;

  UvMap(const TriMesh& mesh, const TextureUse& use)
      : layer(mesh.find(Semantic::uv, use.uv_set)), matrix(use.matrix) {}

  /// A triangle in the texture; none if it has no place there.
  std::optional<std::array<Vec2d, 3>> triangle(std::uint32_t face) const {
    std::array<Vec2d, 3> corners;
    for (std::size_t k = 0; k < 3; ++k) {
      const ValueId id = layer->corner_value[std::size_t{3} * face + k];
      if (!id.valid()) return {};
      const float* const uv = layer->value(id);
      const Vec2d at = matrix({static_cast<double>(uv[0]), static_cast<double>(uv[1])});
      constexpr auto kMost = static_cast<double>(kMostTurns);
      if (!(std::abs(at.x) <= kMost && std::abs(at.y) <= kMost)) return {};
      corners[k] = at;
    }
    return corners;
  }
};

}  // namespace fovea
