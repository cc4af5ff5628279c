#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "fovea/base/context.h"
#include "fovea/base/options.h"
#include "fovea/model/model.h"

namespace fovea {

/// Compression of vertices and indices in a glTF file.
enum class GeometryCompression { none, meshopt };

struct WriteOptions {
  /// Store positions, normals, colours and texture coordinates as integers (KHR_mesh_quantization).
  /// Off by default: without it attributes are stored as they were read.
  bool quantize = false;
  std::int64_t position_bits = 14;  ///< 1..16, of the largest extent of a mesh. gltfpack's default.
  std::int64_t uv_bits = 12;        ///< 1..16
  std::int64_t normal_bits = 8;     ///< 1..16; up to 8 are stored as bytes. Tangents too.
  std::int64_t color_bits = 8;      ///< 1..16; up to 8 are stored as bytes.
  /// `meshopt` writes EXT_meshopt_compression; best with `quantize`.
  GeometryCompression compression = GeometryCompression::none;
  /// Replace an existing output file. An input of the same run is only replaced with this.
  bool force = false;
};
OptionList describe(WriteOptions& options);

/// One file of an output: name relative to the output's folder ("" for the output itself).
struct OutputFile {
  std::string name;
  std::vector<std::byte> bytes;
};

/// Writes a model in the format of the extension: .glb, .gltf (with .bin and images beside it),
/// .obj (+ .mtl and images), .ply. All files are written to temporary names and renamed when all are
/// complete; nothing is left behind on failure. Returns the files that make up the output: `path`, then
/// those beside it.
///
/// Throws Error(output), Error(usage) for an unknown extension or an existing file without `force`,
/// Error(unsupported) if the format cannot hold what the model needs (a PLY of an animation loses
/// it: that is a diagnostic, not an error).
std::vector<std::filesystem::path> write_model(const Model& model, const std::filesystem::path& path,
                                               const WriteOptions& options, Context& context);

/// Throws what `write_model` would throw about its output alone, so that nobody works for long to hear of it
/// in the end: Error(usage) for an unknown extension or an existing file without `force`, Error(output) for a
/// folder that is missing or a place that is taken by something else than a file.
void check_output(const std::filesystem::path& path, bool force);
/// And Error(usage) for options that the format of the extension has no use for.
void check_output(const std::filesystem::path& path, const WriteOptions& options);
/// The first for a file of any kind, whatever its extension.
void check_place(const std::filesystem::path& path, bool force);

/// Writes files safely: each to a temporary name beside its place, then all renamed, `path` itself last.
/// Folders inside names are made; a side file that is there already with the same content is left alone.
/// Nothing new is left behind on failure. Throws Error(output), Error(usage) for an existing file without
/// `force`.
void write_files(const std::filesystem::path& path, std::span<const OutputFile> files, bool force);
/// The same of one file of text.
void write_text(const std::filesystem::path& path, std::string_view text, bool force);

/// Bytes that a model's file holds, by kind.
struct ByteCounts {
  std::uint64_t geometry = 0;   ///< Vertices, indices and morph targets as stored (compressed if so).
  std::uint64_t images = 0;     ///< Encoded images.
  std::uint64_t animation = 0;  ///< Animation samplers and skins.
  std::uint64_t other = 0;      ///< JSON, padding, points and lines, what extensions carry.
  std::uint64_t total() const { return geometry + images + animation + other; }
};

}  // namespace fovea
