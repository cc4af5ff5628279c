#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "fovea/model/tri_mesh.h"
#include "fovea/simplify/record.h"

// Private to lod.

namespace fovea {

/// What the steps of a file of levels refine: a mesh that grows from its coarsest level on. A step, read from
/// coarse to fine, splits a vertex, `kept`, in two and puts triangles between them, or brings a component
/// back. Elements have the numbers in which they come.
class GrowingMesh {
 public:
  TriMesh surface;
  /// Which morph targets change a layer. [#layers][#targets], or none for a layer.
  std::vector<std::vector<bool>> morphed;

  /// Corners at a vertex, ascending.
  std::span<const std::uint32_t> fan(VertexId v) const { return fans_[v.index()]; }

  VertexId add_vertex();
  ValueId add_value(std::size_t layer);
  /// A triangle of vertices and, one layer after the other, values of its corners.
  FaceId add_face(std::array<VertexId, 3> corners, std::uint32_t part, std::span<const ValueId> values);
  /// Gives those corners of a fan to another vertex for which `side` [#fan] is not 0.
  void split_fan(VertexId from, VertexId to, std::span<const std::uint8_t> side);

  /// Vertices around one, each once, in the order of the fan: those for which `seen` is not `stamp`, which it
  /// becomes.
  void neighbors(VertexId v, std::uint32_t stamp, std::vector<std::uint32_t>& seen,
                 std::vector<VertexId>& out) const;
  /// Values that a layer has at a vertex, each once, in the order of the fan.
  void values_at(VertexId v, std::size_t layer, std::vector<ValueId>& out) const;
  /// A corner at v of a triangle in which w comes so many corners, 1 or 2, after it; kInvalid if there is
  /// none.
  std::uint32_t corner_beside(VertexId v, VertexId w, std::uint32_t after) const;

 private:
  std::vector<std::vector<std::uint32_t>> fans_;  // [#V]
};

}  // namespace fovea
