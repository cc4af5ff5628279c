#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "fovea/base/context.h"
#include "fovea/io/write.h"
#include "fovea/model/weld.h"

// Private to io: vertex attributes on their way into a glTF file, and the rules of the format for them.

namespace fovea::gltf {

/// A position p is stored as the integers (p - offset) / step.
struct Grid {
  Vec3d offset;
  double step = 1;
};

/// One vertex attribute under its glTF name.
struct Column {
  std::string name;  ///< "POSITION", "TEXCOORD_0", "_CUSTOM", ...
  int width = 0;
  Storage storage;
  int bits = 0;               ///< Bits that are used of a normalised integer; 0 for all.
  std::vector<float> values;  ///< [#vertices × width]

  std::size_t size() const { return width > 0 ? values.size() / static_cast<std::size_t>(width) : 0; }
};

/// Triangles with columns: the vertices' own and what each morph target adds.
struct ColumnPart {
  std::vector<std::uint32_t> indices;
  std::vector<Column> columns;               ///< "POSITION" first.
  std::vector<std::vector<Column>> targets;  ///< [#targets], the same names in each.

  std::size_t vertex_count() const { return columns.empty() ? 0 : columns.front().size(); }
};

/// glTF's name of an attribute. Custom names get the underscore that the format asks for.
std::string attribute_name(const VertexArray& array);

/// Whether glTF 2.0 allows to store the attribute like that without KHR_mesh_quantization.
bool is_core_format(std::string_view name, Storage storage, bool morph_target);
/// ... with it.
bool is_quantized_format(std::string_view name, Storage storage, bool morph_target);

/// Columns of a part under their names; targets filled up so that all have the same attributes.
ColumnPart to_columns(SplitPart part);

/// Reorders triangles for the vertex cache and vertices for fetching.
void optimize_order(ColumnPart& part);

/// Settles how every column is stored: as read, smaller if `options` say so, or as floats where the format
/// does not allow it or the values do not fit. With a grid, positions turn into its integers. Drops
/// attributes that glTF cannot hold, which `context` is told.
void choose_storage(ColumnPart& part, const WriteOptions& options, const Grid* grid, Context& context,
                    const std::string& place);

/// Makes values keep the rules: finite numbers, unit normals and tangents, tangent w of ±1, colours in
/// [0, 1], weights that sum to 1 as stored with no joint twice and joint 0 where the weight is 0. Values that
/// keep them within what a validator tolerates stay as they are. Call it after `choose_storage`.
void clean_values(ColumnPart& part, Context& context, const std::string& place);

}  // namespace fovea::gltf
