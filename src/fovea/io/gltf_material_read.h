#pragma once

#include "fovea/io/gltf_read_state.h"

// Private to io.

namespace fovea::gltf {

/// Reads images (still encoded), samplers, textures and materials into the model.
void read_images(ReadState& state);
void read_samplers(ReadState& state);
void read_textures(ReadState& state);
void read_materials(ReadState& state);

}  // namespace fovea::gltf
