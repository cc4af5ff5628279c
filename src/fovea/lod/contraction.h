#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "fovea/lod/step_bits.h"
#include "fovea/lod/vertex_hierarchy.h"

namespace fovea {

/// The triangles of a level as indices into the vertices of their mesh.
struct LevelIndices {
  /// [#F × 3]; those of part p of the hierarchy begin at 3 × its `first_face`, the rest of its room is
  /// undefined.
  std::vector<std::uint32_t> indices;
  std::vector<std::uint32_t> triangles;  ///< [#parts]

  std::span<const std::uint32_t> of_part(const VertexHierarchy& hierarchy, std::size_t p) const {
    return {indices.data() + 3 * std::size_t{hierarchy.parts[p].first_face}, 3 * std::size_t{triangles[p]}};
  }
  std::uint64_t triangle_count() const;
};

/// Makes a level's triangles from those of the original: a little at a time, if that is wanted.
class LevelContraction {
 public:
  virtual ~LevelContraction() = default;
  /// Begins a level; `taken` must stay as it is until `advance` has said that it is done.
  virtual void begin(const StepBits& taken) = 0;
  /// Does so much of the work that there is; whether all is done. Allocates nothing.
  virtual bool advance(std::size_t work) = 0;
  virtual std::size_t total_work() const = 0;
};

/// On the processor.
///
/// Each triangle is there until the step that removes it is taken; each corner goes to the first vertex of
/// its chain that no taken step replaces. Targets are found once for all nodes, from the coarsest down, so
/// that no chain is followed twice. Triangles keep their order. One thread: some 5 ns per node and triangle
/// that is looked at, and as much for each corner that is left.
class Contraction : public LevelContraction {
 public:
  /// `hierarchy` must outlive this.
  explicit Contraction(const VertexHierarchy& hierarchy);

  void begin(const StepBits& taken) override;
  bool advance(std::size_t work) override;
  std::size_t total_work() const override { return hierarchy_.node_count() + hierarchy_.face_count(); }

  /// The last level that was done; nothing before the first. Stays until the next is done.
  const LevelIndices& level() const { return levels_[shown_]; }

 private:
  void find_targets(std::size_t begin, std::size_t end);
  void write_faces(std::size_t begin, std::size_t end);

  const VertexHierarchy& hierarchy_;
  std::vector<std::uint32_t> target_;  // [#nodes], vertices
  std::array<LevelIndices, 2> levels_;
  std::size_t shown_ = 0;
  // Of the level in hand:
  const StepBits* taken_ = nullptr;
  std::size_t done_ = 0, part_ = 0;
};

}  // namespace fovea
