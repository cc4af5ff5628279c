#pragma once

#include <span>

#include "fovea/simplify/collapse_state.h"
#include "support/meshes.h"

namespace fovea::test {

/// The engine's state of one mesh, lengths in the mesh's own units.
inline CollapseState state_of(const TriMesh& mesh, const SimplifyOptions& options = {}) {
  const TriMesh* const meshes[] = {&mesh};
  const double scales[] = {1};
  const VertexField* const importance[] = {nullptr};
  Context context;
  context.threads = 1;
  return make_collapse_state(meshes, scales, importance, {}, 1.0, options, context);
}

/// The vertex at a position of the mesh; the state's positions are around its centre.
inline std::uint32_t vertex_at(const CollapseState& state, Vec3f local) {
  const Vec3d p = state.slots[0].to_engine(local);
  for (std::uint32_t v = 0; v < state.mesh.vertices.size(); ++v) {
    if (length(state.mesh.position(v) - p) < 1e-6) return v;
  }
  return kInvalid;
}

/// The edge a–b; kInvalid if there is none.
inline std::uint32_t edge_between(const CollapseState& state, std::uint32_t a, std::uint32_t b) {
  for (const std::uint32_t c : state.mesh.ring(a)) {
    const CornerView at_c = state.mesh.view(c);
    if (at_c.next == b) return at_c.to_next;
    if (at_c.previous == b) return at_c.to_previous;
  }
  return kInvalid;
}

}  // namespace fovea::test
