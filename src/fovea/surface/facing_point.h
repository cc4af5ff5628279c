#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "fovea/base/math.h"
#include "fovea/surface/closest_point.h"
#include "fovea/surface/surface.h"

// Shared inside Fovea, not installed.

namespace fovea {

/// Finds what of a surface lies near a place and faces the same way, so that thin walls are not mistaken for
/// their backs; built once, asked often, from any thread.
class FacingPoint {
 public:
  /// What is looked for: triangles of the same kind whose normals are within about 75° of this one.
  struct Query {
    Vec3d point;
    Vec3d normal;     ///< Unit.
    double most = 0;  ///< Farthest distance.
    std::uint32_t kind = 0;
  };

  /// `kinds` [#F]: whatever must not be mixed up. O(#F log #F). `surface` must outlive this.
  FacingPoint(const Surface& surface, std::vector<std::uint32_t> kinds);
  ~FacingPoint();
  FacingPoint(FacingPoint&&) noexcept;
  FacingPoint& operator=(FacingPoint&&) noexcept;

  /// The nearest along the normal, before or behind. Of equally near triangles the one with the lowest
  /// number. About O(log #F).
  std::optional<ClosestPoint::Hit> along_normal(const Query& query) const;
  /// The nearest in any direction.
  std::optional<ClosestPoint::Hit> nearest(const Query& query) const;

 private:
  struct Tree;
  std::unique_ptr<Tree> tree_;
};

}  // namespace fovea
