#include "fovea/io/ply_header.h"

#include <fmt/format.h>

#include <array>
#include <optional>

#include "fovea/base/error.h"
#include "fovea/io/text_scan.h"

namespace fovea {

namespace {

struct TypeName {
  std::string_view name;
  PlyType type;
};
constexpr std::array<TypeName, 16> kTypeNames = {{{"char", PlyType::i8},
                                                  {"int8", PlyType::i8},
                                                  {"uchar", PlyType::u8},
                                                  {"uint8", PlyType::u8},
                                                  {"short", PlyType::i16},
                                                  {"int16", PlyType::i16},
                                                  {"ushort", PlyType::u16},
                                                  {"uint16", PlyType::u16},
                                                  {"int", PlyType::i32},
                                                  {"int32", PlyType::i32},
                                                  {"uint", PlyType::u32},
                                                  {"uint32", PlyType::u32},
                                                  {"float", PlyType::f32},
                                                  {"float32", PlyType::f32},
                                                  {"double", PlyType::f64},
                                                  {"float64", PlyType::f64}}};

constexpr std::size_t kMaxProperties = 1000;  // of the whole file; more is no mesh

class HeaderParser {
 public:
  HeaderParser(std::span<const std::byte> bytes, const std::string& place)
      : bytes_(bytes), scan_(bytes), place_(place) {}

  PlyHeader run() {
    if (scan_.word() != "ply") refuse("the file does not begin with \"ply\"");
    scan_.next_line();
    while (read_line()) scan_.next_line();
    skip_last_line_end();
    if (!has_format_) refuse("the header has no format");
    check_sizes();
    return std::move(header_);
  }

 private:
  bool read_line();
  void read_format();
  void read_comment();
  void read_element();
  void read_property();
  PlyType read_type();
  void skip_last_line_end();
  void check_sizes() const;
  [[noreturn]] void refuse(const std::string& message) const {
    throw Error(ErrorKind::format, message, fmt::format("{}: line {}", place_, scan_.line()));
  }

  std::span<const std::byte> bytes_;
  TextScanner scan_;
  const std::string& place_;
  PlyHeader header_;
  bool has_format_ = false;
  std::size_t property_count_ = 0;
};

/// False at the end of the header.
bool HeaderParser::read_line() {
  if (scan_.at_end()) refuse("the header has no end");
  const std::string_view word = scan_.word();
  if (word == "end_header") return false;
  if (word == "format") {
    read_format();
  } else if (word == "comment") {
    read_comment();
  } else if (word == "element") {
    read_element();
  } else if (word == "property") {
    read_property();
  }
  // Anything else is a remark; some programs forget the word "comment" before it.
  return true;
}

void HeaderParser::read_format() {
  const std::string_view name = scan_.word();
  if (name == "ascii") {
    header_.encoding = PlyEncoding::ascii;
  } else if (name == "binary_little_endian") {
    header_.encoding = PlyEncoding::little;
  } else if (name == "binary_big_endian") {
    header_.encoding = PlyEncoding::big;
  } else {
    refuse("the format is none of ascii, binary_little_endian, binary_big_endian");
  }
  has_format_ = true;
}

void HeaderParser::read_comment() {
  if (scan_.word() == "TextureFile") header_.texture_files.emplace_back(scan_.rest());
}

void HeaderParser::read_element() {
  PlyElement& element = header_.elements.emplace_back();
  element.name = scan_.word();
  if (element.name.empty() || !scan_.number(element.count)) refuse("an element needs a name and a count");
}

void HeaderParser::read_property() {
  if (header_.elements.empty()) refuse("a property comes before any element");
  if (++property_count_ > kMaxProperties)
    refuse(fmt::format("there are more than {} properties", kMaxProperties));
  PlyProperty property;
  TextScanner ahead = scan_;
  if (ahead.word() == "list") {
    scan_ = ahead;
    property.is_list = true;
    property.count_type = read_type();
    if (is_float(property.count_type)) refuse("the count of a list must be an integer");
  }
  property.type = read_type();
  property.name = scan_.word();
  if (property.name.empty()) refuse("a property has no name");
  header_.elements.back().properties.push_back(std::move(property));
}

PlyType HeaderParser::read_type() {
  const std::string_view word = scan_.word();
  for (const TypeName& t : kTypeNames) {
    if (t.name == word) return t.type;
  }
  refuse(fmt::format("unknown type \"{}\"", word.substr(0, 32)));
}

/// Binary data may begin with a byte that looks like the second half of "\r\n": the first line tells
/// how lines end here.
void HeaderParser::skip_last_line_end() {
  std::size_t at = scan_.offset();
  const auto is = [&](char c) { return at < bytes_.size() && bytes_[at] == static_cast<std::byte>(c); };
  while (at < bytes_.size() && !is('\r') && !is('\n')) ++at;
  const bool only_returns = bytes_.size() > 4 && bytes_[3] == std::byte{'\r'} && bytes_[4] != std::byte{'\n'};
  if (is('\r')) ++at;
  if (!only_returns && is('\n')) ++at;
  header_.size = at;
  header_.lines = scan_.line();
}

void HeaderParser::check_sizes() const {
  std::uint64_t left = bytes_.size() - header_.size;
  for (const PlyElement& element : header_.elements) {
    const std::uint64_t row = element.smallest_row(header_.encoding);
    // The last row of a text may lack its line end.
    const std::uint64_t available = left + (header_.encoding == PlyEncoding::ascii ? 1 : 0);
    if (row > 0 && element.count > available / row) {
      throw Error(ErrorKind::format,
                  fmt::format("{} rows of element \"{}\" need at least {} bytes each, but {} bytes follow",
                              element.count, element.name.substr(0, 64), row, left),
                  place_ + ": header");
    }
    left -= std::min(left, row * element.count);
  }
}

}  // namespace

std::size_t size_of(PlyType type) {
  switch (type) {
    case PlyType::i8:
    case PlyType::u8: return 1;
    case PlyType::i16:
    case PlyType::u16: return 2;
    case PlyType::i32:
    case PlyType::u32:
    case PlyType::f32: return 4;
    case PlyType::f64: return 8;
  }
  return 8;
}

bool is_float(PlyType type) { return type == PlyType::f32 || type == PlyType::f64; }

double largest(PlyType type) {
  switch (type) {
    case PlyType::i8: return 127;
    case PlyType::u8: return 255;
    case PlyType::i16: return 32767;
    case PlyType::u16: return 65535;
    case PlyType::i32: return 2147483647;
    case PlyType::u32: return 4294967295;
    case PlyType::f32:
    case PlyType::f64: return 1;
  }
  return 1;
}

int PlyElement::find(std::string_view wanted) const {
  for (std::size_t i = 0; i < properties.size(); ++i) {
    if (properties[i].name == wanted) return static_cast<int>(i);
  }
  return -1;
}

bool PlyElement::has_list() const {
  for (const PlyProperty& p : properties) {
    if (p.is_list) return true;
  }
  return false;
}

std::uint64_t PlyElement::smallest_row(PlyEncoding encoding) const {
  std::uint64_t size = 0;
  for (const PlyProperty& p : properties) {
    // A digit and a blank are the least in text.
    size += encoding == PlyEncoding::ascii ? 2 : size_of(p.is_list ? p.count_type : p.type);
  }
  return size;
}

PlyHeader read_ply_header(std::span<const std::byte> bytes, const std::string& place) {
  return HeaderParser(bytes, place).run();
}

}  // namespace fovea
