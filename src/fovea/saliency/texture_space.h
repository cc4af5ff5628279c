#pragma once

#include <vector>

#include "fovea/base/context.h"
#include "fovea/model/field.h"
#include "fovea/model/model.h"

namespace fovea {

/// A field drawn where the triangles that carry it lie in a texture.
struct TextureSpaceMap {
  int image = -1;  ///< Of the model: the base colour that triangles are mapped to.
  Image8 map;      ///< Of the image's size, at most 4096 along a side; one channel, 255 stands for 1.
};

/// The saliency texture map of Yang et al. (2016), section 5: the field interpolated over the triangles in
/// the space of each image that is a base colour, in the order of the images. Where triangles share texels
/// the largest value counts; beyond their borders the nearest texel's goes on for a few texels, the rest is
/// 0. Alike images of materials are drawn together. Throws Error(usage) if no triangle has a base colour
/// texture. `fields`, [#meshes][#V], 0 … 1. O(#F + #texels covered).
std::vector<TextureSpaceMap> texture_space_maps(const Model& model, const std::vector<VertexField>& fields,
                                                Context& context);

}  // namespace fovea
