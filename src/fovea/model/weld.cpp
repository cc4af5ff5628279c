#include "fovea/model/weld.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "fovea/base/error.h"
#include "fovea/model/key_table.h"

namespace fovea {

namespace {

bool is_skin(Semantic semantic) { return semantic == Semantic::joints || semantic == Semantic::weights; }

/// Everything that `weld` knows while it works: the parts, where their vertices begin in source
/// order, and the mesh as far as it is made.
class Welder {
 public:
  Welder(std::span<const SplitPart> parts, Context& context, const std::string& place)
      : parts_(parts), context_(context), place_(place) {}

  TriMesh run() {
    check_input();
    weld_vertices();
    make_layers();
    make_values();
    make_triangles();
    split_mirrored_uvs();
    return std::move(mesh_);
  }

 private:
  void check_input() const;
  void weld_vertices();
  void make_layers();
  void make_values();
  void make_group_values(const std::vector<std::size_t>& group);
  void make_triangles();
  void split_mirrored_uvs();

  static const VertexArray* find(const std::vector<VertexArray>& arrays, const AttributeLayer& layer) {
    for (const VertexArray& a : arrays) {
      if (a.semantic == layer.semantic && a.set == layer.set && a.name == layer.name) return &a;
    }
    return nullptr;
  }

  std::span<const SplitPart> parts_;
  Context& context_;
  const std::string& place_;
  TriMesh mesh_;
  std::vector<std::size_t> first_source_;              // [#parts], of the part's first vertex
  std::vector<std::vector<ValueId>> value_of_source_;  // [#layers][#source vertices]
};

void Welder::check_input() const {
  std::size_t corners = 0, vertices = 0;
  for (std::size_t p = 0; p < parts_.size(); ++p) {
    const SplitPart& part = parts_[p];
    corners += part.indices.size();
    vertices += part.positions.size();
    for (std::size_t i = 0; i < part.indices.size(); ++i) {
      if (part.indices[i] >= part.positions.size()) {
        throw Error(ErrorKind::format,
                    fmt::format("index {} is {} but there are {} vertices", i, part.indices[i],
                                part.positions.size()),
                    fmt::format("{}/primitives/{}/indices", place_, p));
      }
    }
    for (std::size_t v = 0; v < part.positions.size(); ++v) {
      const Vec3f q = part.positions[v];
      if (!std::isfinite(q.x) || !std::isfinite(q.y) || !std::isfinite(q.z)) {
        throw Error(ErrorKind::format, fmt::format("position {} is not a finite number", v),
                    fmt::format("{}/primitives/{}/attributes/POSITION", place_, p));
      }
    }
  }
  if (corners >= kInvalid || vertices >= kInvalid) {
    throw Error(ErrorKind::limit,
                fmt::format("{} corners and {} vertices do not fit 32 bits", corners, vertices), place_);
  }
}

void Welder::weld_vertices() {
  std::size_t target_count = 0, source_count = 0;
  for (const SplitPart& part : parts_) {
    first_source_.push_back(source_count);
    if (part.part.raw) continue;
    source_count += part.positions.size();
    target_count = std::max(target_count, part.position_morphs.size());
    target_count = std::max(target_count, part.attribute_morphs.size());
  }
  mesh_.source_vertex.resize(source_count);
  mesh_.position_morphs.resize(target_count);
  std::vector<std::uint32_t> key(3 * (1 + target_count));
  KeyTable table(key.size(), source_count);
  std::vector<bool> used;
  bool first = true;
  for (std::size_t p = 0; p < parts_.size(); ++p) {
    const SplitPart& part = parts_[p];
    if (part.part.raw || part.indices.empty()) continue;
    mesh_.position_storage =
        first || mesh_.position_storage == part.position_storage ? part.position_storage : Storage{};
    first = false;
    used.assign(part.positions.size(), false);
    for (const std::uint32_t i : part.indices) used[i] = true;
    const auto morph_of = [&](std::size_t t, std::size_t v) {
      return t < part.position_morphs.size() && !part.position_morphs[t].empty() ? part.position_morphs[t][v]
                                                                                 : Vec3f{};
    };
    for (std::size_t v = 0; v < part.positions.size(); ++v) {
      if (!used[v]) continue;
      auto word = key.begin();
      const auto put = [&](Vec3f q) {
        for (const float x : {q.x, q.y, q.z}) *word++ = KeyTable::word(x);
      };
      put(part.positions[v]);
      for (std::size_t t = 0; t < target_count; ++t) put(morph_of(t, v));
      const VertexId id{table.insert(key)};
      mesh_.source_vertex[first_source_[p] + v] = id;
      if (id.index() < mesh_.positions.size()) continue;
      mesh_.positions.push_back(part.positions[v]);
      for (std::size_t t = 0; t < target_count; ++t) mesh_.position_morphs[t].push_back(morph_of(t, v));
    }
  }
}

void Welder::make_layers() {
  for (const SplitPart& part : parts_) {
    mesh_.parts.push_back(part.part);
    if (part.part.raw || part.indices.empty()) continue;
    for (const VertexArray& a : part.attributes) {
      const auto known = std::find_if(mesh_.layers.begin(), mesh_.layers.end(), [&](const AttributeLayer& l) {
        return l.semantic == a.semantic && l.set == a.set && l.name == a.name;
      });
      if (known == mesh_.layers.end()) {
        AttributeLayer layer;
        layer.semantic = a.semantic;
        layer.set = a.set;
        layer.name = a.name;
        layer.width = a.width;
        layer.storage = a.storage;
        mesh_.layers.push_back(std::move(layer));
      } else {
        known->width = std::max(known->width, a.width);
        if (known->storage != a.storage) known->storage = Storage{};
      }
    }
  }
}

void Welder::make_values() {
  value_of_source_.assign(mesh_.layers.size(), {});
  std::vector<std::size_t> skin_group;
  for (std::size_t l = 0; l < mesh_.layers.size(); ++l) {
    if (is_skin(mesh_.layers[l].semantic)) {
      skin_group.push_back(l);
    } else {
      make_group_values({l});
    }
  }
  if (!skin_group.empty()) make_group_values(skin_group);
}

/// Values of layers that share one corner map: a value is new when the vertex, any of the layers'
/// numbers or any of their morphs is.
void Welder::make_group_values(const std::vector<std::size_t>& group) {
  const std::size_t target_count = mesh_.target_count();
  std::size_t words = 1;
  for (const std::size_t l : group) words += mesh_.layers[l].width * (1 + target_count);
  for (const std::size_t l : group) {
    value_of_source_[l].resize(mesh_.source_vertex.size());
    mesh_.layers[l].morphs.resize(target_count);
  }
  KeyTable table(words, mesh_.vertex_count());
  std::vector<std::uint32_t> key(words);
  std::vector<float> numbers(words - 1);

  for (std::size_t p = 0; p < parts_.size(); ++p) {
    const SplitPart& part = parts_[p];
    if (part.part.raw || part.indices.empty()) continue;
    // Per layer of the group its array in this part, then that of each target (null: zeros).
    std::vector<const VertexArray*> arrays;
    bool present = false;
    for (const std::size_t l : group) {
      arrays.push_back(find(part.attributes, mesh_.layers[l]));
      present = present || arrays.back() != nullptr;
      for (std::size_t t = 0; t < target_count; ++t) {
        arrays.push_back(t < part.attribute_morphs.size() ? find(part.attribute_morphs[t], mesh_.layers[l])
                                                          : nullptr);
      }
    }
    if (!present) continue;
    for (std::size_t v = 0; v < part.positions.size(); ++v) {
      const VertexId vertex = mesh_.source_vertex[first_source_[p] + v];
      if (!vertex.valid()) continue;
      key[0] = vertex.value;
      std::size_t n = 0, a = 0;
      for (const std::size_t l : group) {
        const AttributeLayer& layer = mesh_.layers[l];
        for (std::size_t t = 0; t <= target_count; ++t, ++a) {
          const VertexArray* array = arrays[a];
          for (int i = 0; i < layer.width; ++i) {
            const bool missing_alpha = t == 0 && layer.semantic == Semantic::color && i == 3;
            const float x = array && i < array->width ? array->values[v * array->width + i]
                                                      : (missing_alpha ? 1.0f : 0.0f);
            numbers[n] = x;
            key[1 + n++] = KeyTable::word(x);
          }
        }
      }
      const ValueId value{table.insert(key)};
      const bool is_new = value.index() == mesh_.layers[group[0]].size();
      n = 0;
      for (const std::size_t l : group) {
        AttributeLayer& layer = mesh_.layers[l];
        value_of_source_[l][first_source_[p] + v] = value;
        if (is_new) layer.values.insert(layer.values.end(), &numbers[n], &numbers[n] + layer.width);
        n += layer.width;
        for (std::size_t t = 0; t < target_count; ++t, n += layer.width) {
          if (is_new) layer.morphs[t].insert(layer.morphs[t].end(), &numbers[n], &numbers[n] + layer.width);
        }
      }
    }
  }
  for (const std::size_t l : group) {
    bool any = false;
    for (auto& morph : mesh_.layers[l].morphs) {
      if (std::all_of(morph.begin(), morph.end(), [](float x) { return x == 0; })) morph.clear();
      any = any || !morph.empty();
    }
    if (!any) mesh_.layers[l].morphs.clear();
  }
}

void Welder::make_triangles() {
  std::uint64_t degenerate = 0;
  std::size_t corners = 0;
  for (const SplitPart& part : parts_) corners += part.part.raw ? 0 : part.indices.size();
  mesh_.triangles.reserve(corners / 3);
  mesh_.face_part.reserve(corners / 3);
  for (AttributeLayer& layer : mesh_.layers) layer.corner_value.reserve(corners);
  for (std::size_t p = 0; p < parts_.size(); ++p) {
    const SplitPart& part = parts_[p];
    if (part.part.raw) continue;
    for (std::size_t i = 0; i + 2 < part.indices.size(); i += 3) {
      std::array<VertexId, 3> t;
      for (std::size_t k = 0; k < 3; ++k) t[k] = mesh_.source_vertex[first_source_[p] + part.indices[i + k]];
      if (t[0] == t[1] || t[1] == t[2] || t[2] == t[0]) {
        ++degenerate;
        continue;
      }
      mesh_.triangles.push_back(t);
      mesh_.face_part.push_back(static_cast<std::uint32_t>(p));
      for (std::size_t l = 0; l < mesh_.layers.size(); ++l) {
        for (std::size_t k = 0; k < 3; ++k) {
          mesh_.layers[l].corner_value.push_back(value_of_source_[l][first_source_[p] + part.indices[i + k]]);
        }
      }
    }
  }
  if (degenerate > 0) {
    context_.report("degenerate-triangles", "triangles without area were dropped", place_, degenerate);
  }
}

/// Where a texture is mirrored, its two halves meet in equal texture coordinates that must part ways
/// when the mesh changes: each orientation gets values of its own, which makes the line a seam.
void Welder::split_mirrored_uvs() {
  for (AttributeLayer& layer : mesh_.layers) {
    if (layer.semantic != Semantic::uv) continue;
    const auto is_mirrored = [&](std::size_t face) {
      const auto uv = [&](std::size_t k) {
        const float* x = layer.value(layer.corner_value[3 * face + k]);
        return Vec2d{x[0], x[1]};
      };
      return cross(uv(1) - uv(0), uv(2) - uv(0)) < 0;
    };
    enum : std::uint8_t { kPlain = 1, kMirrored = 2 };
    std::vector<std::uint8_t> seen(layer.size(), 0);
    std::vector<bool> mirrored(mesh_.face_count());
    for (std::size_t f = 0; f < mesh_.face_count(); ++f) {
      if (!layer.corner_value[3 * f].valid()) continue;
      mirrored[f] = is_mirrored(f);
      for (std::size_t k = 0; k < 3; ++k)
        seen[layer.corner_value[3 * f + k].index()] |= mirrored[f] ? kMirrored : kPlain;
    }
    std::vector<ValueId> twin(layer.size());
    for (std::size_t f = 0; f < mesh_.face_count(); ++f) {
      if (!mirrored[f]) continue;
      for (std::size_t k = 0; k < 3; ++k) {
        ValueId& value = layer.corner_value[3 * f + k];
        if (seen[value.index()] != (kPlain | kMirrored)) continue;
        if (!twin[value.index()].valid()) {
          twin[value.index()] = ValueId{layer.size()};
          const auto copy = [&](std::vector<float>& values) {
            for (int i = 0; i < layer.width; ++i) {
              values.push_back(values[value.index() * static_cast<std::size_t>(layer.width) +
                                      static_cast<std::size_t>(i)]);
            }
          };
          copy(layer.values);
          for (auto& morph : layer.morphs) {
            if (!morph.empty()) copy(morph);
          }
        }
        value = twin[value.index()];
      }
    }
  }
}

/// For every value of a layer the first value of the same vertex with the same bits.
std::vector<ValueId> canonical_values(const TriMesh& mesh, const AttributeLayer& layer) {
  std::vector<VertexId> owner(layer.size());
  for (std::size_t c = 0; c < layer.corner_value.size(); ++c) {
    if (layer.corner_value[c].valid()) owner[layer.corner_value[c].index()] = mesh.vertex(CornerId{c});
  }
  const std::size_t width = static_cast<std::size_t>(layer.width);
  std::vector<std::uint32_t> key(1 + width * (1 + layer.morphs.size()));
  KeyTable table(key.size(), layer.size());
  std::vector<ValueId> first, canonical(layer.size());
  for (std::size_t v = 0; v < layer.size(); ++v) {
    auto word = key.begin();
    *word++ = owner[v].value;
    for (std::size_t i = 0; i < width; ++i) *word++ = KeyTable::word(layer.values[v * width + i]);
    for (const auto& morph : layer.morphs) {
      for (std::size_t i = 0; i < width; ++i)
        *word++ = morph.empty() ? 0u : KeyTable::word(morph[v * width + i]);
    }
    const std::uint32_t number = table.insert(key);
    if (number == first.size()) first.push_back(ValueId{v});
    canonical[v] = first[number];
  }
  return canonical;
}

/// The split vertices of one part: which corner makes each, and the triangles over them.
struct PartSplit {
  std::vector<CornerId> vertex_corner;  // [#split vertices], the corner that made it
  std::vector<std::uint32_t> indices;   // [#triangles × 3]
};

std::vector<PartSplit> split_corners(const TriMesh& mesh) {
  std::vector<std::vector<ValueId>> canonical;
  for (const AttributeLayer& layer : mesh.layers) canonical.push_back(canonical_values(mesh, layer));
  std::vector<std::vector<std::size_t>> faces(mesh.parts.size());
  for (std::size_t f = 0; f < mesh.face_count(); ++f) faces[mesh.face_part[f]].push_back(f);

  std::vector<PartSplit> result(mesh.parts.size());
  std::vector<std::uint32_t> key(1 + mesh.layers.size());
  for (std::size_t p = 0; p < mesh.parts.size(); ++p) {
    KeyTable table(key.size(), faces[p].size() / 2 + 8);
    for (const std::size_t f : faces[p]) {
      for (std::size_t k = 0; k < 3; ++k) {
        const CornerId c{3 * f + k};
        key[0] = mesh.vertex(c).value;
        for (std::size_t l = 0; l < mesh.layers.size(); ++l) {
          const ValueId value = mesh.layers[l].corner_value[c.index()];
          key[1 + l] = value.valid() ? canonical[l][value.index()].value : kInvalid;
        }
        const std::uint32_t index = table.insert(key);
        if (index == result[p].vertex_corner.size()) result[p].vertex_corner.push_back(c);
        result[p].indices.push_back(index);
      }
    }
  }
  return result;
}

VertexArray gather(const AttributeLayer& layer, const std::vector<float>& from,
                   const std::vector<CornerId>& corners) {
  VertexArray array;
  array.semantic = layer.semantic;
  array.set = layer.set;
  array.name = layer.name;
  array.width = layer.width;
  array.storage = layer.storage;
  array.values.assign(corners.size() * static_cast<std::size_t>(layer.width), 0.0f);
  auto out = array.values.begin();
  for (const CornerId c : corners) {
    const ValueId value = layer.corner_value[c.index()];
    if (value.valid())
      std::copy_n(from.begin() + static_cast<std::ptrdiff_t>(value.index()) * layer.width, layer.width, out);
    out += layer.width;
  }
  return array;
}

SplitPart gather_part(const TriMesh& mesh, const Part& part, PartSplit&& from) {
  SplitPart out;
  out.part = part;
  out.position_storage = mesh.position_storage;
  out.indices = std::move(from.indices);
  const std::vector<CornerId>& corners = from.vertex_corner;
  for (const CornerId c : corners) out.positions.push_back(mesh.positions[mesh.vertex(c).index()]);
  if (corners.empty()) return out;
  for (const auto& morph : mesh.position_morphs) {
    out.position_morphs.emplace_back();
    for (const CornerId c : corners) out.position_morphs.back().push_back(morph[mesh.vertex(c).index()]);
  }
  out.attribute_morphs.resize(mesh.target_count());
  for (const AttributeLayer& layer : mesh.layers) {
    const bool present = std::any_of(corners.begin(), corners.end(),
                                     [&](CornerId c) { return layer.corner_value[c.index()].valid(); });
    if (!present) continue;
    out.attributes.push_back(gather(layer, layer.values, corners));
    for (std::size_t t = 0; t < layer.morphs.size(); ++t) {
      if (!layer.morphs[t].empty())
        out.attribute_morphs[t].push_back(gather(layer, layer.morphs[t], corners));
    }
  }
  return out;
}

}  // namespace

TriMesh weld(std::span<const SplitPart> parts, Context& context, const std::string& place) {
  return Welder(parts, context, place).run();
}

std::vector<SplitPart> split(const TriMesh& mesh) {
  std::vector<PartSplit> corners = split_corners(mesh);
  std::vector<SplitPart> parts;
  for (std::size_t p = 0; p < mesh.parts.size(); ++p) {
    parts.push_back(gather_part(mesh, mesh.parts[p], std::move(corners[p])));
  }
  return parts;
}

std::size_t split_vertex_count(const TriMesh& mesh) {
  std::size_t count = 0;
  for (const PartSplit& part : split_corners(mesh)) count += part.vertex_corner.size();
  return count;
}

}  // namespace fovea
