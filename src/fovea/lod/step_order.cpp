#include "fovea/lod/step_order.h"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>

#include "fovea/base/error.h"

namespace fovea {

namespace {

constexpr std::uint32_t kNever = kInvalid;

/// Throws if a step is not one of this model, or its runs do not go on from those before.
void check_step(const Model& original, const CollapseRecord& record, std::size_t s) {
  const CollapseStep& step = record.steps[s];
  const CollapseStep before = s > 0 ? record.steps[s - 1] : CollapseStep();
  bool good = step.mesh < original.meshes.size() && step.faces_end >= before.faces_end &&
              step.joins_end >= before.joins_end && step.writes_end >= before.writes_end &&
              step.faces_end <= record.removed_faces.size() && step.joins_end <= record.joins.size() &&
              step.writes_end <= record.writes.size();
  if (good) {
    const TriMesh& mesh = original.meshes[step.mesh].surface;
    const auto has_value = [&](std::uint32_t layer, std::uint32_t value) {
      return layer < mesh.layers.size() && value < mesh.layers[layer].size();
    };
    if (step.kind == StepKind::collapse) {
      good = step.removed.value < mesh.vertex_count() && step.kept.value < mesh.vertex_count() &&
             step.removed != step.kept;
    }
    for (std::size_t i = before.faces_end; i < step.faces_end; ++i)
      good = good && record.removed_faces[i].value < mesh.face_count();
    for (std::size_t i = before.joins_end; i < step.joins_end; ++i) {
      const ValueJoin& join = record.joins[i];
      good = good && has_value(join.layer, join.removed.value) && has_value(join.layer, join.kept.value);
    }
    for (std::size_t i = before.writes_end; i < step.writes_end; ++i) {
      const ValueWrite& write = record.writes[i];
      good = good && (write.layer == kInvalid ? write.value < mesh.vertex_count()
                                              : has_value(write.layer, write.value));
    }
  }
  if (!good) throw Error(ErrorKind::usage, "the record is of another model", fmt::format("step {}", s));
}

}  // namespace

StepOrder::StepOrder(const Model& original, MultiTessellation& levels)
    : original_(original), levels_(levels) {
  number_elements();
  const CollapseRecord& record = levels.record;
  if (record.triangles_before != levels.triangles)
    throw Error(ErrorKind::usage, "the record is of another model", "record",
                fmt::format("it begins with {} triangles, the model has {}", record.triangles_before,
                            levels.triangles));
  link_corners();
  find_homes();
  levels.needs_end.reserve(record.steps.size());
  levels.corners_end.reserve(record.steps.size());
}

template <class F>
void StepOrder::for_corners(std::uint32_t v, F&& f) {
  std::uint32_t* link = &first_corner_[v];
  last_corner_[v] = kInvalid;
  while (*link != kInvalid) {
    const std::uint32_t c = *link;
    if (!alive_[c / 3]) {
      *link = next_corner_[c];
      continue;
    }
    f(c);
    last_corner_[v] = c;
    link = &next_corner_[c];
  }
}

void StepOrder::number_elements() {
  levels_.first_vertex = {0};
  first_face_ = {0};
  std::uint64_t corners = 0;
  for (const Mesh& mesh : original_.meshes) {
    corners += 3 * mesh.surface.face_count();
    if (corners >= kInvalid)
      throw Error(ErrorKind::limit, "the model has too many triangles for a record of levels");
    levels_.first_vertex.push_back(levels_.first_vertex.back() +
                                   static_cast<std::uint32_t>(mesh.surface.vertex_count()));
    first_face_.push_back(first_face_.back() + static_cast<std::uint32_t>(mesh.surface.face_count()));
  }
  levels_.triangles = first_face_.back();
}

void StepOrder::link_corners() {
  const std::size_t vertices = levels_.first_vertex.back(), faces = first_face_.back();
  positions_.reserve(vertices);
  faces_.reserve(faces);
  for (std::size_t m = 0; m < original_.meshes.size(); ++m) {
    const TriMesh& mesh = original_.meshes[m].surface;
    positions_.insert(positions_.end(), mesh.positions.begin(), mesh.positions.end());
    for (const auto& t : mesh.triangles) {
      faces_.push_back({levels_.first_vertex[m] + t[0].value, levels_.first_vertex[m] + t[1].value,
                        levels_.first_vertex[m] + t[2].value});
    }
  }
  alive_.assign(faces, 1);
  first_corner_.assign(vertices, kInvalid);
  last_corner_.assign(vertices, kInvalid);
  next_corner_.assign(3 * faces, kInvalid);
  merged_into_.resize(vertices);
  std::iota(merged_into_.begin(), merged_into_.end(), 0u);
  made_by_.assign(faces, kNever);
  stripped_by_.resize(vertices);
  face_mark_.assign(faces, 0);
  vertex_mark_.assign(vertices, 0);
  for (std::uint32_t c = 0; c < 3 * faces; ++c) {
    const std::uint32_t v = faces_[c / 3][c % 3];
    if (first_corner_[v] == kInvalid) {
      first_corner_[v] = c;
    } else {
      next_corner_[last_corner_[v]] = c;
    }
    last_corner_[v] = c;
  }
}

/// Notes the vertex of each attribute value.
void StepOrder::find_homes() {
  for (std::size_t m = 0; m < original_.meshes.size(); ++m) {
    auto& homes = home_.emplace_back();
    for (const AttributeLayer& layer : original_.meshes[m].surface.layers) {
      auto& home = homes.emplace_back(layer.size(), kInvalid);
      for (std::size_t c = 0; c < layer.corner_value.size(); ++c) {
        const ValueId value = layer.corner_value[c];
        if (value.valid()) home[value.index()] = faces_[first_face_[m] + c / 3][c % 3];
      }
    }
  }
}

void StepOrder::begin(std::size_t s) {
  check_step(original_, levels_.record, s);
  step_ = s;
  const CollapseRecord& record = levels_.record;
  const CollapseStep& step = record.steps[s];
  const bool collapses = step.kind == StepKind::collapse;
  kept_ = collapses ? levels_.vertex(step.mesh, step.kept) : kInvalid;
  ++mark_;
  old_faces_.clear();
  if (collapses) {
    add_old_faces(levels_.vertex(step.mesh, step.removed));
    if (changes_kept(kept_)) add_old_faces(kept_);
  }
  for (std::size_t i = before().faces_end; i < step.faces_end; ++i)
    add_old_face(first_face_[step.mesh] + record.removed_faces[i].value);
  note_needs();
}

void StepOrder::finish() {
  const CollapseRecord& record = levels_.record;
  const CollapseStep& step = record.steps[step_];
  for (std::size_t i = before().faces_end; i < step.faces_end; ++i)
    alive_[first_face_[step.mesh] + record.removed_faces[i].value] = 0;
  if (step.kind == StepKind::collapse) merge(step, levels_.vertex(step.mesh, step.removed), kept_);
  new_faces_.clear();
  for (const std::uint32_t f : old_faces_) {
    if (!alive_[f]) continue;
    new_faces_.push_back(f);
    made_by_[f] = static_cast<std::uint32_t>(step_);
  }
  note_corners();
  note_stripped();
}

/// Whether a collapse changes triangles at b that are not at a.
bool StepOrder::changes_kept(std::uint32_t b) {
  const CollapseRecord& record = levels_.record;
  const CollapseStep& step = record.steps[step_];
  if (step.moved) return true;
  const auto is_at_b = [&](std::uint32_t layer, ValueId value) {
    const std::uint32_t home = home_[step.mesh][layer][value.index()];
    return home != kInvalid && vertex_now(home) == b;
  };
  for (std::size_t i = before().joins_end; i < step.joins_end; ++i) {
    if (is_at_b(record.joins[i].layer, record.joins[i].removed)) return true;
  }
  for (std::size_t i = before().writes_end; i < step.writes_end; ++i) {
    const ValueWrite& write = record.writes[i];
    if (write.layer == kInvalid || is_at_b(write.layer, ValueId{write.value})) return true;
  }
  return false;
}

/// What an original vertex has become.
std::uint32_t StepOrder::vertex_now(std::uint32_t v) {
  while (merged_into_[v] != v) v = merged_into_[v] = merged_into_[merged_into_[v]];
  return v;
}

void StepOrder::add_old_faces(std::uint32_t v) {
  for_corners(v, [&](std::uint32_t c) { add_old_face(c / 3); });
}

void StepOrder::add_old_face(std::uint32_t f) {
  if (face_mark_[f] == mark_ || !alive_[f]) return;
  face_mark_[f] = mark_;
  old_faces_.push_back(f);
}

/// Gives a's corners to b, which moves.
void StepOrder::merge(const CollapseStep& step, std::uint32_t a, std::uint32_t b) {
  for_corners(a, [&](std::uint32_t c) { faces_[c / 3][c % 3] = b; });
  for_corners(b, [](std::uint32_t) {});
  if (first_corner_[b] == kInvalid) {
    first_corner_[b] = first_corner_[a];
  } else {
    next_corner_[last_corner_[b]] = first_corner_[a];
  }
  if (last_corner_[a] != kInvalid) last_corner_[b] = last_corner_[a];
  first_corner_[a] = last_corner_[a] = kInvalid;
  merged_into_[a] = b;
  if (step.moved) positions_[b] = step.position;
}

/// The steps that made the faces that this one replaces, or removed one at its ends, or at a vertex of what
/// vanishes, and left none there that would tell of it: without these a vertex would have triangles that this
/// step does not know.
void StepOrder::note_needs() {
  const CollapseStep& step = levels_.record.steps[step_];
  needs_.clear();
  for (const std::uint32_t f : old_faces_) needs_.push_back(made_by_[f]);
  const auto add_stripped = [&](std::uint32_t v) {
    needs_.insert(needs_.end(), stripped_by_[v].begin(), stripped_by_[v].end());
  };
  if (step.kind == StepKind::collapse) {
    for (const VertexId v : {step.removed, step.kept}) add_stripped(levels_.vertex(step.mesh, v));
  } else {
    for (const std::uint32_t f : old_faces_) std::ranges::for_each(faces_[f], add_stripped);
  }
  std::sort(needs_.begin(), needs_.end());
  needs_.erase(std::unique(needs_.begin(), needs_.end()), needs_.end());
  if (!needs_.empty() && needs_.back() == kNever) needs_.pop_back();
  levels_.needs.insert(levels_.needs.end(), needs_.begin(), needs_.end());
  levels_.needs_end.push_back(static_cast<std::uint32_t>(levels_.needs.size()));
}

void StepOrder::note_corners() {
  const auto note = [&](std::uint32_t v) {
    if (v == kInvalid || vertex_mark_[v] == mark_) return;
    vertex_mark_[v] = mark_;
    levels_.corners.push_back(v);
  };
  note(kept_);
  for (const std::uint32_t f : new_faces_.empty() ? old_faces_ : new_faces_) {
    for (const std::uint32_t v : faces_[f]) note(v);
  }
  levels_.corners_end.push_back(static_cast<std::uint32_t>(levels_.corners.size()));
}

/// Notes at the ends of each edge that stays and lost a triangle, if it has no new one that would tell of it.
void StepOrder::note_stripped() {
  const CollapseStep& step = levels_.record.steps[step_];
  const std::uint32_t gone =
      step.kind == StepKind::collapse ? levels_.vertex(step.mesh, step.removed) : kInvalid;
  const auto has_new = [&](std::uint32_t v, std::uint32_t w) {
    return std::ranges::any_of(new_faces_, [&](std::uint32_t f) {
      return std::ranges::count(faces_[f], v) > 0 && std::ranges::count(faces_[f], w) > 0;
    });
  };
  for (const std::uint32_t f : old_faces_) {
    if (alive_[f]) continue;
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t v = faces_[f][k], w = faces_[f][(k + 1) % 3];
      if (v == gone || w == gone || has_new(v, w)) continue;
      for (const std::uint32_t end : {v, w}) {
        std::vector<std::uint32_t>& stripped = stripped_by_[end];
        if (stripped.empty() || stripped.back() != step_)
          stripped.push_back(static_cast<std::uint32_t>(step_));
      }
    }
  }
}

}  // namespace fovea
