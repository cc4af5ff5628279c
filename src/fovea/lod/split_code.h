#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <vector>

#include "fovea/lod/growing_mesh.h"
#include "fovea/lod/level_streams.h"
#include "fovea/lod/number_code.h"
#include "fovea/simplify/record.h"

// Private to lod. What a file of levels says of a model and of each step, for writing and for reading: every
// function is made for an `Io` that has the functions of StreamWriter or of StreamReader. Where
// `Io::kWrites`, it also answers what is to be written, see split_source.h.

namespace fovea {

/// How the numbers of a mesh are coded.
struct MeshCodes {
  NumberCode position, position_morph;
  std::vector<NumberCode> value, value_morph;  // [#layers]
};

struct GrowingModel {
  std::vector<GrowingMesh> meshes;
  std::vector<MeshCodes> codes;  // [#meshes]
};

/// A step, read from coarse to fine, with what makes it a step of a record again.
struct Split {
  StepKind kind = StepKind::collapse;
  bool moved = false, morphs = false;  ///< Whether `kept` has another position, other morphs afterwards.
  bool kept_is_new = false;            ///< No triangle had it before.
  std::uint32_t mesh = 0;
  VertexId kept, removed;          ///< None if a component comes.
  std::uint32_t faces = 0;         ///< That come.
  float error = 0;                 ///< MultiTessellation::error,
  float error_rel = 0;             ///< and CollapseStep::error_rel. Both rounded up to eight bits.
  Vec3f coarse_position;           ///< Of `kept`,
  std::vector<ValueJoin> joins;    // values that come, with those that they came from
  std::vector<ValueWrite> writes;  // what is rewritten, with
  std::vector<float> floats;       // the numbers that it had
};

/// The nearest number of eight bits that is no less; 0 or more.
inline std::uint32_t rounded_up(float x) { return (std::bit_cast<std::uint32_t>(x) + 0xFFFFu) >> 16; }
inline float from_rounded(std::uint32_t bits) { return std::bit_cast<float>(bits << 16); }

/// Codes one step after the other into the model that they refine.
template <class Io>
class SplitCode {
 public:
  SplitCode(Io& io, GrowingModel& model) : io_(io), model_(model) {}

  /// Writes `split`, of which kind, mesh, what it changes and the number of triangles are set, or reads it.
  void code(Split& split) {
    split_ = &split;
    code_flags();
    io_.charge(sizeof(Split));
    mesh_ = &model_.meshes[split.mesh];
    codes_ = &model_.codes[split.mesh];
    first_vertex_ = mesh_->surface.vertex_count();
    values_.clear();
    around_.clear();
    if (split.kind == StepKind::collapse) code_fan();
    if constexpr (!Io::kWrites) {
      if (split.faces > io_.left(Symbol::triangle)) damaged_levels("a step has too many triangles");
    }
    for (std::uint32_t j = 0; j < split.faces; ++j) code_face(j);
    code_positions();
    code_values();
  }

 private:
  using Corners = std::array<VertexId, 3>;
  /// Of a triangle with its corners in fans, without values, and of a vertex with its fan.
  static constexpr std::size_t kFaceBytes = 32, kVertexBytes = 48;

  /// A value whose numbers follow.
  struct NewValue {
    std::uint32_t layer = 0;
    ValueId id;
    ValueId near;            ///< One of the vertex that is known, if any.
    bool rewritten = false;  ///< Whether it is known and has other numbers now,
    bool opposite = false;   ///< or whether what came before it in this list is likely to lie opposite to it.
  };

  void code_flags() {
    Split& s = *split_;
    constexpr std::uint32_t kMany = 15;
    std::uint32_t flags = 0;
    if constexpr (Io::kWrites) {
      flags = static_cast<std::uint32_t>(s.kind) | s.moved << 1 | s.morphs << 2 | s.kept_is_new << 3 |
              std::min(s.faces, kMany) << 4;
    }
    io_.symbol(Symbol::flags, flags);
    std::uint32_t more = Io::kWrites ? s.faces - kMany : 0;
    if (flags >> 4 == kMany) io_.symbol(Symbol::faces, more);
    if (model_.meshes.size() > 1) io_.symbol(Symbol::mesh, s.mesh);
    std::uint32_t error = rounded_up(s.error), error_rel = rounded_up(s.error_rel);
    io_.wide(Wide::error, error);
    io_.wide(Wide::error_rel, error_rel);
    if constexpr (!Io::kWrites) {
      if (flags > 0xFF || s.mesh >= model_.meshes.size() || more > 0xFFFFFFFFu - kMany)
        damaged_levels("there is no such step");
      s.kind = static_cast<StepKind>(flags & 1);
      s.moved = (flags & 2) != 0;
      s.morphs = (flags & 4) != 0;
      s.kept_is_new = (flags & 8) != 0;
      s.faces = flags >> 4 == kMany ? more + kMany : flags >> 4;
      s.error = from_rounded(error);
      s.error_rel = from_rounded(error_rel);
      if (!(s.error >= 0) || !(s.error_rel >= 0) || !std::isfinite(s.error) || !std::isfinite(s.error_rel))
        damaged_levels("an error is no number");
      if (s.kind != StepKind::collapse && flags % 16 != 1) damaged_levels("there is no such step");
      if (s.kept_is_new && (s.moved || s.morphs)) damaged_levels("there is no such step");
    }
  }

  /// What becomes of the triangles around `kept`.
  void code_fan() {
    Split& s = *split_;
    if (s.kept_is_new) {
      s.kept = add_vertex();
      if constexpr (Io::kWrites) io_.name_kept(s.kept);
    } else {
      io_.wide(Wide::kept, s.kept.value);
      if constexpr (!Io::kWrites) {
        if (s.kept.index() >= mesh_->surface.vertex_count()) damaged_levels("a vertex is not there");
      }
    }
    s.removed = add_vertex();
    if constexpr (Io::kWrites) io_.name_removed(s.removed);
    const auto fan = mesh_->fan(s.kept);
    fan_.assign(fan.begin(), fan.end());
    side_.assign(fan_.size(), 0);
    if constexpr (Io::kWrites) {
      for (std::size_t i = 0; i < fan_.size(); ++i) side_[i] = io_.is_at_removed(fan_[i]);
    }
    code_sides();
    for (std::uint32_t l = 0; l < mesh_->surface.layers.size(); ++l) code_groups(l);
    mesh_->split_fan(s.kept, s.removed, side_);
    find_around();
  }

  VertexId add_vertex() {
    io_.charge(kVertexBytes + mesh_->surface.target_count() * sizeof(Vec3f));
    return mesh_->add_vertex();
  }

  ValueId add_value(std::uint32_t l) {
    const AttributeLayer& layer = mesh_->surface.layers[l];
    io_.charge(static_cast<std::size_t>(layer.width) * (1 + layer.morphs.size()) * sizeof(float));
    return mesh_->add_value(l);
  }

  void code_sides() {
    for (std::size_t i = 0; i < side_.size(); i += 7) {
      std::uint32_t bits = 0;
      const std::size_t end = std::min(i + 7, side_.size());
      for (std::size_t k = i; k < end; ++k) bits |= static_cast<std::uint32_t>(side_[k]) << (k - i);
      io_.symbol(Symbol::sides, bits);
      for (std::size_t k = i; k < end; ++k) side_[k] = (bits >> (k - i)) & 1;
    }
  }

  /// Each value of a layer at `kept` becomes itself, or itself and new ones.
  void code_groups(std::uint32_t l) {
    auto& corner_value = mesh_->surface.layers[l].corner_value;
    mesh_->values_at(split_->kept, l, groups_);
    for (const ValueId group : groups_) {
      members_.clear();
      for (std::size_t i = 0; i < fan_.size(); ++i) {
        if (corner_value[fan_[i]] == group) members_.push_back(i);
      }
      digits_.assign(members_.size(), 0);
      std::uint32_t count = 0, rewritten = 0;
      if constexpr (Io::kWrites) {
        for (std::size_t i = 0; i < members_.size(); ++i) digits_[i] = io_.digit(l, group, fan_[members_[i]]);
        count = io_.digit_count();
        rewritten = io_.is_rewritten(l, group);
      }
      code_digits(count, rewritten);
      const std::size_t first = values_.size() + rewritten;
      if (rewritten != 0) values_.push_back({l, group, group, true, false});
      for (std::uint32_t n = 0; n < count; ++n) {
        const ValueId id = add_value(l);
        if constexpr (Io::kWrites) io_.name_digit(l, n + 1, id);
        values_.push_back({l, id, group, false, rewritten != 0});
        split_->joins.push_back({l, id, group});
      }
      for (std::size_t i = 0; i < members_.size(); ++i) {
        if (digits_[i] > 0) corner_value[fan_[members_[i]]] = values_[first + digits_[i] - 1].id;
      }
    }
  }

  /// Usually there is one new value, for the corners that go to the new vertex.
  void code_digits(std::uint32_t& count, std::uint32_t& rewritten) {
    const auto follows = [&] {
      for (std::size_t i = 0; i < members_.size(); ++i) {
        if (digits_[i] != side_[members_[i]]) return false;
      }
      return true;
    };
    std::uint32_t group = 0;
    if constexpr (Io::kWrites)
      group = (count == 0 ? 0 : count == 1 && follows() ? 1 : count + 1) << 1 | rewritten;
    io_.symbol(Symbol::groups, group);
    rewritten = group & 1;
    group >>= 1;
    if (group == 1) {
      count = 1;
      for (std::size_t i = 0; i < members_.size(); ++i) digits_[i] = side_[members_[i]];
    } else if (group > 1) {
      count = group - 1;
      if (count > members_.size()) damaged_levels("a corner has no such value");
      for (std::uint32_t& digit : digits_) {
        io_.symbol(Symbol::digits, digit);
        if (digit > count) damaged_levels("a corner has no such value");
      }
    }
  }

  /// The vertices around both ends, those that both have first: new triangles are likely there.
  void find_around() {
    ++stamp_;
    mesh_->neighbors(split_->kept, stamp_, seen_at_kept_, at_kept_);
    mesh_->neighbors(split_->removed, stamp_, seen_at_removed_, at_removed_);
    for (const bool both : {true, false}) {
      for (const VertexId v : at_kept_) {
        if ((seen_at_removed_[v.index()] == stamp_) == both) around_.push_back(v);
      }
    }
    for (const VertexId v : at_removed_) {
      if (seen_at_kept_[v.index()] != stamp_) around_.push_back(v);
    }
  }

  void code_face(std::uint32_t j) {
    Corners t;
    if constexpr (Io::kWrites) t = io_.face(j, split_->kept, split_->removed);
    code_corners(t);
    std::array<std::uint32_t, 3> beside{};
    for (std::size_t k = 0; k < 3; ++k) {
      beside[k] = mesh_->corner_beside(t[k], t[(k + 1) % 3], 2);
      if (beside[k] == kInvalid) beside[k] = mesh_->corner_beside(t[k], t[(k + 2) % 3], 1);
    }
    const std::uint32_t part = code_part(beside);
    face_values_.clear();
    for (std::uint32_t l = 0; l < mesh_->surface.layers.size(); ++l) code_face_values(l, t, beside);
    io_.charge(kFaceBytes + face_values_.size() * sizeof(ValueId));
    const FaceId f = mesh_->add_face(t, part, face_values_);
    if constexpr (Io::kWrites) io_.name_face(f);
  }

  void code_corners(Corners& t) {
    const VertexId a = split_->kept, b = split_->removed;
    std::uint32_t usual = 0;
    if constexpr (Io::kWrites) {
      if (t[0] == a && a.valid()) {
        for (std::uint32_t turn = 0; turn < 2; ++turn) {
          const auto at = std::ranges::find(around_, t[2 - turn]);
          if (t[1 + turn] == b && at != around_.end())
            usual = 1 + 2 * static_cast<std::uint32_t>(at - around_.begin()) + turn;
        }
      }
    }
    io_.symbol(Symbol::triangle, usual);
    if (usual == 0) {
      for (VertexId& v : t) code_vertex(v);
    } else if constexpr (!Io::kWrites) {
      const std::uint32_t i = (usual - 1) / 2, turn = (usual - 1) % 2;
      if (!a.valid() || i >= around_.size()) damaged_levels("a vertex is not there");
      t[0] = a;
      t[1 + turn] = b;
      t[2 - turn] = around_[i];
    }
    if (t[0] == t[1] || t[1] == t[2] || t[2] == t[0]) damaged_levels("a triangle has a vertex twice");
  }

  void code_vertex(VertexId& v) {
    enum : std::uint32_t { kKept, kRemoved, kNew, kNumbered, kAround };
    const VertexId a = split_->kept, b = split_->removed;
    std::uint32_t code = kNumbered;
    if constexpr (Io::kWrites) {
      const auto at = std::ranges::find(around_, v);
      if (!v.valid()) {
        code = kNew;
      } else if (v == a) {
        code = kKept;
      } else if (v == b) {
        code = kRemoved;
      } else if (at != around_.end()) {
        code = kAround + static_cast<std::uint32_t>(at - around_.begin());
      }
    }
    io_.symbol(Symbol::vertex, code);
    if (code == kNew) {
      v = add_vertex();
      if (a.valid()) around_.push_back(v);
      if constexpr (Io::kWrites) io_.name_vertex(v);
    }
    const auto newest = static_cast<std::uint32_t>(mesh_->surface.vertex_count()) - 1;
    std::uint32_t back = newest - v.value;
    if (code == kNumbered) io_.symbol(Symbol::id, back);
    if constexpr (!Io::kWrites) {
      if (code == kNumbered) v.value = newest - back;
      if (code >= kAround && code - kAround >= around_.size()) damaged_levels("a vertex is not there");
      if (code <= kRemoved) v = code == kKept ? a : b;
      if (code >= kAround) v = around_[code - kAround];
      if (v.index() >= mesh_->surface.vertex_count()) damaged_levels("a vertex is not there");
    } else {
      io_.next_corner();
    }
  }

  /// Usually that of a neighbour.
  std::uint32_t code_part(const std::array<std::uint32_t, 3>& beside) {
    const std::size_t parts = mesh_->surface.parts.size();
    std::uint32_t part = 0;
    if (parts < 2) return part;
    std::uint32_t expected = 0;
    for (const std::uint32_t c : beside) {
      if (c == kInvalid) continue;
      expected = mesh_->surface.face_part[c / 3];
      break;
    }
    std::uint32_t code = 0;
    if constexpr (Io::kWrites) code = io_.part() == expected ? 0 : 1 + io_.part();
    io_.symbol(Symbol::part, code);
    part = code == 0 ? expected : code - 1;
    if (part >= parts || mesh_->surface.parts[part].raw) damaged_levels("a part is not there");
    return part;
  }

  /// Usually those of the neighbours.
  void code_face_values(std::uint32_t l, const Corners& t, const std::array<std::uint32_t, 3>& beside) {
    enum : std::uint32_t { kExpected, kNone, kNew, kListed };
    std::array<ValueId, 3> expected, value;
    std::array<std::uint32_t, 3> codes{};
    for (std::size_t k = 0; k < 3; ++k) {
      list_values(t[k], l);
      if (beside[k] != kInvalid) {
        expected[k] = mesh_->surface.layers[l].corner_value[beside[k]];
      } else if (!groups_.empty()) {
        expected[k] = groups_.front();
      }
      if constexpr (Io::kWrites) {
        bool is_new = false;
        value[k] = io_.value(l, k, is_new);
        const auto at = std::ranges::find(groups_, value[k]);
        codes[k] = is_new                    ? kNew
                   : value[k] == expected[k] ? kExpected
                   : !value[k].valid()       ? kNone
                                             : kListed + static_cast<std::uint32_t>(at - groups_.begin());
        if (codes[k] >= kListed && at == groups_.end())
          throw Error(ErrorKind::internal, "a value is used by corners of more than one vertex");
      }
    }
    std::uint32_t differs = codes != std::array<std::uint32_t, 3>{};
    io_.symbol(Symbol::values, differs);
    for (std::size_t k = 0; k < 3; ++k) {
      if (differs != 0) io_.symbol(Symbol::value, codes[k]);
      list_values(t[k], l);
      if (codes[k] == kExpected) value[k] = expected[k];
      if (codes[k] == kNone) value[k] = {};
      if (codes[k] >= kListed) {
        if (codes[k] - kListed >= groups_.size()) damaged_levels("a value is not there");
        value[k] = groups_[codes[k] - kListed];
      }
      if (codes[k] == kNew) {
        value[k] = add_value(l);
        if constexpr (Io::kWrites) io_.name_value(l, k, value[k]);
        values_.push_back({l, value[k], groups_.empty() ? ValueId{} : groups_.front(), false, false});
      }
    }
    face_values_.insert(face_values_.end(), value.begin(), value.end());
  }

  /// Those at a vertex, and those that no corner of the fan has kept.
  void list_values(VertexId v, std::uint32_t l) {
    mesh_->values_at(v, l, groups_);
    if (v != split_->kept && v != split_->removed) return;
    for (const ValueJoin& join : split_->joins) {
      if (join.layer == l && std::ranges::find(groups_, join.kept) == groups_.end())
        groups_.push_back(join.kept);
    }
  }

  // Numbers: each beside what is known of it, or of what it came from.

  void code_positions() {
    Split& s = *split_;
    TriMesh& mesh = mesh_->surface;
    const bool grows = s.kind == StepKind::collapse && !s.kept_is_new;
    if (grows) s.coarse_position = mesh.positions[s.kept.index()];
    if (s.moved) code_position(s.kept, s.coarse_position, nullptr);
    if (grows && s.morphs) {
      s.writes.push_back({kInvalid, s.kept.value});
      for (const auto& morph : mesh.position_morphs) {
        const Vec3f& p = morph[s.kept.index()];
        s.floats.insert(s.floats.end(), {p.x, p.y, p.z});
      }
      for (std::size_t t = 0; t < mesh.position_morphs.size(); ++t) code_morph(s.kept, t, s.kept);
    }
    for (std::size_t v = first_vertex_; v < mesh.vertex_count(); ++v) {
      const VertexId near = grows ? s.kept : v > 0 ? VertexId{v - 1} : VertexId{};
      const Vec3f fine = near.valid() ? mesh.positions[near.index()] : Vec3f();
      const bool opposite = s.moved && VertexId{v} == s.removed;
      code_position(VertexId{v}, opposite ? s.coarse_position : fine, opposite ? &fine : nullptr);
      for (std::size_t t = 0; t < mesh.position_morphs.size(); ++t) code_morph(VertexId{v}, t, near);
    }
  }

  void code_position(VertexId v, Vec3f near, const Vec3f* other) {
    Vec3f p;
    if constexpr (Io::kWrites) p = io_.fine_position(v);
    const NumberCode code = codes_->position;
    const auto axis = [&](float Vec3f::*x) {
      const std::int32_t middle = code.code(near.*x);
      io_.number(Wide::position, code,
                 other != nullptr ? code.opposite(middle, code.code((*other).*x)) : middle, p.*x);
    };
    axis(&Vec3f::x);
    axis(&Vec3f::y);
    axis(&Vec3f::z);
    mesh_->surface.positions[v.index()] = p;
  }

  void code_morph(VertexId v, std::size_t target, VertexId near) {
    auto& morph = mesh_->surface.position_morphs[target];
    const Vec3f from = near.valid() ? morph[near.index()] : Vec3f();
    Vec3f p;
    if constexpr (Io::kWrites) p = io_.fine_morph(target, v);
    const NumberCode code = codes_->position_morph;
    io_.number(Wide::position_morph, code, code.code(from.x), p.x);
    io_.number(Wide::position_morph, code, code.code(from.y), p.y);
    io_.number(Wide::position_morph, code, code.code(from.z), p.z);
    morph[v.index()] = p;
  }

  void code_values() {
    coarse_.clear();
    for (NewValue& value : values_) {
      AttributeLayer& layer = mesh_->surface.layers[value.layer];
      const auto width = static_cast<std::size_t>(layer.width);
      coarse_begin_ = coarse_.size();
      if (value.rewritten) note_coarse(value, layer);
      code_numbers(value, layer.values, -1, wide_of(layer.semantic), codes_->value[value.layer], width, 0);
      for (std::size_t t = 0; t < layer.morphs.size(); ++t) {
        if (!layer.morphs[t].empty())
          code_numbers(value, layer.morphs[t], static_cast<int>(t), Wide::value_morph,
                       codes_->value_morph[value.layer], width, (1 + t) * width);
      }
      if (value.rewritten) last_coarse_ = coarse_begin_;
    }
  }

  /// The numbers of a value before it is rewritten, for the record.
  void note_coarse(const NewValue& value, const AttributeLayer& layer) {
    const auto width = static_cast<std::size_t>(layer.width);
    split_->writes.push_back({value.layer, value.id.value});
    const auto add = [&](const std::vector<float>& numbers) {
      for (std::size_t i = 0; i < width; ++i)
        coarse_.push_back(numbers.empty() ? 0.0f : numbers[value.id.index() * width + i]);
    };
    add(layer.values);
    for (const auto& morph : layer.morphs) add(morph);
    split_->floats.insert(split_->floats.end(), coarse_.begin() + static_cast<std::ptrdiff_t>(coarse_begin_),
                          coarse_.end());
  }

  void code_numbers(const NewValue& value, std::vector<float>& numbers, int target, Wide kind,
                    NumberCode code, std::size_t width, std::size_t offset) {
    for (std::size_t i = 0; i < width; ++i) {
      float& x = numbers[value.id.index() * width + i];
      std::int32_t reference = code.code(0);
      if (value.opposite) {
        const float middle = coarse_[last_coarse_ + offset + i];
        reference = code.opposite(code.code(middle), code.code(numbers[value.near.index() * width + i]));
      } else if (value.near.valid()) {
        reference = code.code(numbers[value.near.index() * width + i]);
      } else if (value.id.index() > 0) {
        reference = code.code(numbers[(value.id.index() - 1) * width + i]);
      }
      if constexpr (Io::kWrites) x = io_.fine_number(value.layer, value.id, target, i);
      io_.number(kind, code, reference, x);
    }
  }

  Io& io_;
  GrowingModel& model_;
  // Of the present step:
  Split* split_ = nullptr;
  GrowingMesh* mesh_ = nullptr;
  const MeshCodes* codes_ = nullptr;
  std::size_t first_vertex_ = 0;
  std::vector<std::uint32_t> fan_, digits_;
  std::vector<std::uint8_t> side_;
  std::vector<std::size_t> members_;
  std::vector<VertexId> around_, at_kept_, at_removed_;
  std::uint32_t stamp_ = 0;  // of what was seen last
  std::vector<std::uint32_t> seen_at_kept_, seen_at_removed_;
  std::vector<ValueId> groups_, face_values_;
  std::vector<NewValue> values_;
  std::vector<float> coarse_;  // numbers of values that are rewritten, before
  std::size_t coarse_begin_ = 0, last_coarse_ = 0;
};

}  // namespace fovea
