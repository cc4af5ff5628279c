#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "fovea/model/field.h"
#include "fovea/model/model.h"

namespace fovea {

/// Reads a list of numbers: NumPy's .npy (told by its content), else text with one number per line
/// (blank lines and lines that begin with "#" are skipped; a first line that is no number is a
/// heading; of several columns, parted by blanks, commas or semicolons, the last counts).
/// Throws Error(input, format, unsupported, limit); the place is the file, and the line in text.
std::vector<float> read_field(const std::filesystem::path& path,
                              std::int64_t max_bytes = std::int64_t{8} << 30);

/// An .npy file in memory: versions 1 to 3, little-endian floats of 4 or 8 bytes, integers of 1 to 8
/// bytes or bool, shape (n,), (n, 1) or (). Throws Error(format), Error(unsupported).
std::vector<float> parse_npy(std::span<const std::byte> bytes, const std::string& place);
std::vector<float> read_npy(const std::filesystem::path& path,
                            std::int64_t max_bytes = std::int64_t{8} << 30);

/// The .npy file (version 1) of a list of 32-bit floats.
std::vector<std::byte> encode_npy(std::span<const float> values);
void write_npy(const std::filesystem::path& path, std::span<const float> values, bool force);

/// Writes a list of numbers as the extension says: .npy, or .csv and .txt with a number in a line below the
/// heading `name`; safely, as io/write.h does. `read_field` reads the same numbers back.
void write_field(const std::filesystem::path& path, std::span<const float> values, const std::string& name,
                 bool force);
/// Throws what `write_field` would throw about its output alone: Error(usage) for another extension and for
/// an existing file without `force`, Error(output) for a folder that is missing.
void check_field_output(const std::filesystem::path& path, bool force);

/// The values of all source vertices in the order of the source file: what `field_from_source_order` reads.
/// Source vertices that no triangle uses get 0. Throws Error(usage) for fields of another model.
std::vector<float> field_in_source_order(const Model& model, std::span<const VertexField> fields);

/// One field per mesh from one list for the whole model, in the order of the source file: the
/// concatenation of TriMesh::source_vertex over the meshes. Where several source vertices were
/// welded into one, the largest value wins. A list with as many values as the model has welded
/// vertices is taken in their order instead.
///
/// Throws Error(format) with both counts if the size fits neither, or for a value that is NaN or -infinity.
std::vector<VertexField> field_from_source_order(const Model& model, std::span<const float> values);

/// One field per mesh from a vertex attribute: "_NAME" of a custom layer (the underscore may be left
/// out), or "COLOR_n", of which the mean of red, green and blue counts. The mean over a vertex's
/// values where it has several. Vertices and meshes without the attribute get 1.
///
/// Throws Error(unsupported) with the names that there are if no mesh has the attribute.
std::vector<VertexField> field_from_attribute(const Model& model, const std::string& name);

}  // namespace fovea
