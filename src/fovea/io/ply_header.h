#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace fovea {

enum class PlyType { i8, u8, i16, u16, i32, u32, f32, f64 };
std::size_t size_of(PlyType type);
bool is_float(PlyType type);
/// What an integer is divided by when it stands for [0, 1]; 1 for floats.
double largest(PlyType type);

enum class PlyEncoding { ascii, little, big };

/// One value, or one list of values, that every row of an element has.
struct PlyProperty {
  std::string name;
  PlyType type = PlyType::f32;
  bool is_list = false;
  PlyType count_type = PlyType::u8;  ///< Of lists.
};

/// A table of the file: `count` rows of the properties.
struct PlyElement {
  std::string name;
  std::uint64_t count = 0;
  std::vector<PlyProperty> properties;

  /// Index of the first property with that name, or -1.
  int find(std::string_view name) const;
  /// Fewest bytes that a row can take.
  std::uint64_t smallest_row(PlyEncoding encoding) const;
  bool has_list() const;
};

struct PlyHeader {
  PlyEncoding encoding = PlyEncoding::ascii;
  std::vector<PlyElement> elements;
  std::vector<std::string> texture_files;  ///< From "comment TextureFile NAME".
  std::size_t size = 0;                    ///< Bytes up to and with the end of its last line.
  std::size_t lines = 0;
};

/// Throws Error(format) with "place:line N", also if the rows that it promises need more bytes than
/// follow.
PlyHeader read_ply_header(std::span<const std::byte> bytes, const std::string& place);

}  // namespace fovea
