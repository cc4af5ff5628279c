#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "fovea/base/math.h"
#include "fovea/model/tri_mesh.h"

namespace fovea {

/// What one step did to a mesh.
enum class StepKind : std::uint8_t {
  collapse,  ///< An edge became a vertex.
  vanish,    ///< A whole component went.
};

/// One step of a simplification. Ids are those of the mesh that was simplified.
struct CollapseStep {
  StepKind kind = StepKind::collapse;
  bool moved = false;      ///< collapse: whether `kept` has a new position.
  std::uint32_t mesh = 0;  ///< Index into the meshes that were simplified together.
  VertexId removed, kept;  ///< collapse: `removed` became `kept`; vanish: none.
  Vec3f position;          ///< Where `kept` is from now on, if it moved.
  float error_rel = 0;     ///< Largest error of all steps so far, of the scene's diagonal.
  // Ends of this step's runs in the record's lists; they begin where the step before it ends. Numbers have
  // no end of their own: every write says how many it has.
  std::uint32_t faces_end = 0, joins_end = 0, writes_end = 0;
};

/// Two values of a layer became one: corners with `removed` have `kept` from now on.
struct ValueJoin {
  std::uint32_t layer = 0;
  ValueId removed, kept;
};

/// A value of a layer was set to new numbers: the layer's width times one plus its morphs, in the
/// record's float list. With layer kInvalid the position morphs of a vertex: 3 × targets.
struct ValueWrite {
  std::uint32_t layer = 0;
  std::uint32_t value = 0;  ///< ValueId, or VertexId for position morphs.
};

/// Sets the numbers of a write, which begin at `numbers`, and returns where those of the next do.
const float* write_numbers(TriMesh& mesh, const ValueWrite& write, const float* numbers);

/// The canonical output of simplification: every step in order, with all that is needed to replay it
/// on the mesh that it started from. Any level of detail is a replay of the first n steps.
struct CollapseRecord {
  std::vector<CollapseStep> steps;
  std::vector<FaceId> removed_faces;
  std::vector<ValueJoin> joins;
  std::vector<ValueWrite> writes;
  std::vector<float> floats;           ///< New numbers of `writes`, in order.
  std::uint64_t triangles_before = 0;  ///< Over all meshes.

  /// Triangles left over all meshes after the first n steps.
  std::uint64_t triangles_after(std::size_t n) const {
    return triangles_before - (n > 0 ? steps[n - 1].faces_end : 0);
  }
  /// The fewest steps that leave at most so many triangles; all if no number does. O(log #steps).
  std::size_t steps_to(std::uint64_t triangles) const;
};

/// The meshes after the first `step_count` steps. `sources` are the meshes that were simplified, in
/// the same order. The results keep layers, parts and morph targets; vertices and values that nothing
/// uses any more are dropped; `source_vertex` follows the collapses. O(#steps + #F · #layers).
std::vector<TriMesh> replay(std::span<const TriMesh* const> sources, const CollapseRecord& record,
                            std::size_t step_count);

/// The same after the steps for which `taken` [#steps] is not 0. They must be able to do without the others,
/// see lod/multi_tessellation.h.
std::vector<TriMesh> replay(std::span<const TriMesh* const> sources, const CollapseRecord& record,
                            std::span<const std::uint8_t> taken);

}  // namespace fovea
