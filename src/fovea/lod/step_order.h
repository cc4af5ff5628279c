#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "fovea/lod/multi_tessellation.h"
#include "fovea/model/model.h"

// Private to lod.

namespace fovea {

/// Goes through the steps of a record once and writes down what each needs and makes: `first_vertex`,
/// `triangles`, `needs` and `corners` of a MultiTessellation. Keeps the triangles as the steps have left
/// them, those of all meshes numbered through.
class StepOrder {
 public:
  /// Both must outlive this. Throws Error(usage) if the record is of another model, Error(limit).
  StepOrder(const Model& original, MultiTessellation& levels);

  /// Looks at step s, the next one. Throws Error(usage) if it cannot be one of this model.
  void begin(std::size_t s);
  /// And takes it.
  void finish();

  /// The triangles around the step in hand: from `begin` on those that it replaces, of which from `finish` on
  /// the second are left.
  std::span<const std::uint32_t> old_faces() const { return old_faces_; }
  std::span<const std::uint32_t> new_faces() const { return new_faces_; }
  /// What the step in hand keeps; kInvalid if it keeps nothing.
  std::uint32_t kept() const { return kept_; }

  const std::vector<std::array<std::uint32_t, 3>>& faces() const { return faces_; }
  Vec3d position(std::uint32_t v) const { return Vec3d(positions_[v]); }  ///< In the space of its mesh.
  std::size_t vertex_count() const { return positions_.size(); }
  std::uint32_t first_face(std::size_t mesh) const { return first_face_[mesh]; }
  /// A face that has the vertex at first; kInvalid if none does.
  std::uint32_t face_at(std::uint32_t v) const {
    return first_corner_[v] == kInvalid ? kInvalid : first_corner_[v] / 3;
  }

 private:
  void number_elements();
  void link_corners();
  void find_homes();
  bool changes_kept(std::uint32_t b);
  std::uint32_t vertex_now(std::uint32_t v);
  void add_old_faces(std::uint32_t v);
  void add_old_face(std::uint32_t f);
  void merge(const CollapseStep& step, std::uint32_t a, std::uint32_t b);
  void note_needs();
  void note_corners();
  void note_stripped();
  /// The runs of the step in hand begin where those of this one end.
  CollapseStep before() const { return step_ > 0 ? levels_.record.steps[step_ - 1] : CollapseStep(); }

  /// Calls f(corner) for each corner at v of a face that is left, and forgets the others.
  template <class F>
  void for_corners(std::uint32_t v, F&& f);

  const Model& original_;
  MultiTessellation& levels_;
  std::vector<std::uint32_t> first_face_;  // [#meshes + 1]

  // Of all meshes, as the steps have left them:
  std::vector<Vec3f> positions_;                                         // [#V]
  std::vector<std::array<std::uint32_t, 3>> faces_;                      // [#F]
  std::vector<char> alive_;                                              // [#F]
  std::vector<std::uint32_t> first_corner_, last_corner_, next_corner_;  // [#V], [#V], [#F × 3]
  std::vector<std::uint32_t> merged_into_;                               // [#V], itself if it is left
  std::vector<std::vector<std::vector<std::uint32_t>>>
      home_;                                             // [#meshes][#layers][#values], its original vertex
  std::vector<std::uint32_t> made_by_;                   // [#F], the step that made the face as it is
  std::vector<std::vector<std::uint32_t>> stripped_by_;  // [#V], steps that removed faces there unseen

  // Of the step in hand:
  std::size_t step_ = 0;
  std::uint32_t kept_ = kInvalid;
  std::vector<std::uint32_t> old_faces_, new_faces_, needs_;
  std::vector<std::uint32_t> face_mark_, vertex_mark_;
  std::uint32_t mark_ = 0;
};

}  // namespace fovea
