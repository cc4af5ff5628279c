#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include <vector>

#include "fovea/model/ids.h"

namespace fovea {

/// A priority queue over the fixed items 0 … n-1 with changing costs ≥ 0, in O(1) per change.
///
/// Costs are sorted into buckets by the leading 16 bits of their float (steps below 0.8 %); within a
/// bucket the item that came last goes first. The order depends on nothing but the sequence of calls.
/// A bucket is a stack in which entries that have moved elsewhere are left until they come up, so that
/// a change touches one place in memory. 2 bytes per item and 4 per entry.
class CollapseQueue {
 public:
  explicit CollapseQueue(std::size_t items) : bucket_(items, kNone), tops_(kBuckets) {
    blocks_.reserve(items / (kBlock - 1) + kBuckets / 12);  // what models need; not touched before that
    blocks_.emplace_back();
  }

  bool contains(std::uint32_t item) const { return bucket_[item] != kNone; }
  /// Puts an item in, or moves it to its new cost.
  void set(std::uint32_t item, double cost);
  void remove(std::uint32_t item) { bucket_[item] = kNone; }
  /// Lowest cost of `item`'s bucket; the item must be in the queue.
  float cost_floor(std::uint32_t item) const { return floor_of(bucket_[item]); }
  /// An item of the lowest bucket, or kInvalid when empty. The item stays in.
  std::uint32_t first();

  static std::uint16_t bucket_of(double cost) {
    return static_cast<std::uint16_t>(std::bit_cast<std::uint32_t>(static_cast<float>(cost > 0 ? cost : 0)) >>
                                      16);
  }
  static float floor_of(std::uint16_t bucket) { return std::bit_cast<float>(std::uint32_t{bucket} << 16); }

 private:
  static constexpr std::uint16_t kNone = 0xFFFF;
  static constexpr std::size_t kBuckets = 0x8000;  // the sign bit is never set

  /// A piece of a stack, one cache line: the place of the entry below it, then its own entries. Blocks are
  /// handed on from emptied stacks to growing ones. An entry's place is that of its block times kBlock, plus
  /// its place there; the first block is not used, so that 0 is none.
  static constexpr std::uint32_t kBlock = 16;
  using Block = std::array<std::uint32_t, kBlock>;

  void push(std::uint32_t& top, std::uint32_t item);
  void pop(std::uint32_t& top);

  std::vector<std::uint16_t> bucket_;  // [#items]
  std::vector<std::uint32_t> tops_;    // [kBuckets], place of the last entry, or 0
  std::vector<Block> blocks_;
  std::uint32_t free_block_ = 0;                // first of a list, or 0
  std::uint64_t occupied_[kBuckets / 64] = {};  // stacks that are not empty
  std::size_t lowest_word_ = kBuckets / 64;     // no occupied bucket below this word
};

}  // namespace fovea
