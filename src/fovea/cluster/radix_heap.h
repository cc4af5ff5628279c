#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <utility>
#include <vector>

// Private to cluster/.

namespace fovea {

/// A queue of items by numbers, smallest first, for searches in which no number is smaller than one that was
/// taken (Ahuja, Mehlhorn, Orlin, Tarjan 1990). Which of equal numbers comes first follows from the order of
/// the calls. Keeps its memory when emptied. O(1) to push, O(64) amortised to take.
template <class Item>
class RadixHeap {
 public:
  struct Entry {
    double key;
    Item item;
  };

  /// To be empty, and for numbers from 0 again.
  void clear() {
    for (auto& bucket : buckets_) bucket.clear();
    filled_ = 0;
    last_ = 0;
  }
  bool empty() const { return filled_ == 0 && buckets_[0].empty(); }
  /// `key` is 0 or more, and not less than that of the last entry taken.
  void push(double key, Item item) { place({key, item}); }
  Entry pop() {
    if (buckets_[0].empty()) refill();
    const Entry entry = buckets_[0].back();
    buckets_[0].pop_back();
    return entry;
  }

 private:
  /// Bit patterns of numbers from 0 up are in the order of the numbers.
  static std::uint64_t bits(double key) { return std::bit_cast<std::uint64_t>(key); }

  void place(const Entry& entry) {
    const int bucket = static_cast<int>(std::bit_width(bits(entry.key) ^ last_));
    buckets_[static_cast<std::size_t>(bucket)].push_back(entry);
    if (bucket > 0) filled_ |= std::uint64_t{1} << (bucket - 1);
  }

  /// Spreads the first bucket with entries over those below it.
  void refill() {
    const int bucket = std::countr_zero(filled_) + 1;
    std::vector<Entry>& from = buckets_[static_cast<std::size_t>(bucket)];
    last_ = bits(from.front().key);
    for (const Entry& entry : from) last_ = std::min(last_, bits(entry.key));
    filled_ &= filled_ - 1;
    for (const Entry& entry : from) place(entry);
    from.clear();
  }

  std::array<std::vector<Entry>, 65> buckets_;  // [b]: what differs from `last_` in bit b − 1 and none above
  std::uint64_t filled_ = 0;                    // which of them, but the first, hold entries
  std::uint64_t last_ = 0;                      // bits of the number last taken
};

}  // namespace fovea
