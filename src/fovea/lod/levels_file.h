#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "fovea/base/context.h"
#include "fovea/io/read.h"
#include "fovea/io/write.h"
#include "fovea/lod/multi_tessellation.h"
#include "fovea/model/model.h"

namespace fovea {

/// A model with all its levels.
struct LeveledModel {
  Model original;
  MultiTessellation levels;
};

/// The model at its coarsest: all steps taken, but no mesh goes altogether.
Model coarsest(const LeveledModel& leveled);

/// All levels as one file (.fovea): the coarsest as a GLB, with all images and animations, then the steps
/// back to the original, so that any beginning of the file is a level. docs/levels.md describes it byte by
/// byte. Nothing is lost: the original comes back with all its numbers, but other numbers of its vertices,
/// values and triangles, without those that no triangle uses, and with errors of levels up to 0.8 % larger.
/// What meshes of integers (KHR_mesh_quantization) cannot hold is rounded to them.
///
/// With `options.quantize` numbers are rounded to so many bits first, for files of about a half the size, and
/// errors grow by what rounding can move; `compression` compresses the GLB. Throws Error(unsupported) for a
/// model with levels already (MSFT_lod), Error(cancelled), and as `write_gltf` does.
std::vector<std::byte> encode_levels(const LeveledModel& leveled, const WriteOptions& options,
                                     Context& context);

/// The coarsest level with all others inside, for a file that any program can open: the extension
/// FOVEA_levels refers to the same bytes.
Model with_levels(const LeveledModel& leveled, const WriteOptions& options, Context& context);

/// How much of a file of levels is read.
struct LevelsReadOptions {
  /// Reads on until the finest level has so many triangles; the rest of the file need not be there.
  std::uint64_t triangles = std::numeric_limits<std::uint64_t>::max();
  bool beginning = false;  ///< Whether a file may end early; what is whole of it is read.
};

/// Where a file has levels: nowhere (or it cannot be read), all over (.fovea), or inside (glTF).
enum class LevelsPlace { none, file, inside };
LevelsPlace find_levels(const std::filesystem::path& path);

/// Reads what `encode_levels` wrote. If only a beginning is read, the finest level of that counts as the
/// original. Throws Error(format) for another or a damaged file, Error(unsupported) for another version,
/// Error(limit).
LeveledModel read_levels(std::span<const std::byte> bytes, const std::string& place,
                         const LevelsReadOptions& levels, const ReadOptions& options, Context& context);

/// The same for a model that was read from a GLB; none if there are no levels in it.
std::optional<LeveledModel> levels_inside(const Model& model, const LevelsReadOptions& levels,
                                          const ReadOptions& options, Context& context);

}  // namespace fovea
