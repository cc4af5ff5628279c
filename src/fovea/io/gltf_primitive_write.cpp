#include "fovea/io/gltf_primitive_write.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "fovea/base/error.h"

namespace fovea::gltf {

namespace {

constexpr std::size_t kMaxStride = 252;  // glTF 2.0, bufferView.byteStride
/// Shorter indices end below the largest number of their type, which restarts strips on some GPUs.
constexpr std::size_t kMaxShortVertices = 65535;

/// How much smaller sparse storage must be to be worth the trouble of reading it.
constexpr std::size_t kSparseGain = 2;

std::size_t element_size(const Column& c) {
  return static_cast<std::size_t>(c.width) * size_of(c.storage.type);
}
std::size_t padded_size(const Column& c) { return (element_size(c) + 3) / 4 * 4; }

float snap(float value, const Column& c) {
  if (c.bits == 0) return value;
  const bool is_signed = c.storage.type == ComponentType::i8 || c.storage.type == ComponentType::i16;
  const double levels = std::ldexp(1.0, is_signed ? c.bits - 1 : c.bits) - 1;
  return static_cast<float>(std::round(value * levels) / levels);
}

template <class T>
void encode_as(const Column& c, std::byte* out, std::size_t stride) {
  const std::size_t width = static_cast<std::size_t>(c.width);
  for (std::size_t v = 0; v < c.size(); ++v) {
    for (std::size_t k = 0; k < width; ++k) {
      const T raw = static_cast<T>(encode_component(snap(c.values[v * width + k], c), c.storage));
      std::memcpy(out + v * stride + k * sizeof(T), &raw, sizeof(T));
    }
  }
}

void encode(const Column& c, std::byte* out, std::size_t stride) {
  switch (c.storage.type) {
    case ComponentType::i8: return encode_as<std::int8_t>(c, out, stride);
    case ComponentType::u8: return encode_as<std::uint8_t>(c, out, stride);
    case ComponentType::i16: return encode_as<std::int16_t>(c, out, stride);
    case ComponentType::u16: return encode_as<std::uint16_t>(c, out, stride);
    case ComponentType::u32: return encode_as<std::uint32_t>(c, out, stride);
    case ComponentType::f32: return encode_as<float>(c, out, stride);
  }
}

/// Bounds of the numbers as stored: a reader compares them with the bytes.
void set_bounds(ViewAccessor& accessor, const Column& c) {
  const std::size_t width = static_cast<std::size_t>(c.width);
  accessor.low.assign(width, std::numeric_limits<double>::infinity());
  accessor.high.assign(width, -std::numeric_limits<double>::infinity());
  for (std::size_t i = 0; i < c.values.size(); ++i) {
    const double raw = encode_component(snap(c.values[i], c), c.storage);
    accessor.low[i % width] = std::min(accessor.low[i % width], raw);
    accessor.high[i % width] = std::max(accessor.high[i % width], raw);
  }
}

ViewAccessor describe(const Column& c, int view, std::size_t offset) {
  ViewAccessor accessor;
  accessor.view = view;
  accessor.offset = offset;
  accessor.count = c.size();
  accessor.storage = c.storage;
  accessor.width = c.width;
  accessor.matrix = c.width > 4;
  if (c.name == "POSITION") set_bounds(accessor, c);
  return accessor;
}

/// Lays the columns [first, last) side by side in one view.
void interleave(EncodedPart& out, std::span<const Column> columns) {
  View view;
  view.target = ViewTarget::vertices;
  view.count = columns.front().size();
  for (const Column& c : columns) view.stride += padded_size(c);
  view.bytes.resize(view.count * view.stride);
  std::size_t offset = 0;
  for (const Column& c : columns) {
    encode(c, view.bytes.data() + offset, view.stride);
    out.attributes.push_back({c.name, describe(c, static_cast<int>(out.views.size()), offset)});
    offset += padded_size(c);
  }
  out.views.push_back(std::move(view));
}

void encode_attributes(EncodedPart& out, std::span<const Column> columns) {
  while (!columns.empty()) {
    std::size_t count = 0, stride = 0;
    while (count < columns.size() && stride + padded_size(columns[count]) <= kMaxStride) {
      stride += padded_size(columns[count++]);
    }
    interleave(out, columns.first(count));
    columns = columns.subspan(count);
  }
}

int add_view(EncodedPart& out, View view) {
  out.views.push_back(std::move(view));
  return static_cast<int>(out.views.size()) - 1;
}

/// The rows of a column that are not all zero, and which they are.
struct NonZeroRows {
  std::vector<std::uint32_t> rows;
  Column values;
};

NonZeroRows non_zero_rows(const Column& c) {
  const std::size_t width = static_cast<std::size_t>(c.width);
  NonZeroRows result{{}, {c.name, c.width, c.storage, c.bits, {}}};
  for (std::size_t v = 0; v < c.size(); ++v) {
    const auto row = c.values.begin() + static_cast<std::ptrdiff_t>(v * width);
    if (std::all_of(row, row + c.width, [](float x) { return x == 0; })) continue;
    result.rows.push_back(static_cast<std::uint32_t>(v));
    result.values.values.insert(result.values.values.end(), row, row + c.width);
  }
  return result;
}

View index_view(const std::vector<std::uint32_t>& indices, bool is_short, ViewTarget target) {
  View view;
  view.target = target;
  view.stride = is_short ? 2 : 4;
  view.count = indices.size();
  view.bytes.resize(view.count * view.stride);
  for (std::size_t i = 0; i < indices.size(); ++i) {
    const std::uint16_t small = static_cast<std::uint16_t>(indices[i]);
    std::memcpy(view.bytes.data() + i * view.stride,
                is_short ? static_cast<const void*>(&small) : &indices[i], view.stride);
  }
  return view;
}

View value_view(const Column& c, std::size_t stride, ViewTarget target) {
  View view;
  view.target = target;
  view.stride = stride;
  view.count = c.size();
  view.bytes.resize(view.count * view.stride);
  encode(c, view.bytes.data(), view.stride);
  return view;
}

ViewAccessor::Sparse encode_sparse(EncodedPart& out, const NonZeroRows& some, bool is_short) {
  ViewAccessor::Sparse sparse;
  sparse.count = some.rows.size();
  sparse.index_type = is_short ? ComponentType::u16 : ComponentType::u32;
  sparse.index_view = add_view(out, index_view(some.rows, is_short, ViewTarget::none));
  sparse.value_view = add_view(out, value_view(some.values, element_size(some.values), ViewTarget::none));
  return sparse;
}

/// A face has dozens of targets, each of which moves a corner of it: those are stored as what they move. An
/// accessor without view and without sparse part is all zeros and costs nothing. Compression does as well
/// with the zeros.
EncodedPart::Attribute encode_target_column(EncodedPart& out, const Column& c, bool compressed) {
  const NonZeroRows some = non_zero_rows(c);
  ViewAccessor accessor = describe(c, -1, 0);
  const bool is_short = c.size() <= kMaxShortVertices;
  const std::size_t sparse_row = element_size(c) + (is_short ? 2 : 4);
  if (some.rows.empty()) return {c.name, accessor};
  if (!compressed && kSparseGain * some.rows.size() * sparse_row < c.size() * padded_size(c)) {
    accessor.sparse = encode_sparse(out, some, is_short);
  } else {
    accessor.view = add_view(out, value_view(c, padded_size(c), ViewTarget::vertices));
  }
  return {c.name, accessor};
}

void encode_indices(EncodedPart& out, const std::vector<std::uint32_t>& indices, std::size_t vertex_count) {
  const bool is_short = vertex_count <= kMaxShortVertices;
  out.indices.view = add_view(out, index_view(indices, is_short, ViewTarget::indices));
  out.indices.count = indices.size();
  out.indices.storage = {is_short ? ComponentType::u16 : ComponentType::u32, false};
}

bool needs_quantization(const ColumnPart& part) {
  const auto beyond_core = [](const std::vector<Column>& columns, bool morph_target) {
    return std::any_of(columns.begin(), columns.end(),
                       [&](const Column& c) { return !is_core_format(c.name, c.storage, morph_target); });
  };
  return beyond_core(part.columns, false) ||
         std::any_of(part.targets.begin(), part.targets.end(),
                     [&](const std::vector<Column>& target) { return beyond_core(target, true); });
}

/// The primitive as read, less what the writer makes itself; `mode` and the rest keep their order.
Json primitive_json(const std::string& text, int material, int mode) {
  Json json = Json::object();
  json["attributes"] = Json::object();
  Json read = parse_object(text);
  erase_extension(read, "KHR_draco_mesh_compression");
  for (const char* key : {"attributes", "indices", "targets"}) read.erase(key);
  refresh_index(read, "material", material);
  refresh(read, "mode", mode, 4);
  for (auto& [key, value] : read.items()) json[key] = value;
  return json;
}

void add_targets(Json& json, std::vector<Json>&& targets) {
  if (!targets.empty()) json["targets"] = std::move(targets);
}

Json place_attributes(const std::vector<NamedAccessor>& attributes, BufferWriter& buffers, bool morph_target,
                      bool& quantized) {
  Json json = Json::object();
  for (const NamedAccessor& a : attributes) {
    json[a.name] = buffers.add_plain(a.data, ViewTarget::vertices, a.name == "POSITION");
    quantized = quantized || !is_core_format(a.name, a.data.storage, morph_target);
  }
  return json;
}

}  // namespace

EncodedPart encode_part(SplitPart part, bool ordered, const WriteOptions& options, const Grid* grid,
                        Context& context, const std::string& place) {
  EncodedPart out;
  out.json = part.part.json;
  out.material = part.part.material;
  ColumnPart columns = to_columns(std::move(part));
  if (!ordered) optimize_order(columns);
  choose_storage(columns, options, grid, context, place);
  clean_values(columns, context, place);
  out.quantized = needs_quantization(columns);
  encode_attributes(out, columns.columns);
  for (const auto& target : columns.targets) {
    out.targets.emplace_back();
    for (const Column& c : target) {
      out.targets.back().push_back(
          encode_target_column(out, c, options.compression != GeometryCompression::none));
    }
  }
  encode_indices(out, columns.indices, columns.vertex_count());
  return out;
}

Json place_part(EncodedPart part, BufferWriter& buffers) {
  std::vector<int> views;
  for (View& view : part.views) views.push_back(buffers.add_geometry(std::move(view)));
  const auto place_view = [&](int& view) {
    if (view >= 0) view = views[static_cast<std::size_t>(view)];
  };
  const auto place = [&](ViewAccessor accessor) {
    place_view(accessor.view);
    if (accessor.sparse) {
      place_view(accessor.sparse->index_view);
      place_view(accessor.sparse->value_view);
    }
    return buffers.add_accessor(accessor);
  };
  Json json = primitive_json(part.json, part.material, 4);
  for (auto& [name, accessor] : part.attributes) json["attributes"][name] = place(accessor);
  json["indices"] = place(part.indices);
  std::vector<Json> targets;
  for (auto& attributes : part.targets) {
    targets.push_back(Json::object());
    for (auto& [name, accessor] : attributes) targets.back()[name] = place(accessor);
  }
  add_targets(json, std::move(targets));
  return json;
}

Json place_raw(const Part& part, BufferWriter& buffers, bool& quantized) {
  const RawPrimitive& raw = *part.raw;
  Json json = primitive_json(part.json, part.material, raw.mode);
  json["attributes"] = place_attributes(raw.attributes, buffers, false, quantized);
  if (raw.indices) json["indices"] = buffers.add_plain(*raw.indices, ViewTarget::indices, false);
  std::vector<Json> targets;
  for (const auto& target : raw.targets)
    targets.push_back(place_attributes(target, buffers, true, quantized));
  add_targets(json, std::move(targets));
  return json;
}

}  // namespace fovea::gltf
