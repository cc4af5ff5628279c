#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "fovea/lod/levels_file.h"
#include "fovea/lod/live_level.h"
#include "fovea/lod/split_code.h"

// Private to lod.

namespace fovea {

/// What SplitCode writes: undoes the steps of a record one by one, from the coarsest level on, and says what
/// has come back. Elements have two numbers, the original's and, once they are named, those of the file.
class SplitSource : public StreamWriter {
 public:
  SplitSource(const LeveledModel& leveled, GrowingModel& model);

  /// The triangles of a mesh that all steps leave, as a step.
  Split base(std::uint32_t mesh);
  /// Whether a step is taken; those that empty a mesh never are.
  bool is_taken(std::size_t s) const { return live_.cut()[s] != 0; }
  /// Undoes a step. The last that is taken has to come first.
  Split undo(std::size_t s);

  // For SplitCode, about the step in hand; in numbers of the file.
  void name_kept(VertexId v) { name(step_->kept, v); }
  void name_removed(VertexId v) { name(step_->removed, v); }
  bool is_at_removed(std::uint32_t corner) const;
  /// Which of the values that a value becomes a corner gets: 0 for itself.
  std::uint32_t digit(std::uint32_t layer, ValueId group, std::uint32_t corner);
  std::uint32_t digit_count() const { return static_cast<std::uint32_t>(digits_.size()); }
  void name_digit(std::uint32_t layer, std::uint32_t digit, ValueId id);
  bool is_rewritten(std::uint32_t layer, ValueId id) const;
  /// Corners of the next triangle, from `kept` on, or else `removed`; none for those without a name.
  std::array<VertexId, 3> face(std::uint32_t j, VertexId kept, VertexId removed);
  void name_vertex(VertexId v);
  void next_corner() { ++corner_; }
  std::uint32_t part() const;
  ValueId value(std::uint32_t layer, std::size_t k, bool& is_new) const;
  void name_value(std::uint32_t layer, std::size_t k, ValueId id);
  void name_face(FaceId f);
  Vec3f fine_position(VertexId v) const;
  Vec3f fine_morph(std::size_t target, VertexId v) const;
  float fine_number(std::uint32_t layer, ValueId id, int target, std::size_t i) const;

 private:
  /// The numbers of elements in the file, by those of the original, and the other way round.
  struct Names {
    std::vector<VertexId> vertex, old_vertex;
    std::vector<std::vector<ValueId>> value, old_value;  // [#layers]
    std::vector<std::uint32_t> old_corner;               // [#F], the corner that is the first now
  };
  void begin_step(std::uint32_t mesh);
  void name(VertexId old, VertexId v);
  /// The corner of the original that a corner of the triangle in hand is.
  std::size_t old_corner(std::size_t k) const { return 3 * face_.index() + (turn_ + k) % 3; }
  std::size_t old_corner_of(std::uint32_t corner) const;
  const TriMesh& fine() const { return live_.mesh(old_mesh_[mesh_]); }
  Names& names() { return names_[mesh_]; }
  const Names& names() const { return names_[mesh_]; }

  const LeveledModel& leveled_;
  GrowingModel& model_;
  LiveLevel live_;
  std::vector<std::uint32_t> old_mesh_;   // [#meshes of the file]
  std::vector<std::uint32_t> mesh_name_;  // [#meshes of the original]
  std::vector<Names> names_;              // [#meshes of the file]

  // The step in hand:
  const CollapseStep* step_ = nullptr;
  std::uint32_t mesh_ = 0;
  std::vector<FaceId> faces_;
  FaceId face_;
  std::size_t turn_ = 0, corner_ = 0;
  std::uint32_t layer_ = kInvalid;
  ValueId group_;
  std::vector<ValueId> digits_;  // original numbers
};

}  // namespace fovea
