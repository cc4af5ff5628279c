#pragma once

#include <cstdint>
#include <vector>

#include "fovea/lod/cut.h"
#include "fovea/lod/multi_tessellation.h"
#include "fovea/model/model.h"

namespace fovea {

/// A level that goes from cut to cut: for programs that ask again and again, as the eye or the camera moves.
/// Takes or undoes only the steps in which two cuts differ.
class LiveLevel {
 public:
  /// Begins with the original. Both must outlive this. O(#F · #layers); copies the meshes, and takes about
  /// 100 bytes more for each step.
  LiveLevel(const Model& original, const MultiTessellation& levels);

  /// The cut must be closed, as all are that lod/cut.h makes. O(#steps), and the one-rings of what differs.
  void go_to(const Cut& cut);
  /// Takes step s, if it is not taken and all is that it needs, or undoes it, if it is and nothing is that
  /// needs it: one step of the way to another cut. O(1) for usual meshes.
  void set(std::size_t s, bool taken);
  const Cut& cut() const { return cut_; }
  std::uint64_t triangle_count() const { return triangle_count_; }

  /// A mesh of the level: corners, positions and values of the triangles that are there; the others, and what
  /// only they use, mean nothing. Triangles, vertices and values keep the numbers of the original, so that
  /// buffers of a graphics card can be changed in place.
  const TriMesh& mesh(std::size_t m) const { return meshes_[m]; }
  bool is_there(std::size_t m, FaceId f) const { return there_[m][f.index()] != 0; }

 private:
  /// A corner of a mesh that a step gives another value of a layer, or with kInvalid another vertex.
  struct CornerChange {
    std::uint32_t layer, corner, before, after;
  };
  class Recorder;
  void change(std::size_t s, bool taken);
  void set_numbers(std::size_t s, const std::vector<float>& numbers);

  const MultiTessellation& levels_;
  std::vector<TriMesh> meshes_;
  std::vector<std::vector<std::uint8_t>> there_;  // [#meshes][#F]
  Cut cut_;
  std::uint64_t triangle_count_ = 0;
  // Of each step:
  std::vector<CornerChange> changes_;
  std::vector<std::uint32_t> changes_end_;    // [#steps]
  std::vector<Vec3f> position_before_;        // [#steps], of what it keeps
  std::vector<std::uint64_t> numbers_begin_;  // [#steps], in the record's floats and in these:
  std::vector<float> numbers_before_;
};

}  // namespace fovea
