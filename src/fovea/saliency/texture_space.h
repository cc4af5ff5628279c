#pragma once

#include <vector>

#include "fovea/base/context.h"
#include "fovea/model/field.h"
#include "fovea/model/model.h"

namespace fovea {

/// The images that are the base colour of triangles with a place in them, in their order: what
/// `texture_space_map` can be drawn for. Throws Error(unsupported) if there is none.
std::vector<int> texture_space_images(const Model& model);

/// The saliency texture map of Yang et al. (2016), section 5: the field interpolated over the triangles in
/// the space of an image that is their base colour. Where triangles share texels the largest value counts;
/// beyond their borders the nearest texel's goes on for a few texels, the rest is 0. All materials with this
/// image are drawn together. Of the image's size, but at most 4096 along a side; one channel, 255 stands
/// for 1. A triangle over which the image repeats many times is drawn as if it did so less often.
///
/// Throws Error(unsupported) if the image does not tell its size, Error(usage) for fields of another model.
/// `fields`, [#meshes][#V], 0 … 1. O(#F + #texels covered).
Image8 texture_space_map(const Model& model, const std::vector<VertexField>& fields, int image,
                         Context& context);

}  // namespace fovea
