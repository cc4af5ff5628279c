#pragma once

#include "fovea/io/gltf_read_state.h"
#include "fovea/model/weld.h"

// Private to io.

namespace fovea::gltf {

/// The arrays of a primitive as the file holds them, decompressed, whatever its mode. Counts agree and
/// indices are in range.
RawPrimitive read_primitive_data(ReadState& state, const JsonView& primitive);

/// Makes split vertices and triangles of a primitive with mode 4, 5 or 6. Positions that are not finite
/// are Error(format); other such numbers become 0 and a diagnostic.
SplitPart to_split_part(ReadState& state, const JsonView& primitive, const RawPrimitive& data);

}  // namespace fovea::gltf
