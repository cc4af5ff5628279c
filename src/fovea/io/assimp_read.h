#pragma once

#include <cstddef>
#include <filesystem>
#include <span>

#include "fovea/io/read.h"
#include "fovea/model/model.h"

namespace fovea {

/// Reads the formats that have no reader of their own through the Open Asset Import Library: FBX,
/// Collada (DAE), 3DS, DirectX (X), LightWave (LWO), AC3D (AC) and 3MF. Its other importers are
/// switched off: they are untested here, or fail on damaged files in ways that cannot be caught.
///
/// Nodes, materials with textures (embedded, or files inside the model's folder), skins and node
/// animations come through; morph targets, cameras, lights, points and lines do not, which a
/// diagnostic says. Units and axes stay the file's. Companion files are opened inside the model's
/// folder only.
///
/// Throws Error(unsupported) if the format is none of these or there is no triangle, Error(format)
/// with the importer's words, Error(limit).
Model read_assimp(std::span<const std::byte> bytes, const std::filesystem::path& path,
                  const ReadOptions& options, Context& context);

}  // namespace fovea
