#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "fovea/base/context.h"
#include "fovea/base/options.h"
#include "fovea/model/field.h"
#include "fovea/model/model.h"
#include "fovea/render/scene.h"
#include "fovea/render/view.h"

namespace fovea {

/// Where somebody looks in a picture, or with a negative weight where nobody does (a focus of neglect).
struct Focus {
  double x = 0, y = 0;  ///< In pixels from the top left.
  double weight = 1;    ///< Distances from it are divided by this; not 0.
};

/// What of a mesh is found in a cell of the picture.
enum class AttentionElement {
  vertices,  ///< Vertices; what projects outside goes on from the border.
  faces,  ///< Triangles over all cells that they cover, so that large ones are found between their corners.
};

struct AttentionOptions {
  AttentionElement element = AttentionElement::vertices;
  bool visible_only = false;  ///< What is hidden, or outside the picture, has no label. The paper labels all.
  /// Foci are points of the surface: those that the picture shows there. Labels are distances over it.
  bool on_surface = false;
  std::int64_t view_size = 256;  ///< Width and height of the picture, and of the grid: 16 … 4096.
};
OptionList describe(AttentionOptions& options);

/// Distances from foci, in a fifth of a pixel of the picture; infinite where there is no label. For each mesh
/// one of each vertex: over its instances the smallest.
struct AttentionLabels {
  std::vector<VertexField> attended;   ///< From the nearest focus,
  std::vector<VertexField> neglected;  ///< and from the nearest focus of neglect.
};

/// Labels a model by how far each vertex is from where somebody looks (Mata et al. 2006, paper 004): the
/// chamfer 5-7-11 distance transform of the picture, back on what projects into each cell. Distances from a
/// focus are divided by its weight; the smallest counts.
///
/// On the surface (the paper's future work: for all views at once) distances are exact geodesics from the
/// point under the pixel, as if seen at the size that it has there, up to `reach`; to parts that no triangles
/// join to it, straight ones.
///
/// `scene` is of the model, posed as it is seen; labels of surfaces are of the rest pose. O(#V + #pixels ·
/// #foci), on the surface the cost of GeodesicSearch. Throws Error(usage) for foci outside the picture, or
/// without surface under them if they are to be on it.
AttentionLabels attention_labels(const Model& model, const RenderScene& scene, const View& view,
                                 std::span<const Focus> foci, const AttentionOptions& options, double reach,
                                 const Context& context);

}  // namespace fovea
