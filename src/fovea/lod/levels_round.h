#pragma once

#include <optional>

#include "fovea/io/write.h"
#include "fovea/lod/levels_file.h"

// Private to lod.

namespace fovea {

/// A model and its levels with numbers that take fewer bytes; none if nothing is to be rounded. What a file
/// stored as integers is one at every level: steps make others. With `options.quantize` positions, texture
/// coordinates, normals, tangents and colours are multiples of powers of two, at least as fine as the bits
/// of `options` say. Errors of levels grow by half the diagonal of what positions are rounded to.
std::optional<LeveledModel> rounded_levels(const LeveledModel& leveled, const WriteOptions& options);

}  // namespace fovea
