#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "fovea/model/image.h"
#include "fovea/model/model.h"
#include "fovea/texture/atlas.h"
#include "fovea/texture/mip_map.h"
#include "fovea/texture/resize.h"

// Shared inside Fovea, not installed.

namespace fovea {

/// An edge of a triangle at which the surface goes on elsewhere in the images of its atlas: from a corner to
/// the next.
struct SeamEdge {
  std::uint32_t face = 0;  ///< Of the list that was looked at.
  std::uint32_t corner = 0;
};

/// Both sides of all seams between an atlas's triangles. O(#F log #F).
std::vector<SeamEdge> seam_edges(const Model& model, std::span<const AtlasFace> faces);

/// What a smaller image is to show.
struct WholeImage {
  const MipMap* map = nullptr;
  std::span<const AtlasFace> faces;  ///< Where triangles are in it.
  TexelMeaning meaning;
};

/// Changes the texels that seams read so that bilinear filters find there, and on the triangles around, what
/// the whole image shows: least squares over points half a texel apart along seams, which count twice, and
/// over the surface, by its area; eight rounds of conjugate gradients from the image as it is. What lies on
/// one side of a seam then is what lay there, whatever is beside it in the image. Colours alone: normals
/// differ across seams by their frames, and of roughness pictures did not gain. Images that show through stay
/// as they are, and so does alpha.
///
/// `faces` [#faces of `whole`] is where triangles are in the image. O(#F + texels + texels along seams ·
/// rounds).
void fit_seams(Image8& image, std::span<const AtlasFace> faces, Wrap wrap_u, Wrap wrap_v,
               std::span<const SeamEdge> seams, const Model& model, const WholeImage& whole);

}  // namespace fovea
