#pragma once

#include <cstddef>
#include <vector>

#include "fovea/base/context.h"
#include "fovea/model/field.h"
#include "fovea/model/model.h"
#include "fovea/saliency/texture_signals.h"

namespace fovea {

/// Which signals are wanted besides those of the colour.
struct SurfaceSignalOptions {
  TextureSignalOptions texture;
  bool emission = false;
  bool roughness = false;
  bool metalness = false;
  bool normal_detail = false;
};

/// What the materials of a mesh say to the eye at its vertices. [#V] each; 0 at vertices without triangles.
struct SurfaceSignals {
  VertexField intensity, opponency, entropy;  ///< Of the base colour, as in TextureSignals.
  VertexField emission;                       ///< Grey of the emitted light as display value: 0 … 1.
  VertexField roughness, metalness;           ///< 0 … 1.
  VertexField normal_detail;  ///< 1 − cosine of the angle by which the normal map bends: 0 … 2.
  /// Texels of the base colour that a vertex stands for: a third of those under its triangles. Weights for
  /// averages as the paper has them, in which texels count alike: G(f · texels) / G(texels). Triangles
  /// without a texture count by their area.
  VertexField texels;
  bool textured = false;  ///< Whether the base colour differs anywhere.
};

/// Brings the signals of textures to the surface. A vertex has the mean by area over the triangles around it
/// (over all its charts and materials) of the mean of the texels that each covers, those near the vertex
/// counting more: by the square of its barycentric coordinate there. These are the texels whose centres lie
/// in the triangle; if there are none, the bilinear sample in its middle. This stands in for the paper's
/// gather of texels around every vertex at every scale (Yang et al. 2016, "inverse mapping"): texels are
/// looked at once, averages over neighbourhoods are left to `gaussian_averages`, and with `texels` as weights
/// the two order vertices alike: rank correlation above 0.9 for radii of 2 to 16 times that of a mean
/// triangle.
///
/// The base colour is texture × factor × vertex colour, multiplied as light and judged as display values.
/// Vertex colours multiply smoothed texels and leave entropy alone. Triangles without a texture, without
/// coordinates for it, or with some that are not finite or beyond ±10⁶, have the colour of their corners and
/// no entropy; so have those whose image cannot be decoded, which is reported ("image-not-shown"). Alpha
/// counts nowhere. Where textures repeat so often that triangles cover more than 2²⁵ texels of one, those
/// with most are sampled on a regular grid.
///
/// All meshes [#meshes]: each image is decoded once, one at a time. Cost: that of `texture_signals` for each
/// texture, then O(#F + #texels covered); parallel, the same bits for any number of threads.
std::vector<SurfaceSignals> surface_signals(const Model& model, const SurfaceSignalOptions& options,
                                            Context& context);
/// One mesh alone.
SurfaceSignals surface_signals(const Model& model, std::size_t mesh, const SurfaceSignalOptions& options,
                               Context& context);

}  // namespace fovea
