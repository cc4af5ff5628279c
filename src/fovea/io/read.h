#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>

#include "fovea/base/context.h"
#include "fovea/base/options.h"
#include "fovea/model/model.h"

namespace fovea {

/// Limits that keep a hostile or mistaken file from exhausting the machine. Exceeding one is
/// Error(limit) that names the option.
struct ReadOptions {
  std::int64_t max_file_bytes = std::int64_t{8} << 30;  ///< Of any one file, images included.
  std::int64_t max_elements = 400'000'000;  ///< Of any one accessor or index list: vertices, indices, keys.
  std::int64_t max_total_bytes = std::int64_t{8} << 30;  ///< Of all decoded data of one model.
  /// Decoded data over the size of the model's files (1 MiB if they are smaller). Compression, sparse
  /// arrays, zeros that a file need not hold and arrays used many times make a model larger than its
  /// files: about 8 times if they are not compressed, 30 to 100 times if they are.
  std::int64_t max_expansion = 512;
};
OptionList describe(ReadOptions& options);

/// What files of levels (lod/levels_file.h) begin with: a byte that is no letter, so that no text is taken
/// for them, and an end of line that breaks where line ends are changed.
inline constexpr std::string_view kLevelsMagic =
    "\x89"
    "FOVEA\r\n";

/// File formats that Fovea tells apart, by content first and extension second.
enum class FileFormat { gltf, glb, obj, ply, stl, fovea, other };
const char* to_string(FileFormat format);

/// Looks at the first bytes, then at the extension; `other` is left to the general importer.
FileFormat detect_format(std::span<const std::byte> head, const std::filesystem::path& path);

/// Reads a model of any known format. Triangles strips, fans and polygons become triangles;
/// positions are welded (model/weld.h). Texture coordinates have glTF's origin (0, 0 = top left).
///
/// Throws Error: input (file missing), format (damaged; the place is file + JSON pointer, line or
/// byte offset), unsupported, limit. Repairs and drops are diagnostics of `context`.
Model read_model(const std::filesystem::path& path, const ReadOptions& options, Context& context);

/// A whole file in memory. Throws Error(input) or Error(limit).
std::vector<std::byte> read_file(const std::filesystem::path& path, std::int64_t max_bytes);

}  // namespace fovea
