#include "fovea/io/gltf_column.h"

#include <fmt/format.h>
#include <meshoptimizer.h>

#include <algorithm>
#include <cmath>

namespace fovea::gltf {

namespace {

constexpr std::string_view kPosition = "POSITION";

bool is_integer_of(Storage s, std::initializer_list<ComponentType> types) {
  return std::find(types.begin(), types.end(), s.type) != types.end();
}

Column to_column(VertexArray&& array) {
  Column c;
  c.name = attribute_name(array);
  c.width = array.width;
  c.storage = array.storage;
  c.values = std::move(array.values);
  return c;
}

Column position_column(const std::vector<Vec3f>& positions, Storage storage) {
  Column c;
  c.name = kPosition;
  c.width = 3;
  c.storage = storage;
  c.values.reserve(3 * positions.size());
  for (const Vec3f p : positions) c.values.insert(c.values.end(), {p.x, p.y, p.z});
  return c;
}

/// A target moves the direction of a tangent and leaves its sign alone.
void drop_tangent_sign(Column& c) {
  if (c.name != "TANGENT" || c.width != 4) return;
  std::size_t n = 0;
  for (std::size_t v = 0; v < c.values.size(); v += 4) {
    for (std::size_t k = 0; k < 3; ++k) c.values[n++] = c.values[v + k];
  }
  c.values.resize(n);
  c.width = 3;
}

/// What has not the number of components that glTF wants goes under a name of its own.
void rename_odd_shapes(Column& c) {
  if (c.name.starts_with("COLOR_") && c.width != 3 && c.width != 4) c.name = "_" + c.name;
}

/// Viewers disagree on what a target without an attribute means that others have.
void fill_up_targets(ColumnPart& part) {
  std::vector<Column> all;  // without values
  for (const auto& target : part.targets) {
    for (const Column& c : target) {
      const auto same = [&](const Column& known) { return known.name == c.name; };
      if (std::none_of(all.begin(), all.end(), same)) all.push_back({c.name, c.width, c.storage, c.bits, {}});
    }
  }
  const std::size_t count = part.vertex_count();
  for (auto& target : part.targets) {
    std::vector<Column> filled;
    for (const Column& model : all) {
      const auto own =
          std::find_if(target.begin(), target.end(), [&](const Column& c) { return c.name == model.name; });
      if (own != target.end()) {
        filled.push_back(std::move(*own));
      } else {
        filled.push_back(model);
      }
      filled.back().values.resize(count * static_cast<std::size_t>(model.width));
    }
    target = std::move(filled);
  }
}

void permute(Column& c, const std::vector<unsigned int>& new_place, std::size_t new_count) {
  const std::size_t width = static_cast<std::size_t>(c.width);
  std::vector<float> moved(new_count * width);
  for (std::size_t v = 0; v < new_place.size(); ++v) {
    if (new_place[v] == kInvalid) continue;
    std::copy_n(c.values.begin() + static_cast<std::ptrdiff_t>(v * width), width,
                moved.begin() + static_cast<std::ptrdiff_t>(new_place[v] * width));
  }
  c.values = std::move(moved);
}

}  // namespace

std::string attribute_name(const VertexArray& array) {
  switch (array.semantic) {
    case Semantic::uv: return fmt::format("TEXCOORD_{}", array.set);
    case Semantic::normal: return "NORMAL";
    case Semantic::tangent: return "TANGENT";
    case Semantic::color: return fmt::format("COLOR_{}", array.set);
    case Semantic::joints: return fmt::format("JOINTS_{}", array.set);
    case Semantic::weights: return fmt::format("WEIGHTS_{}", array.set);
    case Semantic::custom: break;
  }
  return array.name.starts_with('_') ? array.name : "_" + array.name;
}

bool is_core_format(std::string_view name, Storage s, bool morph_target) {
  using enum ComponentType;
  const bool is_float = s.type == f32;
  if (name.starts_with('_')) return s.type != u32;
  if (name.starts_with("JOINTS_")) return !s.normalized && is_integer_of(s, {u8, u16});
  if (name.starts_with("TEXCOORD_") || name.starts_with("COLOR_") || name.starts_with("WEIGHTS_")) {
    const bool is_signed = morph_target && is_integer_of(s, {i8, i16});
    return is_float || (s.normalized && (is_integer_of(s, {u8, u16}) || is_signed));
  }
  return is_float;
}

bool is_quantized_format(std::string_view name, Storage s, bool morph_target) {
  using enum ComponentType;
  if (is_core_format(name, s, morph_target)) return true;
  const bool is_signed = is_integer_of(s, {i8, i16});
  if (name == kPosition) return is_signed || (!morph_target && is_integer_of(s, {u8, u16}));
  if (name == "NORMAL" || name == "TANGENT") return is_signed && s.normalized;
  if (name.starts_with("TEXCOORD_")) return is_integer_of(s, {i8, u8, i16, u16});
  return false;
}

ColumnPart to_columns(SplitPart part) {
  ColumnPart out;
  out.indices = std::move(part.indices);
  out.columns.push_back(position_column(part.positions, part.position_storage));
  for (VertexArray& a : part.attributes) out.columns.push_back(to_column(std::move(a)));
  out.targets.resize(std::max(part.position_morphs.size(), part.attribute_morphs.size()));
  for (std::size_t t = 0; t < out.targets.size(); ++t) {
    std::vector<Vec3f> moves =
        t < part.position_morphs.size() ? part.position_morphs[t] : std::vector<Vec3f>{};
    moves.resize(part.positions.size());
    out.targets[t].push_back(position_column(moves, part.position_storage));
    if (t >= part.attribute_morphs.size()) continue;
    for (VertexArray& a : part.attribute_morphs[t]) out.targets[t].push_back(to_column(std::move(a)));
    for (Column& c : out.targets[t]) drop_tangent_sign(c);
  }
  for (Column& c : out.columns) rename_odd_shapes(c);
  fill_up_targets(out);
  return out;
}

void optimize_order(ColumnPart& part) {
  const std::size_t count = part.vertex_count();
  meshopt_optimizeVertexCache(part.indices.data(), part.indices.data(), part.indices.size(), count);
  std::vector<unsigned int> new_place(count);
  const std::size_t used =
      meshopt_optimizeVertexFetchRemap(new_place.data(), part.indices.data(), part.indices.size(), count);
  meshopt_remapIndexBuffer(part.indices.data(), part.indices.data(), part.indices.size(), new_place.data());
  for (Column& c : part.columns) permute(c, new_place, used);
  for (auto& target : part.targets) {
    for (Column& c : target) permute(c, new_place, used);
  }
}

}  // namespace fovea::gltf
