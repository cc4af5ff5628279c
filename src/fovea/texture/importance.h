#pragma once

#include <span>
#include <vector>

#include "fovea/base/context.h"
#include "fovea/model/field.h"
#include "fovea/model/image.h"
#include "fovea/model/model.h"
#include "fovea/texture/atlas.h"

namespace fovea {

/// Which texels of an atlas matter, and why. All [h × w × 1], of the atlas's proportions; 0 where no triangle
/// is.
struct TextureImportance {
  ImageF saliency;    ///< STM of Yang et al. (2016), section 4.2.1: the field over the triangles. 0 … 1.
  ImageF distortion;  ///< TDM: how much less of the texture than others a triangle has. 0 … 1.
  ImageF coverage;    ///< Surface per texture, as the scene shows it: the mean over all triangles is 1.
  ImageF detail;      ///< What the wanted size loses (`SeenLoss::map`).
};

/// The maps that follow from shape alone; `detail` is left empty. The field [#meshes][#V] says how much is
/// looked at, 0 … 1; empty for alike everywhere.
///
/// TDM: 1/φ, φ the smallest singular value of a triangle's map from the surface to the texture; averaged by
/// area to the values that triangles share, over its 98th percentile, no more than 1. Of a mesh that is shown
/// several times the largest counts. `longest_side` in texels of the maps. O(#F + #texels), parallel. Throws
/// Error(usage) for a field of another model, Error(cancelled).
TextureImportance texture_importance(const Model& model, const Atlas& atlas,
                                     std::span<const VertexField> field, int longest_side,
                                     const Context& context);

/// The surface of an atlas's triangles as the scene shows it, each times the mean of the field at its
/// corners. Of a mesh that is shown several times the largest counts. Throws Error(usage). O(#F).
double seen_area(const Model& model, const Atlas& atlas, std::span<const VertexField> field);

/// IM = N(STM) · N(TDM) of the paper. N scales by constants, which do not count here.
ImageF saliency_importance(const TextureImportance& maps);
/// Detail alone, as Balmelli et al. ("Space-optimized texture maps", 2002) have it: √detail.
ImageF frequency_importance(const TextureImportance& maps);
/// Texels along a line for the least error that people look at. If the squared error of a place falls with
/// the square of the texels along a line, as it does for pictures whose spectrum falls as that of
/// photographs, the sum of (saliency · coverage · detail / texels²) over the image is least for a given sum
/// of texels² when texels are as the fourth root of the product.
ImageF balanced_importance(const TextureImportance& maps);

}  // namespace fovea
