#pragma once

#include <cstdint>
#include <memory>

#include "fovea/lod/step_bits.h"
#include "fovea/lod/vertex_hierarchy.h"

namespace fovea {

/// Looks for cracks in levels: edges between places, whatever values meet there, on which a single triangle
/// ends though no border edge of the original has become that edge. A border edge is one on which an odd
/// number of triangles end. What touches at rest and parts in a morph target are two places.
class CrackFinder {
 public:
  /// `hierarchy` must outlive this. O(#F log #F).
  explicit CrackFinder(const VertexHierarchy& hierarchy);
  ~CrackFinder();

  /// Cracked edges of the level with these steps. O(#F log #F).
  std::size_t count(const StepBits& taken) const;

 private:
  struct Edges;
  const VertexHierarchy& hierarchy_;
  std::unique_ptr<const Edges> original_;
};

}  // namespace fovea
