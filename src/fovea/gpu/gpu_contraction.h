#pragma once

#include <cstddef>
#include <memory>

#include "fovea/lod/contraction.h"
#include "fovea/lod/vertex_hierarchy.h"

namespace fovea {

/// Contracts triangles on the graphics card, by OpenGL 4.3 compute shaders: the same indices, bit by bit, as
/// `Contraction`, and they never leave the card (Munaretti 2007, section 6.2).
///
/// Chains of replaced vertices are shortened by half at a time, in parallel, until each node knows its
/// target; then triangles that are left are counted in blocks, blocks added up, and corners written in their
/// order. Any number of vertices; 28 bytes for each node and 40 for each triangle on the card.
class GpuContraction : public LevelContraction {
 public:
  /// In the context that is current, a program's own or a GpuContext; it must be current whenever this is
  /// used. Bindings of buffers and the program in use are left as they come. `hierarchy` must outlive this.
  /// Throws Error(unsupported) without a context of OpenGL 4.3.
  explicit GpuContraction(const VertexHierarchy& hierarchy);
  ~GpuContraction() override;

  void begin(const StepBits& taken) override;
  bool advance(std::size_t work) override;
  std::size_t total_work() const override;

  // Of the last level that was done:
  /// OpenGL's name of the buffer with its indices, 32 bits each, laid out as `LevelIndices`.
  unsigned index_buffer() const;
  /// Of the buffer with a command for glDrawElementsIndirect for each part of the hierarchy.
  unsigned draw_buffer() const;
  /// A copy from the card; waits for it.
  LevelIndices read_back() const;

 private:
  struct Card;
  const VertexHierarchy& hierarchy_;
  std::unique_ptr<Card> card_;
  std::size_t done_ = 0;
  std::size_t shown_ = 0;
};

}  // namespace fovea
