#pragma once

#include <vector>

#include "fovea/io/gltf_buffer_write.h"
#include "fovea/model/model.h"

// Private to io: EXT_mesh_gpu_instancing on the way out.

namespace fovea::gltf {

/// Makes the extension of `object`, the JSON of `node`, say where the node's instances are. What it says
/// already stays, with attributes of its own; new transforms are stored as floats.
void write_instances(Json& object, const Node& node, const std::vector<Accessor>& carried,
                     BufferWriter& buffers);

}  // namespace fovea::gltf
