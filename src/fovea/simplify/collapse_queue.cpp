#include "fovea/simplify/collapse_queue.h"

#include <algorithm>
#include <iterator>

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
  push(stacks_[bucket], item);
  occupied_[bucket / 64] |= std::uint64_t{1} << (bucket % 64);
  lowest_word_ = std::min<std::size_t>(lowest_word_, bucket / 64);
}

std::uint32_t CollapseQueue::first() {
  for (; lowest_word_ < kBuckets / 64; ++lowest_word_) {
    std::uint64_t& word = occupied_[lowest_word_];
    while (word != 0) {
      const auto bucket =
          static_cast<std::uint16_t>(64 * lowest_word_ + static_cast<std::size_t>(std::countr_zero(word)));
      Stack& stack = stacks_[bucket];
      while (stack.top != kInvalid) {
        const Block& block = blocks_[stack.top];
        const std::uint32_t item = block.items[stack.count - 1];
        prefetch(&bucket_[block.items[stack.count > kLookAhead ? stack.count - 1 - kLookAhead : 0]]);
        if (bucket_[item] == bucket) return item;
        pop(stack);
      }
      word &= word - 1;
    }
  }
  return kInvalid;
}

void CollapseQueue::push(Stack& stack, std::uint32_t item) {
  if (stack.top == kInvalid || stack.count == std::size(Block{}.items)) {
    std::uint32_t block = free_block_;
    if (block == kInvalid) {
      block = static_cast<std::uint32_t>(blocks_.size());
      blocks_.emplace_back();
    } else {
      free_block_ = blocks_[block].below;
    }
    blocks_[block].below = stack.top;
    stack = {block, 0};
  }
  blocks_[stack.top].items[stack.count++] = item;
}

void CollapseQueue::pop(Stack& stack) {
  if (--stack.count > 0) return;
  const std::uint32_t emptied = stack.top;
  stack.top = blocks_[emptied].below;
  stack.count = static_cast<std::uint32_t>(std::size(Block{}.items));
  blocks_[emptied].below = free_block_;
  free_block_ = emptied;
}

}  // namespace fovea
