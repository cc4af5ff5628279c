#include "fovea/io/gltf_accessor_read.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <filesystem>
#include <system_error>

#include "fovea/base/error.h"
#include "fovea/io/meshopt_decode.h"
#include "fovea/io/side_files.h"
#include "fovea/io/uri.h"

namespace fovea::gltf {

namespace {

struct TypeName {
  const char* name;
  int width;
  bool matrix;
};
constexpr TypeName kTypes[] = {{"SCALAR", 1, false}, {"VEC2", 2, false}, {"VEC3", 3, false},
                               {"VEC4", 4, false},   {"MAT2", 4, true},  {"MAT3", 9, true},
                               {"MAT4", 16, true}};

ComponentType component_type(const JsonView& value) {
  switch (const std::int64_t number = value.integer(0, 0xFFFF)) {
    case 5120:
    case 5121:
    case 5122:
    case 5123:
    case 5125:
    case 5126: return static_cast<ComponentType>(number);
    default: value.fail(fmt::format("{} is not a component type", number));
  }
}

/// Where the parts of an element lie in a file: the columns of a matrix begin at multiples of 4 bytes.
struct ElementLayout {
  std::size_t columns = 1;
  std::size_t column_bytes = 0;
  std::size_t column_stride = 0;

  explicit ElementLayout(const AccessorShape& shape) {
    const auto width = static_cast<std::size_t>(shape.width);
    columns = !shape.matrix ? 1 : width == 4 ? 2 : width == 9 ? 3 : 4;
    column_bytes = width / columns * size_of(shape.storage.type);
    column_stride = shape.matrix ? (column_bytes + 3) / 4 * 4 : column_bytes;
  }
  std::size_t packed_bytes() const { return columns * column_bytes; }
  std::size_t stride() const { return columns * column_stride; }
  /// From the first to the last byte that is used.
  std::size_t extent() const { return (columns - 1) * column_stride + column_bytes; }

  void copy(const std::byte* from, std::byte* to) const {
    for (std::size_t c = 0; c < columns; ++c) {
      std::memcpy(to + c * column_bytes, from + c * column_stride, column_bytes);
    }
  }
};

/// Elements at a fixed distance from each other, inside of a view.
struct Elements {
  const std::byte* first = nullptr;
  std::size_t stride = 0;
};

/// Checks that `count` elements fit, by division: products of what a file says may overflow.
Elements elements_in(std::span<const std::byte> view, std::uint64_t offset, std::uint64_t stride,
                     std::uint64_t extent, std::uint64_t count, const JsonView& at) {
  if (count == 0) return {view.data(), static_cast<std::size_t>(stride)};
  if (stride < extent) at.fail(fmt::format("elements of {} bytes do not fit a stride of {}", extent, stride));
  const std::uint64_t size = view.size();
  if (offset > size || extent > size - offset || count - 1 > (size - offset - extent) / stride) {
    at.fail(fmt::format("{} elements of {} bytes from byte {} do not fit the buffer view's {} bytes", count,
                        stride, offset, size));
  }
  return {view.data() + offset, static_cast<std::size_t>(stride)};
}

/// Runs `f`; an error without a place gets that of `at`.
template <class F>
auto at_place(const JsonView& at, F&& f) {
  try {
    return f();
  } catch (const Error& e) {
    throw e.place().empty() ? e.within(at.place()) : e;
  }
}

}  // namespace

DataReader::DataReader(const JsonView& root, std::optional<std::span<const std::byte>> binary,
                       std::filesystem::path folder, const ReadOptions& options, ByteBudget& budget)
    : buffers_(root.elements("buffers")),
      views_(root.elements("bufferViews")),
      accessors_(root.elements("accessors")),
      binary_(binary),
      folder_(std::move(folder)),
      options_(options),
      budget_(budget) {}

AccessorShape DataReader::shape(int accessor) const {
  const JsonView& json = accessors_[static_cast<std::size_t>(accessor)];
  AccessorShape shape;
  shape.storage.type = component_type(json.at("componentType"));
  shape.storage.normalized = json.boolean("normalized", false) && shape.storage.type != ComponentType::f32;
  const JsonView type = json.at("type");
  const auto* known = std::find_if(std::begin(kTypes), std::end(kTypes),
                                   [&](const TypeName& t) { return type.text() == t.name; });
  if (known == std::end(kTypes)) type.fail(shown(type.text()) + " is not an accessor type");
  shape.width = known->width;
  shape.matrix = known->matrix;
  const std::uint64_t count = json.at("count").size();
  if (options_.max_elements < 0 || count > static_cast<std::uint64_t>(options_.max_elements)) {
    throw Error(ErrorKind::limit,
                fmt::format("{} elements are more than the limit of {}", count, options_.max_elements),
                json.at("count").place(), "raise --max-elements if the file is to be trusted");
  }
  shape.count = static_cast<std::size_t>(count);
  return shape;
}

Accessor DataReader::read(int accessor) {
  const JsonView& json = accessors_[static_cast<std::size_t>(accessor)];
  const AccessorShape shape = this->shape(accessor);
  Accessor result;
  result.storage = shape.storage;
  result.width = shape.width;
  result.matrix = shape.matrix;
  result.count = shape.count;
  read_dense(accessor, shape, result.bytes);
  if (const auto sparse = json.find("sparse")) read_sparse(*sparse, shape, result.bytes);
  return result;
}

void DataReader::read_dense(int accessor, const AccessorShape& shape, std::vector<std::byte>& bytes) {
  const JsonView& json = accessors_[static_cast<std::size_t>(accessor)];
  const ElementLayout layout(shape);
  Elements elements;
  if (const auto reference = json.find("bufferView")) {
    const int index = view_index(*reference);
    const JsonView& view_json = views_[static_cast<std::size_t>(index)];
    const auto stride = view_json.find("byteStride");
    const std::uint64_t step =
        stride ? static_cast<std::uint64_t>(stride->integer(1, 0xFFFF)) : layout.stride();
    elements = elements_in(view(index), json.size("byteOffset", 0), step, layout.extent(), shape.count, json);
  }
  budget_.charge(shape.count, layout.packed_bytes(), json.place());
  bytes.resize(shape.byte_size());
  if (bytes.empty() || !elements.first) return;
  if (elements.stride == layout.packed_bytes()) {
    std::memcpy(bytes.data(), elements.first, bytes.size());
    return;
  }
  for (std::size_t i = 0; i < shape.count; ++i) {
    layout.copy(elements.first + i * elements.stride, bytes.data() + i * layout.packed_bytes());
  }
}

void DataReader::read_sparse(const JsonView& sparse, const AccessorShape& shape,
                             std::vector<std::byte>& bytes) {
  const std::uint64_t count = sparse.at("count").size();
  if (count > shape.count) sparse.at("count").fail(fmt::format("{} of only {} elements", count, shape.count));
  const JsonView indices = sparse.at("indices");
  const JsonView values = sparse.at("values");
  const ComponentType type = component_type(indices.at("componentType"));
  if (type != ComponentType::u8 && type != ComponentType::u16 && type != ComponentType::u32) {
    indices.at("componentType").fail("indices are unsigned integers");
  }
  const ElementLayout layout(shape);
  const Elements from = elements_in(view(view_index(values.at("bufferView"))), values.size("byteOffset", 0),
                                    layout.stride(), layout.extent(), count, values);
  const Elements to = elements_in(view(view_index(indices.at("bufferView"))), indices.size("byteOffset", 0),
                                  size_of(type), size_of(type), count, indices);
  for (std::size_t i = 0; i < count; ++i) {
    std::uint32_t index = 0;
    std::memcpy(&index, to.first + i * to.stride, size_of(type));
    if (index >= shape.count) indices.fail(fmt::format("index {} of only {} elements", index, shape.count));
    layout.copy(from.first + i * from.stride, bytes.data() + index * layout.packed_bytes());
  }
}

std::span<const std::byte> DataReader::view(int view) {
  const JsonView& json = views_[static_cast<std::size_t>(view)];
  for (const char* name : {"EXT_meshopt_compression", "KHR_meshopt_compression"}) {
    if (const auto extension = json.extension(name)) return compressed_view(view, *extension);
  }
  const int buffer = json.at("buffer").index(buffers_.size(), "buffers");
  return range(buffer, json.size("byteOffset", 0), json.at("byteLength").size(), json);
}

std::span<const std::byte> DataReader::range(int buffer, std::uint64_t offset, std::uint64_t length,
                                             const JsonView& at) {
  const auto bytes = this->buffer(buffer);
  if (offset > bytes.size() || length > bytes.size() - offset) {
    at.fail(fmt::format("{} bytes from byte {} do not fit the {} bytes of buffer {}", length, offset,
                        bytes.size(), buffer));
  }
  return bytes.subspan(static_cast<std::size_t>(offset), static_cast<std::size_t>(length));
}

std::span<const std::byte> DataReader::compressed_view(int view, const JsonView& extension) {
  const auto known = decoded_views_.find(view);
  if (known != decoded_views_.end()) return known->second;
  MeshoptStream stream;
  stream.bytes = range(extension.at("buffer").index(buffers_.size(), "buffers"),
                       extension.size("byteOffset", 0), extension.at("byteLength").size(), extension);
  stream.count = static_cast<std::size_t>(extension.at("count").size());
  stream.stride = static_cast<std::size_t>(extension.at("byteStride").size());
  stream.mode = extension.at("mode").text();
  stream.filter = extension.has("filter") ? extension.text("filter") : "NONE";
  auto bytes = at_place(extension, [&] {
    check_meshopt(stream);
    budget_.charge(stream.count, stream.stride, extension.place());
    return decode_meshopt(stream);
  });
  return decoded_views_.emplace(view, std::move(bytes)).first->second;
}

std::span<const std::byte> DataReader::buffer(int buffer) {
  const JsonView& json = buffers_[static_cast<std::size_t>(buffer)];
  const std::uint64_t length = json.at("byteLength").size();
  std::span<const std::byte> bytes;
  if (const auto uri = json.find("uri")) {
    auto known = loaded_buffers_.find(buffer);
    if (known == loaded_buffers_.end()) known = loaded_buffers_.emplace(buffer, load_uri(*uri)).first;
    bytes = known->second;
  } else if (buffer == 0 && binary_) {
    bytes = *binary_;
  } else {
    json.fail("the buffer has neither a uri nor a BIN chunk");
  }
  if (length > bytes.size()) {
    json.at("byteLength")
        .fail(fmt::format("{} bytes are promised but only {} are there", length, bytes.size()));
  }
  return bytes.first(static_cast<std::size_t>(length));
}

std::vector<std::byte> DataReader::load_uri(const JsonView& uri) {
  const std::string& text = uri.text();
  if (is_data_uri(text)) {
    budget_.charge(text.size(), 1, uri.place());
    return at_place(uri, [&] { return decode_data_uri(text).bytes; });
  }
  return side_file(at_place(uri, [&] { return relative_path_of_uri(text); }), uri);
}

std::vector<std::byte> DataReader::side_file(const std::string& relative_path, const JsonView& at) {
  const auto file = find_inside(folder_, relative_path);
  if (!file) {
    throw Error(ErrorKind::input,
                fmt::format("the file {} is not in the model's folder", shown(relative_path)), at.place());
  }
  std::error_code vanished;
  const std::uint64_t size = std::filesystem::file_size(*file, vanished);
  if (vanished) throw Error(ErrorKind::input, vanished.message(), file->string());
  if (side_files_.insert(*file).second) budget_.add_input(size);
  budget_.charge(size, 1, at.place());
  return read_file(*file, options_.max_file_bytes);
}

std::vector<std::uint32_t> to_indices(const Accessor& accessor) {
  std::vector<std::uint32_t> indices(accessor.count * static_cast<std::size_t>(accessor.width));
  if (indices.empty()) return indices;
  const std::size_t size = size_of(accessor.storage.type);
  if (size == sizeof(std::uint32_t)) {
    std::memcpy(indices.data(), accessor.bytes.data(), accessor.bytes.size());
    return indices;
  }
  for (std::size_t i = 0; i < indices.size(); ++i)
    std::memcpy(&indices[i], accessor.bytes.data() + i * size, size);
  return indices;
}

}  // namespace fovea::gltf
