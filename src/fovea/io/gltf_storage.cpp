#include <algorithm>
#include <cmath>
#include <limits>

#include "fovea/io/gltf_column.h"

namespace fovea::gltf {

namespace {

using enum ComponentType;

bool is_position(const Column& c) { return c.name == "POSITION"; }
bool is_direction(const Column& c) { return c.name == "NORMAL" || c.name == "TANGENT"; }
bool starts_with(const Column& c, std::string_view prefix) { return c.name.starts_with(prefix); }

struct Range {
  double low = std::numeric_limits<double>::infinity();
  double high = -std::numeric_limits<double>::infinity();
};

Range range_of(const Column& c) {
  Range range;
  for (const float v : c.values) {
    if (!std::isfinite(v)) continue;
    range.low = std::min(range.low, static_cast<double>(v));
    range.high = std::max(range.high, static_cast<double>(v));
  }
  return range;
}

/// Whether the values survive in `storage` but for rounding.
bool fits(const Column& c, Storage storage) {
  if (storage.type == f32) return true;
  const int bits = 8 * static_cast<int>(size_of(storage.type));
  const bool is_signed = storage.type == i8 || storage.type == i16;
  const double top = std::ldexp(1.0, is_signed ? bits - 1 : bits) - 1;
  const double unit = storage.normalized ? 1 / top : 1;
  const double bottom = !is_signed ? 0.0 : storage.normalized ? -1.0 : -top - 1;
  const Range range = range_of(c);
  return range.low >= bottom - unit / 2 && range.high <= top * unit + unit / 2;
}

bool is_exact(const Column& c, Storage storage) {
  return std::all_of(c.values.begin(), c.values.end(),
                     [&](float v) { return decode_component(encode_component(v, storage), storage) == v; });
}

Storage unsigned_normalized(std::int64_t bits) { return {bits <= 8 ? u8 : u16, true}; }
Storage signed_normalized(std::int64_t bits) { return {bits <= 8 ? i8 : i16, true}; }

void apply_grid(Column& c, const Grid& grid, bool is_delta) {
  const double offset[3] = {grid.offset.x, grid.offset.y, grid.offset.z};
  for (std::size_t i = 0; i < c.values.size(); ++i) {
    const double shifted = is_delta ? c.values[i] : c.values[i] - offset[i % 3];
    c.values[i] = static_cast<float>(std::round(shifted / grid.step));
  }
}

/// Attributes that came as integers keep their own quantisation; floats get the asked one.
void quantize(Column& c, const WriteOptions& options, Context& context, const std::string& place) {
  if (c.storage.type != f32) return;
  if (is_direction(c)) {
    c.storage = signed_normalized(options.normal_bits);
    c.bits =
        static_cast<int>(std::max<std::int64_t>(options.normal_bits, 2));  // a sign alone is no direction
  } else if (starts_with(c, "COLOR_")) {
    c.storage = unsigned_normalized(options.color_bits);
    c.bits = static_cast<int>(options.color_bits);
  } else if (starts_with(c, "WEIGHTS_")) {
    c.storage = {u8, true};
  } else if (starts_with(c, "TEXCOORD_")) {
    const Storage smaller = unsigned_normalized(options.uv_bits);
    if (fits(c, smaller)) {
      c.storage = smaller;
      c.bits = static_cast<int>(options.uv_bits);
    } else {
      context.report("uv-not-quantized", "texture coordinates beyond 0..1 were kept as floats", place);
    }
  }
}

void choose_joints(Column& c, bool quantize) {
  const bool small = range_of(c).high <= 255;
  const bool keep_wide = c.storage == Storage{u16, false} && !quantize;
  c.storage = {small && !keep_wide ? u8 : u16, false};
}

void choose_positions(Column& c, const WriteOptions& options, const Grid* grid) {
  if (!grid) return;
  apply_grid(c, *grid, false);
  c.storage = {options.position_bits <= 8 ? u8 : u16, false};
}

void fall_back_to_float(Column& c, bool morph_target) {
  const bool is_matrix = c.width > 4;  // integer columns of matrices would need padding
  if (!is_matrix && is_quantized_format(c.name, c.storage, morph_target) && fits(c, c.storage)) return;
  c.storage = {};
  c.bits = 0;
}

/// Files do not tell how the model's morph targets were stored: signed, because they are differences,
/// and in a byte only if that loses nothing.
void choose_target(Column& c, const WriteOptions& options, const Grid* grid) {
  const bool on_grid = is_position(c) && grid;
  if (on_grid) {
    apply_grid(c, *grid, true);
    c.storage = {i16, false};
  }
  if (options.quantize && c.storage.type == f32 && is_direction(c)) {
    c.storage = signed_normalized(options.normal_bits);
    c.bits = static_cast<int>(std::max<std::int64_t>(options.normal_bits, 2));
    return;
  }
  if (c.storage.type == f32) return;
  const Storage byte{i8, c.storage.normalized}, word{i16, c.storage.normalized};
  c.storage = fits(c, byte) && is_exact(c, byte) ? byte : word;
}

/// Sums over all sets are only exact when the sets count in the same unit.
void unify_weights(std::vector<Column>& columns) {
  Storage widest{u8, true};
  for (const Column& c : columns) {
    if (!starts_with(c, "WEIGHTS_")) continue;
    if (size_of(c.storage.type) > size_of(widest.type)) widest = c.storage;
  }
  for (Column& c : columns) {
    if (starts_with(c, "WEIGHTS_")) c.storage = widest;
  }
}

void drop_impossible(std::vector<Column>& columns, Context& context, const std::string& place) {
  const auto impossible = [](const Column& c) {
    return !(c.width >= 1 && c.width <= 4) && c.width != 9 && c.width != 16;
  };
  for (const Column& c : columns) {
    if (impossible(c)) context.report("attribute-dropped", c.name + " has a width that glTF lacks", place);
  }
  std::erase_if(columns, impossible);
}

}  // namespace

void choose_storage(ColumnPart& part, const WriteOptions& options, const Grid* grid, Context& context,
                    const std::string& place) {
  drop_impossible(part.columns, context, place);
  for (Column& c : part.columns) {
    if (is_position(c)) choose_positions(c, options, grid);
    if (options.quantize) quantize(c, options, context, place);
    if (starts_with(c, "JOINTS_")) choose_joints(c, options.quantize);
    fall_back_to_float(c, false);
  }
  unify_weights(part.columns);
  for (auto& target : part.targets) {
    drop_impossible(target, context, place);
    for (Column& c : target) {
      choose_target(c, options, grid);
      fall_back_to_float(c, true);
    }
  }
}

}  // namespace fovea::gltf
