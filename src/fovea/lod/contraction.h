#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "fovea/lod/vertex_hierarchy.h"

namespace fovea {

/// A set of steps, a bit each: step s is bit s % 32 of word s / 32. At least one bit more than there are
/// steps, 0.
class StepBits {
 public:
  explicit StepBits(std::size_t step_count = 0) : words_(step_count / 32 + 1, 0) {}
  bool has(std::uint32_t s) const { return (words_[s / 32] >> s % 32 & 1u) != 0; }
  void set(std::size_t s, bool value) {
    const std::uint32_t bit = 1u << s % 32;
    words_[s / 32] = value ? words_[s / 32] | bit : words_[s / 32] & ~bit;
  }
  std::span<const std::uint32_t> words() const { return words_; }
  friend bool operator==(const StepBits&, const StepBits&) = default;

 private:
  std::vector<std::uint32_t> words_;
};

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

/// Contracts triangles of an original to those of a level.
///
/// Each triangle is there until the step that removes it is taken; each corner goes to the first vertex of
/// its chain that no taken step replaces. Targets are found once for all nodes, from the coarsest down, so
/// that no chain is followed twice. Triangles keep their order.
class Contraction {
 public:
  /// `hierarchy` must outlive this.
  explicit Contraction(const VertexHierarchy& hierarchy);

  /// Begins a level; `taken` must stay as it is until `advance` has said that it is done.
  void begin(const StepBits& taken, LevelIndices& out);
  /// Does so much of it, in nodes and triangles looked at; whether it is done. No allocation.
  bool advance(std::size_t work);
  std::size_t total_work() const { return hierarchy_.node_count() + hierarchy_.face_count(); }

 private:
  void find_targets(std::size_t begin, std::size_t end);
  void write_faces(std::size_t begin, std::size_t end);

  const VertexHierarchy& hierarchy_;
  std::vector<std::uint32_t> target_;  // [#nodes], vertices
  const StepBits* taken_ = nullptr;
  LevelIndices* out_ = nullptr;
  std::size_t done_ = 0, part_ = 0;
};

}  // namespace fovea
