#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>

#include "fovea/io/read.h"
#include "fovea/model/model.h"

namespace fovea {

/// Reads Wavefront OBJ with its material libraries and images, which must lie inside `folder`, as one
/// mesh with one part per material in order of first use. `place` names the file in messages.
///
/// Polygons are cut into triangles (concave ones too). Vertex colours after the position become
/// COLOR_0 (taken as display values, stored as amounts of light). Objects, groups and smoothing groups are
/// ignored. `source_vertex` has one entry per `v` line. A missing library or image is a diagnostic;
/// so are points, lines and free-form surfaces, which are dropped.
///
/// Throws Error(format) with "place:line N" for damaged numbers and indices that are 0 or out of
/// range, Error(unsupported) if there is no face, Error(limit). O(n), about 100 MB a second.
Model read_obj(std::span<const std::byte> bytes, const std::filesystem::path& folder,
               const std::string& place, const ReadOptions& options, Context& context);

}  // namespace fovea
