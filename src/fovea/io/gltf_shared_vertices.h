#pragma once

#include <span>

#include "fovea/model/weld.h"

// Private to io: levels of a mesh that are made of the same vertices.

namespace fovea::gltf {

/// Gives parts, of levels from the finest to the coarsest, one list of vertices: those of the coarsest first,
/// so that each level uses a beginning of what the level before it uses. Triangles come in an order for the
/// vertex cache, vertices in that in which triangles first use them. Parts without triangles stay as they
/// are.
///
/// Returns false, and changes nothing, if attributes differ.
bool share_vertices(std::span<SplitPart* const> levels);

}  // namespace fovea::gltf
