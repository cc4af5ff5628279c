#include "fovea/simplify/collapse_queue.h"

#include <algorithm>

#include "fovea/base/prefetch.h"

namespace fovea {

namespace {

/// So many entries before an entry comes up its item's bucket is fetched.
constexpr std::uint32_t kLookAhead = 8;

}  // namespace

void CollapseQueue::set(std::uint32_t item, double cost) {
  const std::uint16_t bucket = bucket_of(cost);
  if (bucket_[item] == bucket) return;
  bucket_[item] = bucket;
  push(tops_[bucket], item);
  occupied_[bucket / 64] |= std::uint64_t{1} << (bucket % 64);
  lowest_word_ = std::min<std::size_t>(lowest_word_, bucket / 64);
}

std::uint32_t CollapseQueue::first() {
  for (; lowest_word_ < kBuckets / 64; ++lowest_word_) {
    std::uint64_t& word = occupied_[lowest_word_];
    while (word != 0) {
      const auto bucket =
          static_cast<std::uint16_t>(64 * lowest_word_ + static_cast<std::size_t>(std::countr_zero(word)));
      std::uint32_t& top = tops_[bucket];
      while (top != 0) {
        const Block& block = blocks_[top / kBlock];
        const std::uint32_t place = top % kBlock, item = block[place];
        prefetch(&bucket_[block[place > kLookAhead ? place - kLookAhead : 1]]);
        if (bucket_[item] == bucket) return item;
        pop(top);
      }
      word &= word - 1;
    }
  }
  return kInvalid;
}

void CollapseQueue::push(std::uint32_t& top, std::uint32_t item) {
  if (top == 0 || top % kBlock == kBlock - 1) {
    std::uint32_t block = free_block_;
    if (block == 0) {
      block = static_cast<std::uint32_t>(blocks_.size());
      blocks_.emplace_back();
    } else {
      free_block_ = blocks_[block][0];
    }
    blocks_[block][0] = top;
    top = block * kBlock;
  }
  ++top;
  blocks_[top / kBlock][top % kBlock] = item;
}

void CollapseQueue::pop(std::uint32_t& top) {
  if (--top % kBlock > 0) return;
  const std::uint32_t emptied = top / kBlock;
  top = blocks_[emptied][0];
  blocks_[emptied][0] = free_block_;
  free_block_ = emptied;
}

}  // namespace fovea
