#include "fovea/simplify/record.h"

#include <algorithm>
#include <utility>

#include "fovea/base/error.h"

namespace fovea {

namespace {

/// One source mesh on its way through the steps.
class Replayed {
 public:
  explicit Replayed(const TriMesh& source)
      : source_(source),
        mesh_(source),
        vertex_target_(source.vertex_count()),
        face_gone_(source.face_count(), false) {
    for (std::size_t v = 0; v < vertex_target_.size(); ++v) vertex_target_[v] = VertexId{v};
    for (const AttributeLayer& layer : source.layers) {
      value_target_.emplace_back(layer.size());
      for (std::size_t v = 0; v < layer.size(); ++v) value_target_.back()[v] = ValueId{v};
    }
  }

  void collapse(const CollapseStep& step) {
    vertex_target_[step.removed.index()] = step.kept;
    if (step.moved) mesh_.positions[step.kept.index()] = step.position;
  }
  void remove(FaceId face) { face_gone_[face.index()] = true; }
  void join(const ValueJoin& join) { value_target_[join.layer][join.removed.index()] = join.kept; }
  /// How many numbers a write has.
  std::size_t width(const ValueWrite& write) const {
    if (write.layer == kInvalid) return 3 * mesh_.position_morphs.size();
    const AttributeLayer& layer = mesh_.layers[write.layer];
    return static_cast<std::size_t>(layer.width) * (1 + layer.morphs.size());
  }
  const float* write(const ValueWrite& write, const float* numbers) {
    return write_numbers(mesh_, write, numbers);
  }
  TriMesh finish();

 private:
  template <class Id>
  static Id follow(std::vector<Id>& target, Id id) {
    while (target[id.index()] != id) id = target[id.index()] = target[target[id.index()].index()];
    return id;
  }
  void gather_faces(TriMesh& out);
  void compact_vertices(TriMesh& out);
  void compact_layer(AttributeLayer& layer) const;

  const TriMesh& source_;
  TriMesh mesh_;
  std::vector<VertexId> vertex_target_;
  std::vector<std::vector<ValueId>> value_target_;
  std::vector<bool> face_gone_;
};

/// The triangles that are left, with the vertices and values that theirs have become.
void Replayed::gather_faces(TriMesh& out) {
  const auto left = static_cast<std::size_t>(std::count(face_gone_.begin(), face_gone_.end(), false));
  out.triangles.reserve(left);
  out.face_part.reserve(left);
  for (AttributeLayer& layer : out.layers) {
    layer.corner_value = std::vector<ValueId>();  // with its room
    layer.corner_value.reserve(3 * left);
  }
  for (std::size_t f = 0; f < source_.face_count(); ++f) {
    if (face_gone_[f]) continue;
    std::array<VertexId, 3> t = source_.triangles[f];
    for (VertexId& v : t) v = follow(vertex_target_, v);
    out.triangles.push_back(t);
    out.face_part.push_back(source_.face_part[f]);
    for (std::size_t l = 0; l < out.layers.size(); ++l) {
      for (std::size_t k = 0; k < 3; ++k) {
        const ValueId value = source_.layers[l].corner_value[3 * f + k];
        out.layers[l].corner_value.push_back(value.valid() ? follow(value_target_[l], value) : value);
      }
    }
  }
}

void Replayed::compact_vertices(TriMesh& out) {
  std::vector<VertexId> number(source_.vertex_count());
  std::vector<bool> used(source_.vertex_count(), false);
  for (const auto& t : out.triangles) {
    for (const VertexId v : t) used[v.index()] = true;
  }
  out.position_morphs.resize(mesh_.position_morphs.size());
  for (std::size_t v = 0; v < used.size(); ++v) {
    if (!used[v]) continue;
    number[v] = VertexId{out.positions.size()};
    out.positions.push_back(mesh_.positions[v]);
    for (std::size_t t = 0; t < out.position_morphs.size(); ++t) {
      out.position_morphs[t].push_back(mesh_.position_morphs[t][v]);
    }
  }
  for (auto& t : out.triangles) {
    for (VertexId& v : t) v = number[v.index()];
  }
  for (const VertexId v : source_.source_vertex) {
    out.source_vertex.push_back(v.valid() ? number[follow(vertex_target_, v).index()] : v);
  }
}

void Replayed::compact_layer(AttributeLayer& layer) const {
  const auto width = static_cast<std::size_t>(layer.width);
  std::vector<ValueId> number(layer.size());
  std::vector<ValueId> kept;
  for (ValueId& value : layer.corner_value) {
    if (!value.valid()) continue;
    if (!number[value.index()].valid()) {
      number[value.index()] = ValueId{kept.size()};
      kept.push_back(value);
    }
    value = number[value.index()];
  }
  const auto gather = [&](std::vector<float>& values) {
    if (values.empty()) return;
    std::vector<float> out;
    out.reserve(kept.size() * width);
    for (const ValueId v : kept) {
      const auto from = values.begin() + static_cast<std::ptrdiff_t>(v.index() * width);
      out.insert(out.end(), from, from + layer.width);
    }
    values = std::move(out);
  };
  gather(layer.values);
  for (auto& morph : layer.morphs) gather(morph);
}

TriMesh Replayed::finish() {
  TriMesh out;
  out.position_storage = source_.position_storage;
  out.parts = source_.parts;
  out.layers = std::move(mesh_.layers);
  gather_faces(out);
  compact_vertices(out);
  for (AttributeLayer& layer : out.layers) compact_layer(layer);
  return out;
}

/// The meshes after the steps up to `step_count` for which `takes(s)`.
template <class Takes>
std::vector<TriMesh> replay_where(std::span<const TriMesh* const> sources, const CollapseRecord& record,
                                  std::size_t step_count, Takes&& takes) {
  std::vector<Replayed> meshes;
  meshes.reserve(sources.size());
  for (const TriMesh* source : sources) meshes.emplace_back(*source);
  std::size_t face = 0, join = 0, write = 0;
  const float* numbers = record.floats.data();
  for (std::size_t s = 0; s < step_count; ++s) {
    const CollapseStep& step = record.steps[s];
    Replayed& mesh = meshes[step.mesh];
    if (!takes(s)) {
      for (; write < step.writes_end; ++write) numbers += mesh.width(record.writes[write]);
      face = step.faces_end;
      join = step.joins_end;
      continue;
    }
    if (step.kind == StepKind::collapse) mesh.collapse(step);
    for (; face < step.faces_end; ++face) mesh.remove(record.removed_faces[face]);
    for (; join < step.joins_end; ++join) mesh.join(record.joins[join]);
    for (; write < step.writes_end; ++write) numbers = mesh.write(record.writes[write], numbers);
  }
  std::vector<TriMesh> result;
  for (Replayed& mesh : meshes) result.push_back(mesh.finish());
  return result;
}

}  // namespace

std::size_t CollapseRecord::steps_to(std::uint64_t triangles) const {
  if (triangles >= triangles_before) return 0;
  const auto last = std::partition_point(steps.begin(), steps.end(), [&](const CollapseStep& step) {
    return triangles_before - step.faces_end > triangles;
  });
  return last == steps.end() ? steps.size() : static_cast<std::size_t>(last - steps.begin()) + 1;
}

const float* write_numbers(TriMesh& mesh, const ValueWrite& write, const float* numbers) {
  if (write.layer == kInvalid) {
    for (auto& morph : mesh.position_morphs) {
      morph[write.value] = {numbers[0], numbers[1], numbers[2]};
      numbers += 3;
    }
    return numbers;
  }
  AttributeLayer& layer = mesh.layers[write.layer];
  const auto width = static_cast<std::size_t>(layer.width);
  const auto set = [&](std::vector<float>& values) {
    if (!values.empty()) std::copy_n(numbers, width, values.data() + write.value * width);
    numbers += width;
  };
  set(layer.values);
  for (auto& morph : layer.morphs) set(morph);
  return numbers;
}

std::vector<TriMesh> replay(std::span<const TriMesh* const> sources, const CollapseRecord& record,
                            std::size_t step_count) {
  if (step_count > record.steps.size()) throw Error(ErrorKind::usage, "the record has fewer steps", "replay");
  return replay_where(sources, record, step_count, [](std::size_t) { return true; });
}

std::vector<TriMesh> replay(std::span<const TriMesh* const> sources, const CollapseRecord& record,
                            std::span<const std::uint8_t> taken) {
  if (taken.size() != record.steps.size())
    throw Error(ErrorKind::usage, "there must be one choice for each step", "replay");
  return replay_where(sources, record, taken.size(), [&](std::size_t s) { return taken[s] != 0; });
}

}  // namespace fovea
