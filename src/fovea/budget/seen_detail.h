#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "fovea/base/context.h"
#include "fovea/budget/height_field.h"
#include "fovea/render/scene.h"
#include "fovea/render/view.h"

namespace fovea {

/// How finely an image is seen, square by square of kCell × kCell texels.
struct ResolutionMap {
  static constexpr int kCell = 8;  ///< Texels along each side.

  int columns = 0, rows = 0;            ///< Squares, the last of each cut off by the image's border.
  std::vector<float> pixels_per_texel;  ///< [rows × columns]; 0 where nobody sees it.
};

/// For each square of an image of a scene how many pixels a texel takes, along the line where it takes most,
/// in that of the pictures of `size` pixels high where it takes most. Triangles count whose material
/// shows the image and that face the eye, lie in the picture and are not hidden; squares next to them count
/// as well, as filters reach there. Triangles that reach behind the eye's plane count as unseen. `image`:
/// index into RenderScene::images. Throws Error(cancelled). Cost: that of the pictures' triangles.
ResolutionMap texel_resolution(const RenderScene& scene, std::size_t image, std::span<const View> views,
                               int size, const Context& context);

/// [rows × columns] What a height that is wrong by 1 moves on the screen: the root of the sum, over all
/// pictures and the pixels that a grid point stands for, of the square of how many pixels it moves there; 0
/// for points that no picture shows. As weights of QuadtreeLevels with HeightError::squares the error is that
/// of the screen, in squared pixels (Horbelt et al. 2001, figure 2). `scene` is of the model with the field.
/// Throws Error(cancelled).
std::vector<float> height_weights(const HeightField& field, const RenderScene& scene,
                                  std::span<const View> views, int size, const Context& context);

}  // namespace fovea
