#pragma once

#include <array>
#include <cstdint>
#include <memory>

#include "fovea/base/math.h"
#include "fovea/surface/surface.h"

namespace fovea {

/// A point of a triangle, with the weights of its corners there: 0 … 1, of sum 1.
struct TrianglePoint {
  Vec3d point;
  std::array<double, 3> weights{1, 0, 0};
};

/// The point of a triangle that is nearest to p (Ericson 2005, 5.1.5).
TrianglePoint closest_on_triangle(Vec3d p, Vec3d a, Vec3d b, Vec3d c);

/// Finds the nearest points of a surface; built once, asked often, from any thread.
class ClosestPoint {
 public:
  struct Hit {
    Vec3d point;
    double distance = 0;  ///< Infinite if the surface has no triangles.
    std::uint32_t triangle = 0;
    std::array<double, 3> weights{1, 0, 0};  ///< Of its corners, as TrianglePoint has them.
  };

  /// O(#F log #F). `surface` must outlive this.
  explicit ClosestPoint(const Surface& surface);
  ~ClosestPoint();
  ClosestPoint(ClosestPoint&&) noexcept;
  ClosestPoint& operator=(ClosestPoint&&) noexcept;

  /// Of equally near triangles the one with the lowest number. About O(log #F).
  Hit nearest(Vec3d p) const;

 private:
  struct Tree;
  std::unique_ptr<Tree> tree_;
};

}  // namespace fovea
