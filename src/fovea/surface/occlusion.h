#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "fovea/base/math.h"
#include "fovea/surface/surface.h"

namespace fovea {

/// Says whether something lies between two points; built once, asked often, from any thread.
class Occlusion {
 public:
  /// `double_sided` [#F]: triangles that are seen from behind too; through the backs of the others one looks.
  /// Front sides are where corners run counter-clockwise. O(#F log #F). `surface` must outlive this.
  Occlusion(const Surface& surface, std::vector<bool> double_sided);
  ~Occlusion();
  Occlusion(Occlusion&&) noexcept;
  Occlusion& operator=(Occlusion&&) noexcept;

  /// Whether an eye there sees anything before this point. O(log #F).
  bool hides(Vec3d point, Vec3d eye) const;

 private:
  struct Tree;
  std::unique_ptr<Tree> tree_;
};

}  // namespace fovea
