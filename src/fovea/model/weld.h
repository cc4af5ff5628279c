#pragma once

#include <span>
#include <vector>

#include "fovea/base/context.h"
#include "fovea/model/tri_mesh.h"

namespace fovea {

/// One vertex attribute as files store it: one value per split vertex.
struct VertexArray {
  Semantic semantic = Semantic::custom;
  int set = 0;
  std::string name;  ///< For `custom`.
  int width = 0;
  Storage storage;
  std::vector<float> values;  ///< [#vertices × width], decoded.
};

/// A run of triangles as files and GPUs hold it: every vertex has one value of every attribute.
struct SplitPart {
  Part part;
  std::vector<Vec3f> positions;  ///< [#vertices]
  Storage position_storage;
  std::vector<std::uint32_t> indices;  ///< [#triangles × 3]
  std::vector<VertexArray> attributes;
  std::vector<std::vector<Vec3f>> position_morphs;  ///< [#targets][#vertices]; empty if absent.
  /// [#targets]: what each target adds to which attributes (semantic, set, values).
  std::vector<std::vector<VertexArray>> attribute_morphs;
};

/// Makes one mesh of the parts of a mesh: welds vertices with bit-equal positions (and position
/// morphs) over all parts, builds one layer per attribute with one value per vertex and distinct
/// bits, and drops triangles that use a vertex twice after welding, which `context` is told
/// ("degenerate-triangles", with `place`). No other triangle is dropped: those given twice, either way
/// round or in two parts, can be seen. Joints and weights of all sets share their corner map, so that an
/// influence list is never mixed. -0 and +0 weld. Parts with `part.raw` set contribute no
/// triangles but keep their place.
///
/// Throws Error(format) for an index out of range or a position that is not finite, Error(limit) if
/// corners do not fit 32 bits. O(#corners · #layers).
TriMesh weld(std::span<const SplitPart> parts, Context& context, const std::string& place = {});

/// The way back: for every part of the mesh its triangles with split vertices, ready to write.
/// Vertices are numbered in order of first use by the part's triangles; a part without triangles
/// gives an empty one. O(#corners · #layers).
std::vector<SplitPart> split(const TriMesh& mesh);

/// Number of split vertices that `split` would make, without making them.
std::size_t split_vertex_count(const TriMesh& mesh);

}  // namespace fovea
