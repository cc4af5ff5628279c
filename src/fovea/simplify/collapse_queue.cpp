#include "fovea/simplify/collapse_queue.h"

#include <algorithm>

namespace fovea {

std::uint32_t CollapseQueue::first() {
  while (lowest_word_ < kBuckets / 64 && occupied_[lowest_word_] == 0) ++lowest_word_;
  if (lowest_word_ == kBuckets / 64) return kInvalid;
  const int bit = std::countr_zero(occupied_[lowest_word_]);
  return head_[64 * lowest_word_ + static_cast<std::size_t>(bit)];
}

void CollapseQueue::link(std::uint32_t item, std::uint16_t bucket) {
  if (links_[item].bucket == bucket) return;
  if (contains(item)) unlink(item);
  const std::uint32_t head = head_[bucket];
  links_[item].bucket = bucket;
  links_[item].next = head;
  links_[item].previous = kInvalid;
  if (head != kInvalid) links_[head].previous = item;
  head_[bucket] = item;
  occupied_[bucket / 64] |= std::uint64_t{1} << (bucket % 64);
  lowest_word_ = std::min<std::size_t>(lowest_word_, bucket / 64);
}

void CollapseQueue::unlink(std::uint32_t item) {
  const std::uint16_t bucket = links_[item].bucket;
  const std::uint32_t next = links_[item].next, previous = links_[item].previous;
  if (next != kInvalid) links_[next].previous = previous;
  if (previous != kInvalid) {
    links_[previous].next = next;
  } else {
    head_[bucket] = next;
    if (next == kInvalid) occupied_[bucket / 64] &= ~(std::uint64_t{1} << (bucket % 64));
  }
  links_[item].bucket = kNone;
}

}  // namespace fovea
