#pragma once

#include <cstdint>
#include <span>

#include "fovea/base/math.h"
#include "fovea/model/tri_mesh.h"
#include "fovea/texture/felzenszwalb.h"

// Private to texture.

namespace fovea {

/// Segments the triangles `faces` of a mesh (in rising order) by their colours, given as display values 0 …
/// 255, over the edges between them. Around an edge of more than two triangles each is compared with the
/// next by number. Labels are in the order of `faces`. O(#faces log #faces).
Segmentation segment_faces(const TriMesh& mesh, std::span<const std::uint32_t> faces,
                           std::span<const Vec3f> colors, const SegmentOptions& options,
                           const Context& context);

}  // namespace fovea
