#pragma once

#include <vector>

#include "fovea/base/context.h"
#include "fovea/model/ids.h"
#include "fovea/model/model.h"
#include "fovea/render/view.h"

namespace fovea {

/// The faces of each mesh that no view sees any part of, in rising order. [#meshes]
///
/// On the side of keeping them: a face is hidden only if, in every place where the scene shows it and in
/// every pose, none of its samples has a free line to any eye. Samples lie on a grid over each face, at most
/// a 128th of the scene's radius apart, and close to its corners. Eyes are those of `views`; around the model
/// (all sets but `cameras`) another 256 are spread over the sphere, as somebody will turn it. What a camera's
/// frame leaves out counts as seen. Nothing hides behind materials that are masked, blended or transmit
/// light, nor behind the backs of single-sided ones. Poses are that at rest and, of a model that its
/// animations or morph targets deform, eight key poses. Meshes that the scene does not show have no hidden
/// faces.
///
/// Throws what `views_of` throws and Error(cancelled). O(#eyes · #samples of hidden faces · log #F),
/// parallel.
std::vector<std::vector<FaceId>> hidden_faces(const Model& model, const ViewOptions& views,
                                              const Context& context);

}  // namespace fovea
