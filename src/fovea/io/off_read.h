#pragma once

#include <cstddef>
#include <span>
#include <string>

#include "fovea/io/read.h"
#include "fovea/model/model.h"

namespace fovea {

/// Whether bytes begin like an OFF text file: "OFF" with "C", "N", "ST" or a mix of these before it.
bool is_off(std::span<const std::byte> bytes);

/// Reads OFF text, as one mesh, with the normals (NOFF) and colours (COFF; display values) of vertices.
/// Colours of faces are skipped. `source_vertex` has one entry per vertex of the file.
///
/// Throws Error(format) with "place:line N", Error(unsupported) for binary and four-dimensional
/// files and point clouds, Error(limit).
Model read_off(std::span<const std::byte> bytes, const std::string& place, const ReadOptions& options,
               Context& context);

}  // namespace fovea
