#pragma once

#include <bit>
#include <cstdint>
#include <span>
#include <vector>

#include "fovea/model/ids.h"

namespace fovea {

/// Gives equal keys equal numbers: 0, 1, 2, ... in order of first appearance. A key is a run of
/// 32-bit words of fixed length; floats go in as their bits, with -0 as +0.
class KeyTable {
 public:
  /// `expected` is a guess at how many distinct keys will come.
  KeyTable(std::size_t words_per_key, std::size_t expected);

  /// Number of `key`, new or known.
  std::uint32_t insert(std::span<const std::uint32_t> key);
  std::uint32_t size() const { return size_; }

  static std::uint32_t word(float value) { return std::bit_cast<std::uint32_t>(value + 0.0f); }

 private:
  void grow();
  std::size_t slot_of(const std::uint32_t* key) const;

  std::size_t words_;
  std::uint32_t size_ = 0;
  std::vector<std::uint32_t> keys_;   // [size × words]
  std::vector<std::uint32_t> slots_;  // key number or kInvalid; a power of two, at most half full
};

}  // namespace fovea
