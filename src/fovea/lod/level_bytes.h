#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "fovea/base/error.h"

// Private to lod.

namespace fovea {

using Bytes = std::vector<std::byte>;

[[noreturn]] inline void damaged_levels(const std::string& what) {
  throw Error(ErrorKind::format, "the levels are damaged: " + what, {},
              "make them again with \"fovea lods\"");
}

/// Writes numbers one after the other, little-endian.
class ByteWriter {
 public:
  Bytes bytes;

  template <class T>
  void number(T x) {
    for (std::size_t i = 0; i < sizeof(T); ++i)
      bytes.push_back(static_cast<std::byte>((x >> (8 * i)) & 0xFF));
  }
  void real(double x) { number(std::bit_cast<std::uint64_t>(x)); }
  /// Seven bits a byte, the lowest first; the eighth says that more follow (LEB128).
  void varint(std::uint64_t x) {
    for (; x >= 0x80; x >>= 7) bytes.push_back(static_cast<std::byte>((x & 0x7F) | 0x80));
    bytes.push_back(static_cast<std::byte>(x));
  }
  void text(const std::string& s) {
    varint(s.size());
    append(std::as_bytes(std::span(s)));
  }
  void append(std::span<const std::byte> more) { bytes.insert(bytes.end(), more.begin(), more.end()); }
};

/// Reads what a ByteWriter wrote. All throw Error(format) where the bytes end too early.
class ByteReader {
 public:
  explicit ByteReader(std::span<const std::byte> bytes) : bytes_(bytes) {}

  template <class T>
  T number() {
    T x = 0;
    const std::span<const std::byte> from = take(sizeof(T));
    for (std::size_t i = 0; i < sizeof(T); ++i)
      x = static_cast<T>(x | static_cast<T>(static_cast<T>(from[i]) << (8 * i)));
    return x;
  }
  double real() { return std::bit_cast<double>(number<std::uint64_t>()); }
  std::uint64_t varint() {
    std::uint64_t x = 0;
    for (int shift = 0; shift < 64; shift += 7) {
      const auto byte = static_cast<std::uint64_t>(take(1)[0]);
      x |= (byte & 0x7F) << shift;
      if (byte < 0x80) return x;
    }
    damaged_levels("a number has too many digits");
  }
  /// A varint of at most `most`.
  std::size_t count(std::uint64_t most) {
    const std::uint64_t x = varint();
    if (x > most) damaged_levels("a count is too large");
    return static_cast<std::size_t>(x);
  }
  std::string text() {
    const std::span<const std::byte> from = take(count(left()));
    return {reinterpret_cast<const char*>(from.data()), from.size()};
  }
  std::span<const std::byte> take(std::size_t size) {
    if (size > left()) damaged_levels("they end too early");
    const std::span<const std::byte> taken = bytes_.subspan(at_, size);
    at_ += size;
    return taken;
  }
  std::size_t left() const { return bytes_.size() - at_; }
  std::size_t at() const { return at_; }

 private:
  std::span<const std::byte> bytes_;
  std::size_t at_ = 0;
};

}  // namespace fovea
