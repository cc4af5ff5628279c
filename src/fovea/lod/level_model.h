#pragma once

#include "fovea/lod/contraction.h"
#include "fovea/lod/vertex_hierarchy.h"
#include "fovea/model/model.h"

namespace fovea {

/// The original with its meshes as indices into level vertices give them: for pictures and files of what an
/// engine draws. Vertices of one place with different values stay apart, as on the card. O(#F · #layers).
Model model_of_level(const Model& original, const VertexHierarchy& hierarchy, const LevelIndices& level);

}  // namespace fovea
