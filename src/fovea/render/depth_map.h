#pragma once

#include <vector>

#include "fovea/base/context.h"
#include "fovea/base/math.h"
#include "fovea/render/scene.h"
#include "fovea/render/view.h"

// Shared inside Fovea, not installed.

namespace fovea {

/// Where a view sees a point of space: pixels from the top left of a square picture.
struct PicturePoint {
  double x = 0, y = 0;
  double distance =
      0;  ///< In front of the eye's plane; in perspective nothing is seen where it is not positive.
};
PicturePoint picture_point(const View& view, int size, Vec3d p);
/// The width of a pixel in a plane at that distance, in units of the scene.
double pixel_width(const View& view, int size, double distance);

/// What is in front at each pixel of a view, or up to a pixel beside it: the farthest of nine, so that a
/// surface does not hide itself where it is seen at an angle.
class DepthMap {
 public:
  DepthMap(const RenderScene& scene, const View& view, int size, const Context& context);
  /// Whether nothing is in front of a point, to about two pixels along edges of what hides; what lies outside
  /// the picture is taken to its border.
  bool shows(Vec3d p) const;

 private:
  std::size_t at(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(size_) + static_cast<std::size_t>(x);
  }

  View view_;
  int size_;
  std::vector<double> depth_;
};

}  // namespace fovea
