#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "fovea/base/math.h"
#include "fovea/model/accessor.h"
#include "fovea/model/ids.h"

namespace fovea {

/// What an attribute layer means. `custom` keeps its own name (glTF: "_TEMPERATURE").
enum class Semantic { uv, normal, tangent, color, joints, weights, custom };

/// One attribute of a mesh, laid over its triangles: a table of values and, per corner, which value
/// holds there. Two corners of a vertex that use different values make a *seam* of this layer and of
/// this layer only: a cut in the texture does not tear the normals.
///
/// Invariant: a value is used by corners of one vertex only; a texture coordinate also by triangles of
/// one orientation in the texture only, so that the line where a texture is mirrored is a seam.
struct AttributeLayer {
  Semantic semantic = Semantic::custom;
  int set = 0;                ///< n of TEXCOORD_n, COLOR_n, JOINTS_n, WEIGHTS_n; 0 otherwise.
  std::string name;           ///< Name in the file for `custom`, empty otherwise.
  int width = 0;              ///< Floats per value: uv 2, normal 3, tangent 4, colour 3 or 4, joints 4, ...
  Storage storage;            ///< How the file stored it, so that it can be stored like that again.
  std::vector<float> values;  ///< [#values × width]
  std::vector<ValueId> corner_value;  ///< [#F × 3]; none where the corner's part lacks the layer.
  /// Morph targets: what each adds to `values`, [#targets][#values × width]; an empty vector for a
  /// target that leaves the layer alone. Empty altogether if no target touches it.
  std::vector<std::vector<float>> morphs;

  std::size_t size() const { return width > 0 ? values.size() / static_cast<std::size_t>(width) : 0; }
  const float* value(ValueId id) const {
    return values.data() + id.index() * static_cast<std::size_t>(width);
  }
  float* value(ValueId id) { return values.data() + id.index() * static_cast<std::size_t>(width); }
};

/// A vertex attribute outside of a TriMesh: name as in the file ("POSITION") and its data.
struct NamedAccessor {
  std::string name;
  Accessor data;
};

/// Geometry that passes through untouched: points and lines.
struct RawPrimitive {
  int mode = 4;  ///< glTF's: 0 points, 1 lines, 2 line loop, 3 line strip.
  std::vector<NamedAccessor> attributes;
  std::optional<Accessor> indices;
  std::vector<std::vector<NamedAccessor>> targets;  ///< Morph targets.
};

/// A run of triangles with one material, as the file divides the mesh (glTF: a primitive).
struct Part {
  int material = -1;                ///< Index into the model's materials; -1 for the default one.
  std::string json;                 ///< glTF: the primitive object as read (extensions, extras).
  std::optional<RawPrimitive> raw;  ///< Set if the part is not made of triangles; then no face has it.
};

/// A triangle mesh with attribute layers, vertices welded by position.
///
/// Vertices are geometric points: corners with bit-equal positions (and equal morph targets) are one
/// vertex. Everything else lives in the layers. Triangles are counter-clockwise seen from outside and
/// never use a vertex twice.
struct TriMesh {
  std::vector<Vec3f> positions;                    ///< [#V]
  Storage position_storage;                        ///< How the file stored positions.
  std::vector<std::array<VertexId, 3>> triangles;  ///< [#F × 3]
  std::vector<std::uint32_t> face_part;            ///< [#F], index into `parts`.
  std::vector<Part> parts;                         ///< In file order.
  std::vector<AttributeLayer> layers;
  std::vector<std::vector<Vec3f>> position_morphs;  ///< [#targets][#V], what each target adds.
  /// Source vertex -> vertex, over all triangle parts in file order, each with its vertices in file
  /// order; none for source vertices that no triangle uses. Empty if the mesh has no source.
  std::vector<VertexId> source_vertex;

  std::size_t vertex_count() const { return positions.size(); }
  std::size_t face_count() const { return triangles.size(); }
  std::size_t target_count() const { return position_morphs.size(); }
  VertexId vertex(CornerId c) const { return triangles[c.index() / 3][c.index() % 3]; }
  /// The layer of that meaning and set, or null.
  const AttributeLayer* find(Semantic semantic, int set = 0) const;
  AttributeLayer* find(Semantic semantic, int set = 0);
};

/// Whether a layer of colours multiplies nothing: none is darker than white. O(#values).
bool is_white(const AttributeLayer& colors);

/// Bounding box of all vertices.
Box bounds(const TriMesh& mesh);

/// Throws Error(internal) with the first broken invariant: sizes, indices in range, no triangle with
/// a vertex twice, finite positions, one vertex per value. O(#F · #layers).
void check(const TriMesh& mesh);

}  // namespace fovea
