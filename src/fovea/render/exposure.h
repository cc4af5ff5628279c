#pragma once

#include <span>
#include <vector>

#include "fovea/base/context.h"
#include "fovea/model/field.h"
#include "fovea/render/scene.h"
#include "fovea/render/view.h"

namespace fovea {

/// How much of the surface around each vertex a set of views sees: of the pixels that its triangles would
/// cover in all views if nothing else were there and both of their sides showed, the part in which they are
/// in front. On a convex solid a half, at most 1; 0 where no view sees anything. Where no triangle at a
/// vertex is large enough to tell: the mean over the mesh's other vertices. Of a mesh that is shown several
/// times all showings count. [#meshes of the model][#V]; meshes that are not shown have an empty field.
///
/// From pictures `size` pixels high, with one sample per pixel. Cost: that of the pictures and O(#V +
/// #F) for each view. Throws Error(cancelled).
std::vector<VertexField> exposure(const RenderScene& scene, std::size_t mesh_count,
                                  std::span<const View> views, int size, const Context& context);

}  // namespace fovea
