#include "fovea/io/gltf_buffer_write.h"

#include <meshoptimizer.h>

#include <algorithm>
#include <cstring>
#include <string_view>

#include "fovea/base/error.h"

namespace fovea::gltf {

namespace {

constexpr std::size_t kAlignment = 4;

std::size_t aligned(std::size_t size) { return (size + kAlignment - 1) / kAlignment * kAlignment; }

std::uint64_t hash(const std::byte* data, std::size_t size) {
  return std::hash<std::string_view>{}({reinterpret_cast<const char*>(data), size});
}

std::size_t element_size(const Accessor& a) {
  return static_cast<std::size_t>(a.width) * size_of(a.storage.type);
}

/// Columns of matrices begin at multiples of four bytes (glTF 2.0, 3.6.2.4).
Bytes with_padded_columns(const Accessor& a) {
  const std::size_t rows = a.width == 4 ? 2 : a.width == 9 ? 3 : 4;
  const std::size_t column = rows * size_of(a.storage.type);
  if (!a.matrix || column % kAlignment == 0) return a.bytes;
  const std::size_t columns = a.bytes.size() / column;
  Bytes padded(columns * aligned(column));
  for (std::size_t i = 0; i < columns; ++i) {
    std::memcpy(padded.data() + i * aligned(column), a.bytes.data() + i * column, column);
  }
  return padded;
}

Json accessor_json(const Accessor& a) {
  Json json = {{"componentType", static_cast<int>(a.storage.type)}};
  if (a.storage.normalized) json["normalized"] = true;
  json["count"] = a.count;
  json["type"] = type_name(a.width, a.matrix);
  return json;
}

Json sparse_json(const ViewAccessor::Sparse& sparse) {
  Json json = {{"count", sparse.count}};
  json["indices"] = {{"bufferView", sparse.index_view},
                     {"componentType", static_cast<int>(sparse.index_type)}};
  json["values"]["bufferView"] = sparse.value_view;
  return json;
}

/// Smallest and largest stored number of every component.
void set_bounds(Json& json, const Accessor& a) {
  Accessor raw = a;
  raw.storage.normalized = false;
  const std::vector<float> values = raw.to_floats();
  const std::size_t width = static_cast<std::size_t>(a.width);
  if (values.size() < width) return;
  std::vector<double> low(values.begin(), values.begin() + a.width), high = low;
  for (std::size_t i = 0; i < values.size(); ++i) {
    low[i % width] = std::min(low[i % width], static_cast<double>(values[i]));
    high[i % width] = std::max(high[i % width], static_cast<double>(values[i]));
  }
  json["min"] = numbers(low);
  json["max"] = numbers(high);
}

Bytes encode_vertices(const View& view) {
  Bytes out(meshopt_encodeVertexBufferBound(view.count, view.stride));
  out.resize(meshopt_encodeVertexBuffer(reinterpret_cast<unsigned char*>(out.data()), out.size(),
                                        view.bytes.data(), view.count, view.stride));
  return out;
}

Bytes encode_triangles(const View& view) {
  std::vector<unsigned int> indices(view.count);
  unsigned int last = 0;
  for (std::size_t i = 0; i < view.count; ++i) {
    std::memcpy(&indices[i], view.bytes.data() + i * view.stride, view.stride);
    last = std::max(last, indices[i]);
  }
  Bytes out(meshopt_encodeIndexBufferBound(indices.size(), std::size_t{last} + 1));
  out.resize(meshopt_encodeIndexBuffer(reinterpret_cast<unsigned char*>(out.data()), out.size(),
                                       indices.data(), indices.size()));
  return out;
}

std::uint64_t& count_of(ByteCounts& counts, ByteKind kind) {
  switch (kind) {
    case ByteKind::geometry: return counts.geometry;
    case ByteKind::images: return counts.images;
    case ByteKind::animation: return counts.animation;
    case ByteKind::other: break;
  }
  return counts.other;
}

}  // namespace

const char* type_name(int width, bool matrix) {
  switch (width) {
    case 1: return "SCALAR";
    case 2: return "VEC2";
    case 3: return "VEC3";
    case 4: return matrix ? "MAT2" : "VEC4";
    case 9: return "MAT3";
    case 16: return "MAT4";
    default: throw Error(ErrorKind::internal, "an accessor has a number of components that glTF lacks");
  }
}

int BufferWriter::place_view(Json view, const Bytes& data, ByteKind kind, std::size_t fallback) {
  bytes.resize(aligned(bytes.size()));
  const std::size_t offset = bytes.size();
  bytes.insert(bytes.end(), data.begin(), data.end());
  count_of(counts, kind) += data.size();
  Json& stored = fallback > 0 ? view["extensions"]["EXT_meshopt_compression"] : view;
  stored["buffer"] = 0;
  stored["byteOffset"] = offset;
  stored["byteLength"] = data.size();
  if (fallback > 0) {
    view["byteOffset"] = fallback_bytes;
    fallback_bytes = aligned(fallback_bytes + fallback);
  }
  views.push_back(std::move(view));
  return static_cast<int>(views.size()) - 1;
}

int BufferWriter::add_own_view(const Bytes& data) {
  return place_view(Json::object(), data, ByteKind::other, 0);
}

int BufferWriter::add_view(View view, ByteKind kind) {
  Json json = {{"buffer", 0}, {"byteOffset", 0}, {"byteLength", view.bytes.size()}};
  if (view.target == ViewTarget::vertices) json["byteStride"] = view.stride;
  if (view.target != ViewTarget::none) json["target"] = static_cast<int>(view.target);
  const std::uint64_t key = hash(view.bytes.data(), view.bytes.size());
  const auto [begin, end] = view_of_content_.equal_range(key);
  for (auto it = begin; it != end; ++it) {
    const Json& known = views[static_cast<std::size_t>(it->second)];
    json["byteOffset"] = known["byteOffset"];
    if (known == json && std::equal(view.bytes.begin(), view.bytes.end(),
                                    bytes.begin() + known["byteOffset"].get<std::ptrdiff_t>())) {
      return it->second;
    }
  }
  const int index = place_view(std::move(json), view.bytes, kind, 0);
  view_of_content_.emplace(key, index);
  return index;
}

int BufferWriter::add_geometry(View view) {
  return compression_ == GeometryCompression::meshopt ? add_compressed(view)
                                                      : add_view(std::move(view), ByteKind::geometry);
}

int BufferWriter::add_compressed(const View& view) {
  const bool triangles = view.target == ViewTarget::indices;
  const Bytes packed = triangles ? encode_triangles(view) : encode_vertices(view);
  Json extension = {{"buffer", 0},
                    {"byteOffset", 0},
                    {"byteLength", packed.size()},
                    {"byteStride", view.stride},
                    {"count", view.count},
                    {"mode", triangles ? "TRIANGLES" : "ATTRIBUTES"}};
  const std::uint64_t key = hash(packed.data(), packed.size());
  const auto [begin, end] = view_of_content_.equal_range(key);
  for (auto it = begin; it != end; ++it) {
    const Json* known =
        find_extension(views[static_cast<std::size_t>(it->second)], "EXT_meshopt_compression");
    if (!known) continue;
    extension["byteOffset"] = (*known)["byteOffset"];
    // The coders are functions of their input, so that equal output means equal input.
    if (*known == extension && std::equal(packed.begin(), packed.end(),
                                          bytes.begin() + (*known)["byteOffset"].get<std::ptrdiff_t>())) {
      return it->second;
    }
  }
  Json json = {{"buffer", 1}, {"byteOffset", 0}, {"byteLength", view.bytes.size()}};
  if (!triangles) json["byteStride"] = view.stride;
  json["target"] = static_cast<int>(view.target);
  json["extensions"]["EXT_meshopt_compression"] = std::move(extension);
  const int index = place_view(std::move(json), packed, ByteKind::geometry, view.bytes.size());
  view_of_content_.emplace(key, index);
  return index;
}

int BufferWriter::add_accessor_json(Json accessor) {
  const auto [at, is_new] =
      accessor_of_text_.try_emplace(to_text(accessor), static_cast<int>(accessors.size()));
  if (is_new) accessors.push_back(std::move(accessor));
  return at->second;
}

int BufferWriter::add_accessor(const ViewAccessor& a) {
  Json json = Json::object();
  if (a.view >= 0) json["bufferView"] = a.view;
  if (a.offset > 0) json["byteOffset"] = a.offset;
  json["componentType"] = static_cast<int>(a.storage.type);
  if (a.storage.normalized) json["normalized"] = true;
  json["count"] = a.count;
  json["type"] = type_name(a.width, a.matrix);
  if (!a.low.empty()) json["min"] = numbers(a.low);
  if (!a.high.empty()) json["max"] = numbers(a.high);
  if (a.sparse) json["sparse"] = sparse_json(*a.sparse);
  return add_accessor_json(std::move(json));
}

int BufferWriter::add_own_accessor(const Accessor& a) {
  Json json = accessor_json(a);
  if (!a.bytes.empty()) json["bufferView"] = add_own_view(with_padded_columns(a));
  accessors.push_back(std::move(json));
  return static_cast<int>(accessors.size()) - 1;
}

int BufferWriter::add_plain(const Accessor& a, ViewTarget target, bool with_bounds) {
  const std::size_t element = element_size(a);
  const std::size_t stride = target == ViewTarget::vertices ? aligned(element) : element;
  View view{a.bytes, target, stride, a.count};
  if (stride != element) {
    view.bytes.assign(a.count * stride, std::byte{0});
    for (std::size_t i = 0; i < a.count; ++i) {
      std::memcpy(view.bytes.data() + i * stride, a.bytes.data() + i * element, element);
    }
  }
  Json json = accessor_json(a);
  json["bufferView"] = add_view(std::move(view), ByteKind::other);
  if (with_bounds) set_bounds(json, a);
  return add_accessor_json(std::move(json));
}

std::size_t BufferWriter::pack(Packed& packed, const Bytes& data) {
  const std::uint64_t key = hash(data.data(), data.size());
  const auto [begin, end] = packed.places.equal_range(key);
  for (auto it = begin; it != end; ++it) {
    const auto [offset, size] = it->second;
    if (size == data.size() && std::memcmp(packed.bytes.data() + offset, data.data(), size) == 0)
      return offset;
  }
  packed.bytes.resize(aligned(packed.bytes.size()));
  const std::size_t offset = packed.bytes.size();
  packed.bytes.insert(packed.bytes.end(), data.begin(), data.end());
  packed.places.emplace(key, std::pair{offset, data.size()});
  return offset;
}

int BufferWriter::add_packed(const Accessor& a, PackedUse use, bool with_bounds) {
  Packed& packed = packed_[use];
  if (packed.view < 0) {
    packed.view = static_cast<int>(views.size());
    views.push_back(Json::object());
    views.back()["buffer"] = 0;
  }
  const std::size_t offset = pack(packed, with_padded_columns(a));
  Json json = accessor_json(a);
  json["bufferView"] = packed.view;
  if (offset > 0) json["byteOffset"] = offset;
  if (with_bounds) set_bounds(json, a);
  return add_accessor_json(std::move(json));
}

void BufferWriter::finish() {
  for (auto& [use, packed] : packed_) {
    bytes.resize(aligned(bytes.size()));
    Json& view = views[static_cast<std::size_t>(packed.view)];
    view["byteOffset"] = bytes.size();
    view["byteLength"] = packed.bytes.size();
    bytes.insert(bytes.end(), packed.bytes.begin(), packed.bytes.end());
    count_of(counts, use == PackedUse::instances ? ByteKind::other : ByteKind::animation) +=
        packed.bytes.size();
  }
  bytes.resize(aligned(bytes.size()));
}

}  // namespace fovea::gltf
