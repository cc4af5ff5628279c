#include "fovea/lod/live_level.h"

#include <algorithm>
#include <utility>

#include "fovea/base/error.h"

namespace fovea {

/// Takes all steps in turn and writes down what each changes.
class LiveLevel::Recorder {
 public:
  explicit Recorder(LiveLevel& level) : level_(level), record_(level.levels_.record) {
    for (const TriMesh& mesh : level.meshes_) {
      std::vector<std::vector<std::uint32_t>>& corners = corners_.emplace_back(mesh.vertex_count());
      for (std::uint32_t f = 0; f < mesh.face_count(); ++f) {
        for (std::uint32_t k = 0; k < 3; ++k) corners[mesh.triangles[f][k].index()].push_back(3 * f + k);
      }
    }
  }

  void run() {
    for (std::size_t s = 0; s < record_.steps.size(); ++s) {
      note(s);
      level_.change(s, true);
    }
  }

 private:
  void note(std::size_t s) {
    const CollapseStep& step = record_.steps[s];
    const TriMesh& mesh = level_.meshes_[step.mesh];
    level_.numbers_begin_.push_back(level_.numbers_before_.size());
    level_.position_before_.push_back(step.kind == StepKind::collapse ? mesh.positions[step.kept.index()]
                                                                      : Vec3f());
    if (step.kind == StepKind::collapse) note_corners(s);
    level_.changes_end_.push_back(static_cast<std::uint32_t>(level_.changes_.size()));
    for (std::size_t i = s > 0 ? record_.steps[s - 1].writes_end : 0; i < step.writes_end; ++i)
      note_numbers(mesh, record_.writes[i]);
  }

  void note_corners(std::size_t s) {
    const CollapseStep& step = record_.steps[s];
    auto& of_mesh = corners_[step.mesh];
    std::vector<std::uint32_t>& at_removed = of_mesh[step.removed.index()];
    std::vector<std::uint32_t>& at_kept = of_mesh[step.kept.index()];
    const auto is_gone = [&](std::uint32_t c) { return level_.there_[step.mesh][c / 3] == 0; };
    std::erase_if(at_removed, is_gone);
    std::erase_if(at_kept, is_gone);
    for (const std::uint32_t c : at_removed)
      level_.changes_.push_back({kInvalid, c, step.removed.value, step.kept.value});
    at_kept.insert(at_kept.end(), at_removed.begin(), at_removed.end());
    at_removed = {};
    const TriMesh& mesh = level_.meshes_[step.mesh];
    for (std::size_t i = s > 0 ? record_.steps[s - 1].joins_end : 0; i < step.joins_end; ++i) {
      const ValueJoin& join = record_.joins[i];
      for (const std::uint32_t c : at_kept) {
        if (mesh.layers[join.layer].corner_value[c] == join.removed)
          level_.changes_.push_back({join.layer, c, join.removed.value, join.kept.value});
      }
    }
  }

  void note_numbers(const TriMesh& mesh, const ValueWrite& write) {
    std::vector<float>& numbers = level_.numbers_before_;
    if (write.layer == kInvalid) {
      for (const auto& morph : mesh.position_morphs) {
        const Vec3f& p = morph[write.value];
        numbers.insert(numbers.end(), {p.x, p.y, p.z});
      }
      return;
    }
    const AttributeLayer& layer = mesh.layers[write.layer];
    const auto width = static_cast<std::size_t>(layer.width);
    const auto add = [&](const std::vector<float>& values) {
      if (values.empty()) return void(numbers.insert(numbers.end(), width, 0.0f));
      const float* const from = values.data() + write.value * width;
      numbers.insert(numbers.end(), from, from + width);
    };
    add(layer.values);
    for (const auto& morph : layer.morphs) add(morph);
  }

  LiveLevel& level_;
  const CollapseRecord& record_;
  std::vector<std::vector<std::vector<std::uint32_t>>> corners_;  // [#meshes][#V], corners at each, some gone
};

LiveLevel::LiveLevel(const Model& original, const MultiTessellation& levels)
    : levels_(levels), cut_(levels.step_count(), 1) {
  for (const Mesh& mesh : original.meshes) {
    meshes_.push_back(mesh.surface);
    there_.emplace_back(mesh.surface.face_count(), 1);
    triangle_count_ += mesh.surface.face_count();
  }
  if (triangle_count_ != levels.triangles || meshes_.size() + 1 != levels.first_vertex.size())
    throw Error(ErrorKind::usage, "the levels are of another model", "levels");
  Recorder(*this).run();
  go_to(Cut(levels.step_count(), 0));
}

void LiveLevel::go_to(const Cut& cut) {
  if (cut.size() != cut_.size()) throw Error(ErrorKind::usage, "the cut is of other levels", "cut");
  for (std::size_t s = cut.size(); s-- > 0;) {
    if (cut_[s] != 0 && cut[s] == 0) change(s, false);
  }
  for (std::size_t s = 0; s < cut.size(); ++s) {
    if (cut_[s] == 0 && cut[s] != 0) change(s, true);
  }
  cut_ = cut;
}

void LiveLevel::set(std::size_t s, bool taken) {
  if ((cut_[s] != 0) == taken) return;
  change(s, taken);
  cut_[s] = taken;
}

/// Takes a step, or undoes it.
void LiveLevel::change(std::size_t s, bool taken) {
  const CollapseRecord& record = levels_.record;
  const CollapseStep& step = record.steps[s];
  TriMesh& mesh = meshes_[step.mesh];
  for (std::size_t i = s > 0 ? changes_end_[s - 1] : 0; i < changes_end_[s]; ++i) {
    const CornerChange& change = changes_[i];
    const std::uint32_t now = taken ? change.after : change.before;
    if (change.layer == kInvalid) {
      mesh.triangles[change.corner / 3][change.corner % 3] = VertexId{now};
    } else {
      mesh.layers[change.layer].corner_value[change.corner] = ValueId{now};
    }
  }
  const std::size_t first_face = s > 0 ? record.steps[s - 1].faces_end : 0;
  for (std::size_t i = first_face; i < step.faces_end; ++i)
    there_[step.mesh][record.removed_faces[i].index()] = !taken;
  const std::uint64_t faces = step.faces_end - first_face;
  triangle_count_ = taken ? triangle_count_ - faces : triangle_count_ + faces;
  if (step.moved) mesh.positions[step.kept.index()] = taken ? step.position : position_before_[s];
  set_numbers(s, taken ? record.floats : numbers_before_);
}

void LiveLevel::set_numbers(std::size_t s, const std::vector<float>& numbers) {
  const CollapseRecord& record = levels_.record;
  const CollapseStep& step = record.steps[s];
  TriMesh& mesh = meshes_[step.mesh];
  const float* from = numbers.data() + numbers_begin_[s];
  for (std::size_t i = s > 0 ? record.steps[s - 1].writes_end : 0; i < step.writes_end; ++i)
    from = write_numbers(mesh, record.writes[i], from);
}

}  // namespace fovea
