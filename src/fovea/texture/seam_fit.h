#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "fovea/base/context.h"
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

/// Changes the texels that seams read so that bilinear filters find there, and on the triangles around, what
/// the whole image shows: least squares over points half a texel apart along seams, which count twice, and
/// over the surface, by its area; eight rounds of conjugate gradients from the image as it is. What lies on
/// one side of a seam then is what lay there, whatever is beside it in the image. For all images of an atlas.
class SeamFit {
 public:
  /// `from` and `to` are the triangles where they are in whole images and in smaller ones. Keeps references
  /// to both. O(#F log #F).
  SeamFit(const Model& model, std::span<const AtlasFace> from, std::span<const AtlasFace> to);

  bool has_seams() const { return !seams_.empty(); }

  /// Whether images that mean this are fitted: colours alone, as normals differ across seams by their frames,
  /// and of roughness pictures did not gain; none that show through.
  static bool is_for(const TexelMeaning& meaning) {
    return meaning.kind == TexelMeaning::Kind::color && !meaning.transparent;
  }
  /// `whole` is the map of the whole image, `wrap_u` and `wrap_v` are as both are read. Alpha stays.
  /// O(#F + texels + texels along seams · rounds), parallel but for the rounds.
  void fit(Image8& image, const MipMap& whole, Wrap wrap_u, Wrap wrap_v, const Context& context) const;

 private:
  std::span<const AtlasFace> from_, to_;
  std::vector<SeamEdge> seams_;
  std::vector<UvSlopes> slopes_;   // [#faces] as `texel_slopes` of an image of one texel
  std::vector<double> densities_;  // [#faces]
};

}  // namespace fovea
