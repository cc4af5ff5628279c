#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>

#include "fovea/io/read.h"
#include "fovea/model/model.h"

namespace fovea {

/// Reads PLY, text or binary of either byte order, as one mesh. `place` names the file in messages.
///
/// Vertices: x y z; nx ny nz; red green blue alpha (display values, stored as amounts of light; integers over
/// their largest value); texture coordinates s t, u v, texture_u texture_v or texture_s texture_t.
/// Every other number of a vertex becomes a custom layer "_name" of 32-bit floats, so that measured
/// fields survive. Faces: vertex_indices or vertex_index (polygons are cut into triangles), a list
/// `texcoord` with two numbers per corner, `texnumber`; triangle strips (tristrips). "comment
/// TextureFile NAME" makes materials with an image from `folder`. Everything else is skipped.
///
/// Throws Error(format) with "place:line N" in text and header, "place:byte N" in binary data,
/// Error(unsupported) for point clouds, Error(limit). Counts are checked against the size of the
/// file before anything is allocated.
Model read_ply(std::span<const std::byte> bytes, const std::filesystem::path& folder,
               const std::string& place, const ReadOptions& options, Context& context);

}  // namespace fovea
