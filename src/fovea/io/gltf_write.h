#pragma once

#include <span>
#include <string>
#include <vector>

#include "fovea/io/write.h"
#include "fovea/model/model.h"

namespace fovea {

/// A model as glTF files in memory, and what they are made of.
struct GltfOutput {
  std::vector<OutputFile> files;  ///< The .glb alone, or .gltf, .bin and images.
  ByteCounts bytes;
};

/// Encodes a model as glTF 2.0: `binary` gives one GLB, else a .gltf with `stem`.bin beside it and
/// images in files of their own under the names they came with.
///
/// Vertices are split (model/weld.h), ordered for the vertex cache and for fetching (meshoptimizer);
/// equal data is stored once. Untouched elements are written from their own JSON. Attributes are
/// stored as they were read or as `options` say; indices as small as fits. The extension lists are
/// made anew from what the file uses.
///
/// What cannot be stored as it is gets repaired, dropped or kept as floats, and `context` is told: numbers
/// that are not finite, normals and tangents without direction, colours beyond [0, 1], joint weights, meshes
/// and parts without triangles (with the animations of their morph targets; only meshes are renumbered for
/// it), attributes that glTF cannot hold. Throws Error(usage) for a model that refers to what it does not
/// have or carries text that is not JSON, Error(limit) for a GLB beyond 4 GiB, Error(cancelled).
///
/// `vertices_of` is for levels of detail that are made of the same vertices, [#meshes] or empty: the mesh
/// before of which each is a coarser level, -1 for none. Their vertices are stored once, those of the
/// coarsest level first, so that each level uses a beginning of what the level before it uses; they differ in
/// indices alone. Meshes whose attributes differ keep vertices of their own.
GltfOutput write_gltf(const Model& model, bool binary, const std::string& stem, const WriteOptions& options,
                      Context& context, std::span<const int> vertices_of = {});

}  // namespace fovea
