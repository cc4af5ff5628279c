#include "fovea/io/field_file.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstring>
#include <iterator>
#include <limits>
#include <set>

#include "fovea/base/error.h"
#include "fovea/base/text.h"
#include "fovea/io/extension.h"
#include "fovea/io/read.h"
#include "fovea/io/text_scan.h"
#include "fovea/io/write.h"
#include "fovea/model/check_fields.h"

namespace fovea {

namespace {

constexpr std::string_view kMagic = "\x93NUMPY";
static_assert(std::endian::native == std::endian::little);

bool is_npy(std::span<const std::byte> bytes) { return as_text(bytes).starts_with(kMagic); }

/// The header's text, and where the data begins.
struct NpyHeader {
  std::string_view text;
  std::size_t data = 0;
};

NpyHeader find_header(std::span<const std::byte> bytes, const std::string& place) {
  if (!is_npy(bytes)) throw Error(ErrorKind::format, "this is no .npy file", place + ": byte 0");
  const int version = bytes.size() > 6 ? std::to_integer<int>(bytes[6]) : 0;
  if (version < 1 || version > 3) {
    throw Error(ErrorKind::unsupported, fmt::format(".npy version {} is not known", version),
                place + ": byte 6");
  }
  const std::size_t width = version == 1 ? 2 : 4, begin = 8 + width;
  std::uint64_t length = 0;
  if (bytes.size() >= begin) std::memcpy(&length, bytes.data() + 8, width);
  if (bytes.size() < begin || length > bytes.size() - begin) {
    throw Error(ErrorKind::format, "the header is longer than the file", place + ": byte 8");
  }
  return {as_text(bytes).substr(begin, length), begin + static_cast<std::size_t>(length)};
}

/// What follows "'key':" in the header, which is a Python dictionary with known keys.
std::string_view value_of(std::string_view header, std::string_view key, const std::string& place) {
  for (const char quote : {'\'', '"'}) {
    const std::string quoted = quote + std::string(key) + quote;
    const std::size_t at = header.find(quoted);
    if (at == header.npos) continue;
    const std::size_t colon = header.find_first_not_of(' ', at + quoted.size());
    if (colon == header.npos || header[colon] != ':') continue;
    const std::size_t value = header.find_first_not_of(' ', colon + 1);
    if (value != header.npos) return header.substr(value);
  }
  throw Error(ErrorKind::format, fmt::format("the header has no \"{}\"", key), place + ": header");
}

std::string read_type(std::string_view header, const std::string& place) {
  const std::string_view value = value_of(header, "descr", place);
  const std::size_t end = value.size() > 1 ? value.find(value[0], 1) : value.npos;
  if ((value[0] != '\'' && value[0] != '"') || end == value.npos) {
    throw Error(ErrorKind::unsupported, "the elements are records, not numbers", place + ": header");
  }
  return std::string(value.substr(1, end - 1));
}

/// Number of values of a list: shape (n,), (n, 1), (1, n) or (). Their order is the same in C and Fortran.
std::uint64_t read_count(std::string_view header, const std::string& place) {
  const std::string_view value = value_of(header, "shape", place);
  const std::size_t end = value.find(')');
  if (value[0] != '(' || end == value.npos)
    throw Error(ErrorKind::format, "the shape is damaged", place + ": header");
  std::uint64_t count = 1;
  int long_sides = 0;
  for (const char *at = value.data() + 1, *stop = value.data() + end; at != stop;) {
    if (*at == ' ' || *at == ',' || *at == 'L') {
      ++at;
      continue;
    }
    std::uint64_t side = 0;
    const auto [next, error] = std::from_chars(at, stop, side);
    if (error != std::errc()) throw Error(ErrorKind::format, "the shape is damaged", place + ": header");
    at = next;
    if (side == 1) continue;
    count = side;
    ++long_sides;
  }
  if (long_sides > 1) {
    throw Error(ErrorKind::unsupported,
                fmt::format("the array has shape {}, not that of a list", value.substr(0, end + 1)),
                place + ": header", "save one number per vertex");
  }
  return count;
}

template <class T>
std::vector<float> convert(std::span<const std::byte> data, std::uint64_t count) {
  std::vector<float> values(static_cast<std::size_t>(count));
  for (std::size_t i = 0; i < values.size(); ++i) {
    T value;
    std::memcpy(&value, data.data() + i * sizeof(T), sizeof(T));
    values[i] = static_cast<float>(value);
  }
  return values;
}

struct NpyType {
  std::string_view name;
  std::size_t size;
  std::vector<float> (*convert)(std::span<const std::byte>, std::uint64_t);
};
constexpr NpyType kNpyTypes[] = {
    {"f4", 4, convert<float>},         {"f8", 8, convert<double>},       {"i1", 1, convert<std::int8_t>},
    {"u1", 1, convert<std::uint8_t>},  {"b1", 1, convert<std::uint8_t>}, {"i2", 2, convert<std::int16_t>},
    {"u2", 2, convert<std::uint16_t>}, {"i4", 4, convert<std::int32_t>}, {"u4", 4, convert<std::uint32_t>},
    {"i8", 8, convert<std::int64_t>},  {"u8", 8, convert<std::uint64_t>}};

const NpyType& find_type(const std::string& name, const std::string& place) {
  const bool big_endian = name.starts_with('>') && !name.ends_with('1');
  for (const NpyType& type : kNpyTypes) {
    if (!big_endian && name.size() == 3 && name.substr(1) == type.name) return type;
  }
  throw Error(ErrorKind::unsupported, fmt::format("numbers of type \"{}\" are not known", name.substr(0, 32)),
              place + ": header", "save little-endian floats or integers");
}

std::string_view last_column(std::string_view line) {
  const std::size_t end = line.find_last_not_of(" \t,;");
  if (end == line.npos) return {};
  line = line.substr(0, end + 1);
  const std::size_t begin = line.find_last_of(" \t,;");
  return begin == line.npos ? line : line.substr(begin + 1);
}

std::vector<float> parse_text(std::span<const std::byte> bytes, const std::string& place) {
  std::vector<float> values;
  bool first = true;
  for (TextScanner scan(bytes); !scan.at_end(); scan.next_line()) {
    if (scan.line_done()) continue;
    const std::size_t line = scan.line();
    const std::string_view word = last_column(scan.rest());
    TextScanner number({reinterpret_cast<const std::byte*>(word.data()), word.size()});
    float value = 0;
    const bool good = number.number(value) && number.at_end();
    if (!good && !first)
      throw Error(ErrorKind::format, "this is not a number", fmt::format("{}: line {}", place, line));
    if (good) values.push_back(value);
    first = false;
  }
  return values;
}

/// Reads values in the order of the source or of the vertices and keeps the largest for each vertex.
class SourceOrder {
 public:
  explicit SourceOrder(const Model& model) : model_(model) {
    for (const Mesh& mesh : model.meshes) {
      vertices_ += mesh.surface.vertex_count();
      sources_ += size_of(mesh.surface);
    }
  }

  std::vector<VertexField> map(std::span<const float> values) const {
    check_size(values.size());
    const bool by_source = values.size() == sources_;
    std::vector<VertexField> fields;
    std::size_t at = 0;
    for (const Mesh& mesh : model_.meshes) {
      const std::size_t count = by_source ? size_of(mesh.surface) : mesh.surface.vertex_count();
      const bool welded = by_source && !mesh.surface.source_vertex.empty();
      const auto part = values.subspan(at, count);
      fields.push_back(welded ? largest(mesh.surface, part)
                              : VertexField(std::vector<float>(part.begin(), part.end())));
      at += count;
    }
    return fields;
  }

 private:
  /// A mesh that came from no file is its own source.
  static std::size_t size_of(const TriMesh& mesh) {
    return mesh.source_vertex.empty() ? mesh.vertex_count() : mesh.source_vertex.size();
  }

  void check_size(std::size_t count) const {
    if (count == sources_ || count == vertices_) return;
    throw Error(ErrorKind::format,
                fmt::format("the field has {} values but the model has {} source vertices ({} after welding)",
                            count, sources_, vertices_),
                {}, "give one value per vertex in the order of the model's file");
  }

  static VertexField largest(const TriMesh& mesh, std::span<const float> values) {
    constexpr float kNone = -std::numeric_limits<float>::infinity();
    VertexField field(mesh.vertex_count(), kNone);
    for (std::size_t s = 0; s < values.size(); ++s) {
      const VertexId v = mesh.source_vertex[s];
      if (v.valid()) field[v] = std::max(field[v], values[s]);
    }
    for (float& x : field.values()) x = x == kNone ? 1.0f : x;
    return field;
  }

  const Model& model_;
  std::size_t sources_ = 0, vertices_ = 0;
};

bool is_npy_name(const std::filesystem::path& path) { return lower_extension(path) == ".npy"; }

std::string name_of(const AttributeLayer& layer) {
  if (layer.semantic == Semantic::custom) return layer.name;
  return layer.semantic == Semantic::color ? fmt::format("COLOR_{}", layer.set) : "";
}

float value_of(const AttributeLayer& layer, ValueId id) {
  const float* x = layer.value(id);
  return layer.semantic == Semantic::color && layer.width >= 3 ? (x[0] + x[1] + x[2]) / 3 : x[0];
}

VertexField mean_over_values(const TriMesh& mesh, const AttributeLayer& layer) {
  std::vector<bool> counted(layer.size(), false);
  std::vector<double> sum(mesh.vertex_count(), 0);
  std::vector<std::uint32_t> count(mesh.vertex_count(), 0);
  for (std::size_t c = 0; c < layer.corner_value.size(); ++c) {
    const ValueId id = layer.corner_value[c];
    if (!id.valid() || counted[id.index()]) continue;
    counted[id.index()] = true;
    const std::size_t v = mesh.vertex(CornerId{c}).index();
    sum[v] += static_cast<double>(value_of(layer, id));
    ++count[v];
  }
  VertexField field(mesh.vertex_count(), 1.0f);
  for (std::size_t v = 0; v < sum.size(); ++v) {
    if (count[v] > 0) field[VertexId{v}] = static_cast<float>(sum[v] / count[v]);
  }
  return field;
}

}  // namespace

std::vector<float> parse_npy(std::span<const std::byte> bytes, const std::string& place) {
  const NpyHeader header = find_header(bytes, place);
  const NpyType& type = find_type(read_type(header.text, place), place);
  const std::uint64_t count = read_count(header.text, place);
  const auto data = bytes.subspan(header.data);
  if (count > data.size() / type.size) {
    throw Error(ErrorKind::format,
                fmt::format("{} numbers of {} bytes do not fit the {} bytes that follow", count, type.size,
                            data.size()),
                fmt::format("{}: byte {}", place, header.data));
  }
  return type.convert(data, count);
}

std::vector<float> read_npy(const std::filesystem::path& path, std::int64_t max_bytes) {
  return parse_npy(read_file(path, max_bytes), path.string());
}

std::vector<float> read_field(const std::filesystem::path& path, std::int64_t max_bytes) {
  const std::vector<std::byte> bytes = read_file(path, max_bytes);
  return is_npy(bytes) ? parse_npy(bytes, path.string()) : parse_text(bytes, path.string());
}

std::vector<std::byte> encode_npy(std::span<const float> values) {
  std::string header =
      fmt::format("{{'descr': '<f4', 'fortran_order': False, 'shape': ({},), }}", values.size());
  // The data begins at a multiple of 64; the header ends in a line end.
  header.append(64 - (10 + header.size() + 1) % 64, ' ');
  header += '\n';
  std::string text(kMagic);
  text += {'\x01', '\x00', static_cast<char>(header.size() & 0xFF), static_cast<char>(header.size() >> 8)};
  text += header;
  std::vector<std::byte> bytes(text.size() + values.size_bytes());
  std::memcpy(bytes.data(), text.data(), text.size());
  if (!values.empty()) std::memcpy(bytes.data() + text.size(), values.data(), values.size_bytes());
  return bytes;
}

void write_npy(const std::filesystem::path& path, std::span<const float> values, bool force) {
  const OutputFile file{"", encode_npy(values)};
  write_files(path, {&file, 1}, force);
}

void check_field_output(const std::filesystem::path& path, bool force) {
  check_extension(path, "fields", {".npy", ".csv", ".txt"});
  check_place(path, force);
}

void write_field(const std::filesystem::path& path, std::span<const float> values, const std::string& name,
                 bool force) {
  check_field_output(path, force);
  if (is_npy_name(path)) return write_npy(path, values, force);
  fmt::memory_buffer text;
  fmt::format_to(std::back_inserter(text), "{}\n", name);
  // The shortest digits that read back as the same float.
  for (const float x : values) fmt::format_to(std::back_inserter(text), "{}\n", x);
  write_text(path, {text.data(), text.size()}, force);
}

std::vector<float> field_in_source_order(const Model& model, std::span<const VertexField> fields) {
  check_fields(model, fields);
  std::vector<float> values;
  for (std::size_t m = 0; m < model.meshes.size(); ++m) {
    const TriMesh& mesh = model.meshes[m].surface;
    const std::span<const float> own = fields[m].values();
    if (mesh.source_vertex.empty()) values.insert(values.end(), own.begin(), own.end());
    for (const VertexId v : mesh.source_vertex) values.push_back(v.valid() ? own[v.index()] : 0.0f);
  }
  return values;
}

std::vector<VertexField> field_from_source_order(const Model& model, std::span<const float> values) {
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (std::isnan(values[i]) || values[i] == -std::numeric_limits<float>::infinity())
      throw Error(ErrorKind::format, fmt::format("value {} of the field is {}", i, values[i]));
  }
  return SourceOrder(model).map(values);
}

std::vector<VertexField> field_from_attribute(const Model& model, const std::string& name) {
  std::vector<VertexField> fields;
  std::set<std::string> present;
  bool found = false;
  for (const Mesh& mesh : model.meshes) {
    fields.emplace_back(mesh.surface.vertex_count(), 1.0f);
    bool here = false;
    for (const AttributeLayer& layer : mesh.surface.layers) {
      const std::string own = name_of(layer);
      if (!own.empty()) present.insert(own);
      if (here || own.empty() || (own != name && own != "_" + name)) continue;
      fields.back() = mean_over_values(mesh.surface, layer);
      here = true;
    }
    found = found || here;
  }
  if (found) return fields;
  throw Error(ErrorKind::unsupported, fmt::format("no mesh has a vertex attribute \"{}\"", name), {},
              present.empty() ? "the model has no custom attributes and no vertex colours"
                              : fmt::format("there are: {}", fmt::join(present, ", ")));
}

}  // namespace fovea
