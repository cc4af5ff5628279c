#pragma once

#include <bit>
#include <cstdint>
#include <vector>

#include "fovea/model/ids.h"

namespace fovea {

/// A priority queue over the fixed items 0 … n-1 with changing costs ≥ 0, in O(1) per change.
///
/// Costs are sorted into buckets by the leading 16 bits of their float (steps below 0.8 %); within a
/// bucket the item that came last goes first. The order depends on nothing but the sequence of calls.
/// 12 bytes per item.
class CollapseQueue {
 public:
  explicit CollapseQueue(std::size_t items) : links_(items), head_(kBuckets, kInvalid) {}

  bool contains(std::uint32_t item) const { return links_[item].bucket != kNone; }
  /// Puts an item in, or moves it to its new cost.
  void set(std::uint32_t item, double cost) { link(item, bucket_of(cost)); }
  void remove(std::uint32_t item) {
    if (contains(item)) unlink(item);
  }
  /// Lowest cost of `item`'s bucket; the item must be in the queue.
  float cost_floor(std::uint32_t item) const { return floor_of(links_[item].bucket); }
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

  void link(std::uint32_t item, std::uint16_t bucket);
  void unlink(std::uint32_t item);

  struct Link {
    std::uint32_t next = kInvalid, previous = kInvalid;  // within the bucket; the head has no previous
    std::uint16_t bucket = kNone;
  };
  std::vector<Link> links_;
  std::vector<std::uint32_t> head_;
  std::uint64_t occupied_[kBuckets / 64] = {};
  std::size_t lowest_word_ = kBuckets / 64;  // no occupied bucket below this word
};

}  // namespace fovea
