#include "fovea/lod/split_source.h"

#include <algorithm>
#include <bit>

namespace fovea {

namespace {

/// How fine the integers of a storage are, as NumberCode's scale; 0 for floats and plain integers.
int unit_of(Storage storage) {
  if (!storage.normalized) return 0;
  switch (storage.type) {
    case ComponentType::i8: return 127;
    case ComponentType::u8: return 255;
    case ComponentType::i16: return 32767;
    case ComponentType::u16: return 65535;
    default: return 0;
  }
}

/// Finds the codes of all numbers that a mesh has at any time.
class CodeFinder {
 public:
  explicit CodeFinder(const TriMesh& mesh) : mesh_(mesh), position_(unit_of(mesh.position_storage)) {
    for (const Vec3f& p : mesh.positions) add(position_, p);
    for (const auto& morph : mesh.position_morphs) {
      for (const Vec3f& p : morph) add(position_morph_, p);
    }
    for (const AttributeLayer& layer : mesh.layers) {
      value_.emplace_back(unit_of(layer.storage)).add(layer.values);
      value_morph_.emplace_back();
      for (const auto& morph : layer.morphs) value_morph_.back().add(morph);
    }
  }

  void add_position(Vec3f p) { add(position_, p); }
  /// Returns where the numbers of the next write begin.
  const float* add(const ValueWrite& write, const float* numbers) {
    const auto run = [&](ScaleFinder& finder, std::size_t count) {
      finder.add({numbers, count});
      numbers += count;
    };
    if (write.layer == kInvalid) {
      run(position_morph_, 3 * mesh_.target_count());
    } else {
      const AttributeLayer& layer = mesh_.layers[write.layer];
      const auto width = static_cast<std::size_t>(layer.width);
      run(value_[write.layer], width);
      run(value_morph_[write.layer], width * layer.morphs.size());
    }
    return numbers;
  }

  MeshCodes codes() const {
    MeshCodes codes{NumberCode(position_.scale()), NumberCode(position_morph_.scale()), {}, {}};
    for (const ScaleFinder& finder : value_) codes.value.emplace_back(finder.scale());
    for (const ScaleFinder& finder : value_morph_) codes.value_morph.emplace_back(finder.scale());
    return codes;
  }

 private:
  static void add(ScaleFinder& finder, Vec3f p) {
    finder.add(p.x);
    finder.add(p.y);
    finder.add(p.z);
  }

  const TriMesh& mesh_;
  ScaleFinder position_, position_morph_;
  std::vector<ScaleFinder> value_, value_morph_;
};

std::vector<MeshCodes> find_codes(const LeveledModel& leveled) {
  std::vector<CodeFinder> finders;
  for (const Mesh& mesh : leveled.original.meshes) finders.emplace_back(mesh.surface);
  const CollapseRecord& record = leveled.levels.record;
  std::size_t write = 0;
  const float* numbers = record.floats.data();
  for (const CollapseStep& step : record.steps) {
    if (step.moved) finders[step.mesh].add_position(step.position);
    for (; write < step.writes_end; ++write) numbers = finders[step.mesh].add(record.writes[write], numbers);
  }
  std::vector<MeshCodes> codes;
  for (const CodeFinder& finder : finders) codes.push_back(finder.codes());
  return codes;
}

/// A mesh as it is without triangles.
GrowingMesh without_triangles(const TriMesh& mesh) {
  GrowingMesh grown;
  TriMesh& out = grown.surface;
  out.position_storage = mesh.position_storage;
  out.parts = mesh.parts;
  out.position_morphs.resize(mesh.target_count());
  for (const AttributeLayer& layer : mesh.layers) {
    AttributeLayer& l = out.layers.emplace_back();
    l.semantic = layer.semantic;
    l.set = layer.set;
    l.name = layer.name;
    l.width = layer.width;
    l.storage = layer.storage;
    l.morphs.resize(layer.morphs.size());
    auto& morphed = grown.morphed.emplace_back();
    for (const auto& morph : layer.morphs) morphed.push_back(!morph.empty());
  }
  return grown;
}

bool is_same(float a, float b) { return std::bit_cast<std::uint32_t>(a) == std::bit_cast<std::uint32_t>(b); }
bool is_same(Vec3f a, Vec3f b) { return is_same(a.x, b.x) && is_same(a.y, b.y) && is_same(a.z, b.z); }

}  // namespace

SplitSource::SplitSource(const LeveledModel& leveled, GrowingModel& model)
    : leveled_(leveled), model_(model), live_(leveled.original, leveled.levels) {
  const std::vector<MeshCodes> codes = find_codes(leveled);
  for (std::uint32_t m = 0; m < leveled.original.meshes.size(); ++m) {
    const TriMesh& mesh = leveled.original.meshes[m].surface;
    mesh_name_.push_back(kInvalid);
    const bool has_raw = std::ranges::any_of(mesh.parts, [](const Part& p) { return p.raw.has_value(); });
    if (mesh.face_count() == 0 && !has_raw) continue;  // as in a written GLB
    mesh_name_.back() = static_cast<std::uint32_t>(old_mesh_.size());
    old_mesh_.push_back(m);
    model.meshes.push_back(without_triangles(mesh));
    model.codes.push_back(codes[m]);
    Names& names = names_.emplace_back();
    names.vertex.resize(mesh.vertex_count());
    for (const AttributeLayer& layer : mesh.layers) names.value.emplace_back(layer.size());
    names.old_value.resize(mesh.layers.size());
  }
  live_.go_to(cut_leaving_meshes(leveled.original, leveled.levels));
}

Split SplitSource::base(std::uint32_t mesh) {
  begin_step(mesh);
  for (std::size_t f = 0; f < fine().face_count(); ++f) {
    if (live_.is_there(old_mesh_[mesh], FaceId{f})) faces_.push_back(FaceId{f});
  }
  Split split;
  split.kind = StepKind::vanish;
  split.mesh = mesh;
  split.faces = static_cast<std::uint32_t>(faces_.size());
  return split;
}

Split SplitSource::undo(std::size_t s) {
  const CollapseRecord& record = leveled_.levels.record;
  step_ = &record.steps[s];
  begin_step(mesh_name_[step_->mesh]);
  live_.set(s, false);
  for (std::size_t i = s > 0 ? record.steps[s - 1].faces_end : 0; i < step_->faces_end; ++i)
    faces_.push_back(record.removed_faces[i]);
  Split split;
  split.kind = step_->kind;
  split.mesh = mesh_;
  split.faces = static_cast<std::uint32_t>(faces_.size());
  split.error = leveled_.levels.error[s];
  split.error_rel = step_->error_rel;
  if (split.kind != StepKind::collapse) return split;
  split.kept = names().vertex[step_->kept.index()];
  split.kept_is_new = !split.kept.valid();
  if (split.kept_is_new) return split;
  const TriMesh& coarse = model_.meshes[mesh_].surface;
  split.moved = !is_same(coarse.positions[split.kept.index()], fine_position(split.kept));
  for (std::size_t t = 0; t < coarse.target_count(); ++t) {
    if (!is_same(coarse.position_morphs[t][split.kept.index()], fine_morph(t, split.kept)))
      split.morphs = true;
  }
  return split;
}

void SplitSource::begin_step(std::uint32_t mesh) {
  mesh_ = mesh;
  faces_.clear();
  layer_ = kInvalid;
}

void SplitSource::name(VertexId old, VertexId v) {
  names().vertex[old.index()] = v;
  names().old_vertex.push_back(old);
}

std::size_t SplitSource::old_corner_of(std::uint32_t corner) const {
  const std::uint32_t first = names().old_corner[corner / 3];
  return first / 3 * 3 + (first % 3 + corner % 3) % 3;
}

bool SplitSource::is_at_removed(std::uint32_t corner) const {
  return fine().vertex(CornerId{old_corner_of(corner)}) == step_->removed;
}

std::uint32_t SplitSource::digit(std::uint32_t layer, ValueId group, std::uint32_t corner) {
  if (layer != layer_ || group != group_) {
    layer_ = layer;
    group_ = group;
    digits_.clear();
  }
  const ValueId value = fine().layers[layer].corner_value[old_corner_of(corner)];
  if (names().value[layer][value.index()] == group) return 0;
  const auto at = std::ranges::find(digits_, value);
  const auto digit = 1 + static_cast<std::uint32_t>(at - digits_.begin());
  if (at == digits_.end()) digits_.push_back(value);
  return digit;
}

void SplitSource::name_digit(std::uint32_t layer, std::uint32_t digit, ValueId id) {
  names().value[layer][digits_[digit - 1].index()] = id;
  names().old_value[layer].push_back(digits_[digit - 1]);
}

bool SplitSource::is_rewritten(std::uint32_t layer, ValueId id) const {
  const AttributeLayer& coarse = model_.meshes[mesh_].surface.layers[layer];
  const auto width = static_cast<std::size_t>(coarse.width);
  const auto differs = [&](const std::vector<float>& numbers, int target) {
    for (std::size_t i = 0; i < width; ++i) {
      if (!is_same(numbers[id.index() * width + i], fine_number(layer, id, target, i))) return true;
    }
    return false;
  };
  if (differs(coarse.values, -1)) return true;
  for (std::size_t t = 0; t < coarse.morphs.size(); ++t) {
    if (!coarse.morphs[t].empty() && differs(coarse.morphs[t], static_cast<int>(t))) return true;
  }
  return false;
}

std::array<VertexId, 3> SplitSource::face(std::uint32_t j, VertexId kept, VertexId removed) {
  face_ = faces_[j];
  corner_ = turn_ = 0;
  std::array<VertexId, 3> corners;
  for (std::size_t k = 0; k < 3; ++k) corners[k] = names().vertex[fine().triangles[face_.index()][k].index()];
  for (const VertexId first : {kept, removed}) {
    const auto at = std::ranges::find(corners, first);
    if (!first.valid() || at == corners.end()) continue;
    turn_ = static_cast<std::size_t>(at - corners.begin());
    std::rotate(corners.begin(), at, corners.end());
    break;
  }
  return corners;
}

void SplitSource::name_vertex(VertexId v) { name(fine().vertex(CornerId{old_corner(corner_)}), v); }

std::uint32_t SplitSource::part() const { return fine().face_part[face_.index()]; }

ValueId SplitSource::value(std::uint32_t layer, std::size_t k, bool& is_new) const {
  const ValueId value = fine().layers[layer].corner_value[old_corner(k)];
  if (!value.valid()) return value;
  const ValueId id = names().value[layer][value.index()];
  is_new = !id.valid();
  return id;
}

void SplitSource::name_value(std::uint32_t layer, std::size_t k, ValueId id) {
  const ValueId value = fine().layers[layer].corner_value[old_corner(k)];
  names().value[layer][value.index()] = id;
  names().old_value[layer].push_back(value);
}

void SplitSource::name_face(FaceId) {
  names().old_corner.push_back(static_cast<std::uint32_t>(old_corner(0)));
}

Vec3f SplitSource::fine_position(VertexId v) const {
  return fine().positions[names().old_vertex[v.index()].index()];
}

Vec3f SplitSource::fine_morph(std::size_t target, VertexId v) const {
  return fine().position_morphs[target][names().old_vertex[v.index()].index()];
}

float SplitSource::fine_number(std::uint32_t layer, ValueId id, int target, std::size_t i) const {
  const AttributeLayer& l = fine().layers[layer];
  const std::vector<float>& numbers = target < 0 ? l.values : l.morphs[static_cast<std::size_t>(target)];
  return numbers[names().old_value[layer][id.index()].index() * static_cast<std::size_t>(l.width) + i];
}

}  // namespace fovea
