#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>

#include "fovea/base/error.h"
#include "fovea/io/ply_header.h"
#include "fovea/io/text_scan.h"

namespace fovea {

/// Numbers of a PLY body in binary, one after the other. Throws Error(format) at the end of the data.
template <bool Swap>
class PlyBinarySource {
 public:
  PlyBinarySource(std::span<const std::byte> bytes, const PlyHeader& header, const std::string& place)
      : begin_(bytes.data()), at_(begin_ + header.size), end_(begin_ + bytes.size()), place_(place) {}

  double number(PlyType type) {
    switch (type) {
      case PlyType::f32: return take<float>();
      case PlyType::f64: return take<double>();
      default: return static_cast<double>(integer(type));
    }
  }
  std::int64_t integer(PlyType type) {
    switch (type) {
      case PlyType::i8: return take<std::int8_t>();
      case PlyType::u8: return take<std::uint8_t>();
      case PlyType::i16: return take<std::int16_t>();
      case PlyType::u16: return take<std::uint16_t>();
      case PlyType::i32: return take<std::int32_t>();
      case PlyType::u32: return take<std::uint32_t>();
      case PlyType::f32: return to_integer(take<float>());
      case PlyType::f64: return to_integer(take<double>());
    }
    return 0;
  }
  /// Whether `count` values of a type can still follow.
  bool has(std::uint64_t count, PlyType type) const {
    return count <= static_cast<std::uint64_t>(end_ - at_) / size_of(type);
  }
  void skip(std::uint64_t count, PlyType type) {
    if (!has(count, type)) refuse("the data ends early");
    at_ += count * size_of(type);
  }
  [[noreturn]] void refuse(const std::string& message) const {
    throw Error(ErrorKind::format, message, fmt::format("{}: byte {}", place_, at_ - begin_));
  }

 private:
  template <class T>
  T take() {
    if (static_cast<std::size_t>(end_ - at_) < sizeof(T)) refuse("the data ends early");
    std::array<std::byte, sizeof(T)> raw;
    std::memcpy(raw.data(), at_, sizeof(T));
    at_ += sizeof(T);
    constexpr bool kReverse = Swap != (std::endian::native == std::endian::big);
    if constexpr (kReverse && sizeof(T) > 1) std::reverse(raw.begin(), raw.end());
    return std::bit_cast<T>(raw);
  }
  std::int64_t to_integer(double x) const {
    if (!(x >= -9e15 && x <= 9e15)) refuse("an index is no integer");
    return static_cast<std::int64_t>(x);
  }

  const std::byte* begin_;
  const std::byte* at_;
  const std::byte* end_;
  const std::string& place_;
};

/// Numbers of a PLY body in text: blanks and line ends part them alike.
class PlyTextSource {
 public:
  PlyTextSource(std::span<const std::byte> bytes, const PlyHeader& header, const std::string& place)
      : scan_(bytes.subspan(header.size)),
        size_(bytes.size() - header.size),
        lines_(header.lines),
        place_(place) {}

  double number(PlyType type) {
    if (type == PlyType::f64) return take<double>();
    return static_cast<double>(take<float>());
  }
  std::int64_t integer(PlyType) {
    TextScanner before = scan_;
    const auto value = take<std::int64_t>();
    if (scan_.at_word_end()) return value;
    scan_ = before;  // "3.0": some programs write every number alike
    const double x = take<double>();
    if (!(x >= -9e15 && x <= 9e15)) refuse("an index is no integer");
    return static_cast<std::int64_t>(x);
  }
  bool has(std::uint64_t count, PlyType) const { return count <= (size_ - scan_.offset() + 1) / 2; }
  void skip(std::uint64_t count, PlyType) {
    for (std::uint64_t i = 0; i < count; ++i) take<double>();
  }
  [[noreturn]] void refuse(const std::string& message) const {
    throw Error(ErrorKind::format, message, fmt::format("{}: line {}", place_, lines_ + scan_.line()));
  }

 private:
  template <class T>
  T take() {
    T value{};
    scan_.skip_space();
    if (!scan_.number(value)) refuse(scan_.at_end() ? "the data ends early" : "this is not a number");
    return value;
  }

  TextScanner scan_;
  std::size_t size_;
  std::size_t lines_;
  const std::string& place_;
};

}  // namespace fovea
