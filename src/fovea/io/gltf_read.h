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
/// modes. Everything else goes through unchanged (model/model.h).
///
/// Throws Error(format) with "file/json/pointer" for anything outside the specification that would
/// make reading unsafe or meaningless, Error(unsupported) for a required extension that changes
/// geometry in a way unknown here, Error(limit), Error(input) for missing external files.
Model read_gltf(std::span<const std::byte> bytes, const std::filesystem::path& folder,
                const std::string& place, const ReadOptions& options, Context& context);

}  // namespace fovea
