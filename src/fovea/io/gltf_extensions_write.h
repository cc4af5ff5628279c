#pragma once

#include "fovea/io/gltf_json_write.h"
#include "fovea/model/model.h"

// Private to io.

namespace fovea::gltf {

/// Makes "extensionsUsed" and "extensionsRequired" of a finished root object: what its objects have, what its
/// attributes need (`quantized`: KHR_mesh_quantization), and what the model lists besides; without what only
/// says how the file that was read stored things.
void write_extension_lists(Json& root, const Model& model, bool quantized);

}  // namespace fovea::gltf
