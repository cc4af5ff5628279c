#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>

#include "fovea/io/read.h"
#include "fovea/model/model.h"

namespace fovea {

/// Reads glTF 2.0 from memory: GLB if `bytes` starts with its magic, else JSON. External buffers and
/// images are taken from `folder` and never from outside of it (after resolving "..", symbolic links
/// included). `place` names the file in messages.
///
/// Understands data URIs, sparse accessors, all component types, KHR_mesh_quantization,
/// EXT/KHR_meshopt_compression, KHR_draco_mesh_compression, EXT_mesh_gpu_instancing,
/// KHR_texture_transform, KHR_texture_basisu and EXT_texture_webp (as references), all primitive
/// modes. Everything else goes through unchanged (model/model.h), with these exceptions:
/// - An element's `json` lacks what its typed members hold and what only means something inside the
///   file: "primitives" of a mesh; "attributes", "indices", "targets" and "mode" of a primitive; "uri",
///   "bufferView" and "mimeType" of an image; accessors of skins and animation samplers.
/// - Compression leaves no trace, in `json` or in the lists of extensions.
/// - Names and extras of buffers, buffer views and accessors are not kept.
/// - CESIUM_primitive_outline, EXT_mesh_manifold and FB_ngon_encoding number the file's vertices or
///   triangles; they are dropped, with a diagnostic.
///
/// A required extension that is not known here is refused if a primitive, accessor, buffer view or
/// buffer carries it (or it is known to change those: KHR_mesh_primitive_restart, KHR_accessor_float64);
/// else it is carried along, with a diagnostic. Numbers that are not finite are an error in positions
/// and become 0 elsewhere, with a diagnostic; animations and inverse bind matrices stay bit for bit.
///
/// Throws Error(format) with "file/json/pointer" (or "file byte N" in the container or JSON syntax) for
/// anything outside the specification that would make reading unsafe or meaningless, Error(unsupported)
/// for a required extension as above or another glTF version, Error(limit), Error(input) for missing
/// external files. Memory is bounded by ReadOptions::max_total_bytes and max_expansion,
/// whatever the file claims.
Model read_gltf(std::span<const std::byte> bytes, const std::filesystem::path& folder,
                const std::string& place, const ReadOptions& options, Context& context);

}  // namespace fovea
