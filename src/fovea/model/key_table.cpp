#include "fovea/model/key_table.h"

#include <algorithm>

namespace fovea {

KeyTable::KeyTable(std::size_t words_per_key, std::size_t expected) : words_(words_per_key) {
  keys_.reserve(expected * words_);
  slots_.assign(std::bit_ceil(2 * std::max<std::size_t>(expected, 8)), kInvalid);
}

std::size_t KeyTable::slot_of(const std::uint32_t* key) const {
  std::uint64_t hash = 0x9E3779B97F4A7C15ull;
  for (std::size_t i = 0; i < words_; ++i) {
    hash = (hash ^ key[i]) * 0xFF51AFD7ED558CCDull;
    hash ^= hash >> 32;
  }
  const std::size_t mask = slots_.size() - 1;
  std::size_t slot = hash & mask;
  while (slots_[slot] != kInvalid && !std::equal(key, key + words_, keys_.data() + slots_[slot] * words_)) {
    slot = (slot + 1) & mask;
  }
  return slot;
}

std::uint32_t KeyTable::insert(std::span<const std::uint32_t> key) {
  const std::size_t slot = slot_of(key.data());
  if (slots_[slot] != kInvalid) return slots_[slot];
  slots_[slot] = size_;
  keys_.insert(keys_.end(), key.begin(), key.end());
  if (2 * ++size_ > slots_.size()) grow();
  return size_ - 1;
}

void KeyTable::grow() {
  slots_.assign(2 * slots_.size(), kInvalid);
  for (std::uint32_t i = 0; i < size_; ++i) slots_[slot_of(keys_.data() + i * words_)] = i;
}

}  // namespace fovea
