#pragma once

#include "fovea/io/gltf_read_state.h"

// Private to io.

namespace fovea::gltf {

/// Reads the meshes into the model, each welded (model/weld.h). Strips and fans become triangles, Draco
/// data is decoded, points and lines stay as they are.
void read_meshes(ReadState& state);

/// Compares meshes with the nodes that show them, when both are read: morph weights of a node are made
/// as many as its mesh has targets; joints that a skin lacks are reported.
void fit_mesh_users(ReadState& state);

}  // namespace fovea::gltf
