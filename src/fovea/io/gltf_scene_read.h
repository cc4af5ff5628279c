#pragma once

#include "fovea/io/gltf_read_state.h"

// Private to io.

namespace fovea::gltf {

/// Reads nodes (with their instances), scenes, skins and cameras into the model. Nodes make a forest:
/// a second parent or a cycle is Error(format).
void read_nodes(ReadState& state);
void read_scenes(ReadState& state);
void read_skins(ReadState& state);
void read_cameras(ReadState& state);
/// Reads animations; their data stays as it is, bit for bit.
void read_animations(ReadState& state);

}  // namespace fovea::gltf
