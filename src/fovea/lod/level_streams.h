#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "fovea/lod/level_bytes.h"
#include "fovea/lod/level_chunk.h"
#include "fovea/lod/number_code.h"

// Private to lod.

namespace fovea {

/// Small numbers of one meaning, in a stream of their own. In the order of the file.
enum class Symbol {
  head,      ///< What the base says about the model.
  flags,     ///< Of a step: kind, what it changes, how many triangles come.
  mesh,      ///< Whose step it is.
  faces,     ///< Triangles that come, beyond what flags can say.
  sides,     ///< Which corners of the fan go to the new vertex.
  groups,    ///< What becomes of a value of the fan.
  digits,    ///< Which of several values a corner gets.
  triangle,  ///< A usual triangle, or that an unusual one follows.
  vertex,    ///< A corner of an unusual triangle.
  id,        ///< Of a vertex: how many came after it.
  part,
  values,  ///< Whether the values of a triangle are as expected.
  value,   ///< One that is not.
};

/// Numbers of 32 bits of one meaning: their bytes go to four streams, the lowest first.
enum class Wide {
  kept,
  error,
  error_rel,
  position,
  position_morph,
  uv,
  normal,
  tangent,
  color,
  joints,
  weights,
  custom,
  value_morph,
};

inline constexpr std::size_t kSymbolStreams = static_cast<std::size_t>(Symbol::value) + 1;
inline constexpr std::size_t kWideStreams = static_cast<std::size_t>(Wide::value_morph) + 1;
inline constexpr std::size_t kStreams = kSymbolStreams + 4 * kWideStreams;

inline Wide wide_of(Semantic semantic) {
  return static_cast<Wide>(static_cast<int>(Wide::uv) + static_cast<int>(semantic));
}

/// Small for differences of either sign.
inline std::uint32_t zigzag(std::uint32_t difference) {
  return (difference << 1) ^ ((difference & 0x80000000u) != 0 ? 0xFFFFFFFFu : 0u);
}
inline std::uint32_t unzigzag(std::uint32_t x) { return (x >> 1) ^ ((x & 1) != 0 ? 0xFFFFFFFFu : 0u); }

/// Writes symbols and numbers to their streams. `StreamReader` has the same functions, in which what goes out
/// here comes in, so that one function describes what a file holds.
class StreamWriter {
 public:
  static constexpr bool kWrites = true;

  void symbol(Symbol kind, std::uint32_t& x) { symbols_[static_cast<std::size_t>(kind)].varint(x); }
  void wide(Wide kind, std::uint32_t& x) { wides_[static_cast<std::size_t>(kind)].push_back(x); }
  /// A number near another, whose code is `reference`.
  void number(Wide kind, NumberCode code, std::int32_t reference, float& x) {
    std::uint32_t difference =
        zigzag(static_cast<std::uint32_t>(code.code(x)) - static_cast<std::uint32_t>(reference));
    wide(kind, difference);
  }
  void charge(std::size_t) {}
  void real(double& x) { head().real(x); }
  void text(std::string& s) { head().text(s); }

  /// All that was written, packed; begins anew.
  Bytes take() {
    std::vector<Bytes> streams;
    for (ByteWriter& symbols : symbols_) streams.push_back(std::move(symbols.bytes));
    for (const std::vector<std::uint32_t>& list : wides_) {
      for (int shift = 0; shift < 32; shift += 8) {
        Bytes& plane = streams.emplace_back();
        for (const std::uint32_t x : list) plane.push_back(static_cast<std::byte>((x >> shift) & 0xFF));
      }
    }
    *this = {};
    return pack(streams);
  }

 private:
  ByteWriter& head() { return symbols_[static_cast<std::size_t>(Symbol::head)]; }

  std::array<ByteWriter, kSymbolStreams> symbols_;
  std::array<std::vector<std::uint32_t>, kWideStreams> wides_;
};

/// All functions throw Error(format) where a stream ends too early.
class StreamReader {
 public:
  static constexpr bool kWrites = false;

  StreamReader(std::span<const std::byte> packed, std::uint64_t& budget)
      : budget_(budget), streams_(unpack(packed, kStreams, budget)) {
    for (std::size_t i = 0; i < kSymbolStreams; ++i) symbols_.emplace_back(streams_[i]);
  }

  void symbol(Symbol kind, std::uint32_t& x) {
    x = static_cast<std::uint32_t>(symbols_[static_cast<std::size_t>(kind)].count(0xFFFFFFFFu));
  }
  void wide(Wide kind, std::uint32_t& x) {
    const auto k = static_cast<std::size_t>(kind);
    const std::size_t at = wide_at_[k]++;
    x = 0;
    for (std::size_t plane = 0; plane < 4; ++plane) {
      const Bytes& bytes = streams_[kSymbolStreams + 4 * k + plane];
      if (at >= bytes.size()) damaged_levels("they end too early");
      x |= static_cast<std::uint32_t>(bytes[at]) << (8 * plane);
    }
  }
  void number(Wide kind, NumberCode code, std::int32_t reference, float& x) {
    std::uint32_t difference = 0;
    wide(kind, difference);
    x = code.number(static_cast<std::int32_t>(static_cast<std::uint32_t>(reference) + unzigzag(difference)));
    if (!std::isfinite(x)) damaged_levels("a number is not finite");
  }
  /// Takes memory from the budget before it is used. Throws Error(limit) if there is not so much.
  void charge(std::size_t bytes) {
    if (bytes > budget_) throw Error(ErrorKind::limit, "the levels take more memory than is allowed");
    budget_ -= bytes;
  }
  void real(double& x) { x = head().real(); }
  void text(std::string& s) { s = head().text(); }
  /// Bytes of symbols that are left: of anything that takes one there cannot be more.
  std::size_t left(Symbol kind) const { return symbols_[static_cast<std::size_t>(kind)].left(); }
  /// Whether all was read.
  bool at_end() const {
    for (const ByteReader& symbols : symbols_) {
      if (symbols.left() > 0) return false;
    }
    for (std::size_t k = 0; k < kWideStreams; ++k) {
      for (std::size_t plane = 0; plane < 4; ++plane) {
        if (streams_[kSymbolStreams + 4 * k + plane].size() != wide_at_[k]) return false;
      }
    }
    return true;
  }

 private:
  ByteReader& head() { return symbols_[static_cast<std::size_t>(Symbol::head)]; }

  std::uint64_t& budget_;
  std::vector<Bytes> streams_;
  std::vector<ByteReader> symbols_;
  std::array<std::size_t, kWideStreams> wide_at_{};
};

}  // namespace fovea
