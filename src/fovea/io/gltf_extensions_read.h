#pragma once

#include "fovea/io/gltf_read_state.h"

// Private to io.

namespace fovea::gltf {

/// Reads the lists of used and required extensions into the model, without those that reading undoes
/// (compression). Throws Error(unsupported) for a required extension that is not known here and sits in
/// a primitive, accessor, buffer view or buffer, or is known to change how those are read: its file
/// cannot be understood. Other unknown required extensions are a diagnostic.
void read_extension_lists(ReadState& state);

}  // namespace fovea::gltf
