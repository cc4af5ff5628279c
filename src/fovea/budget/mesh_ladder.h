#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "fovea/base/context.h"
#include "fovea/io/file_form.h"
#include "fovea/model/model.h"
#include "fovea/render/view.h"
#include "fovea/simplify/record.h"

namespace fovea {

struct MeshLadderOptions {
  std::optional<std::int64_t> triangles;    ///< At most, over all meshes.
  bool whole = false;                       ///< They keep all of their triangles.
  bool separate = false;                    ///< A ladder for each mesh, instead of one for all.
  double fewer = 0.7;                       ///< Triangles of a rung, of those of the one before.
  std::optional<ViewOptions> cameras = {};  ///< ViewSet::cameras, if only these look at it.
};

/// A level of the meshes of one ladder.
struct MeshRung {
  std::size_t steps = 0;  ///< Of those of the record that are this ladder's.
  std::uint64_t triangles = 0;
  std::uint64_t bytes = 0;  ///< As the file will hold them.
};

/// The meshes of a model in fewer and fewer triangles: each rung has a part of those of the one before, down
/// to half a percent. They are simplified once, pictures deciding about the last 12,000 triangles
/// (Metric::image), or about all of them if only cameras look, and each rung is encoded to know its bytes.
class MeshLadders {
 public:
  /// `model` must outlive this. Cost: one `simplify` and an encoding per rung. Throws as `simplify`.
  MeshLadders(const Model& model, const MeshLadderOptions& options, const FileForm& form, Context& context);

  /// [#ladders] From the most triangles down; ladders of one rung cannot give any. None without triangles.
  const std::vector<std::vector<MeshRung>>& rungs() const { return rungs_; }
  /// What the file takes beside the rungs' bytes and its images.
  std::uint64_t rest_bytes() const { return rest_bytes_; }

  /// Triangles of all meshes after so many steps of each ladder [#ladders].
  std::uint64_t triangles(std::span<const std::size_t> steps) const;
  /// The model after so many steps of each ladder [#ladders]. O(#F).
  Model level(std::span<const std::size_t> steps) const;

  /// What a ladder takes after so many steps: between rungs estimated, as if each triangle took the same.
  double bytes(std::size_t ladder, std::size_t steps) const;
  /// The fewest steps after which a ladder takes no more than so many bytes, by the same estimate; those of
  /// its last rung if none do, and not fewer than those of the first.
  std::size_t steps_within(std::size_t ladder, double bytes) const;
  /// After the first so many steps of the whole record, [#ladders] of its own.
  std::vector<std::size_t> first_steps(std::size_t count) const;
  std::size_t step_count() const { return record_.steps.size(); }

 private:
  void measure(const FileForm& form, Context& context);
  std::uint64_t triangles_after(std::size_t ladder, std::size_t steps) const {
    return whole_[ladder] - removed_[ladder][steps];
  }

  const Model& model_;
  CollapseRecord record_;
  std::vector<std::vector<std::size_t>> own_;  // [#ladders] steps of the record, in order
  std::vector<std::vector<std::uint64_t>>
      removed_;  // [#ladders][#own + 1] triangles that the first of them remove
  std::vector<std::vector<MeshRung>> rungs_;
  std::vector<std::uint64_t> whole_;  // [#ladders] triangles before
  std::uint64_t rest_bytes_ = 0;
};

}  // namespace fovea
