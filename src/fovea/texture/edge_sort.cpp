#include "fovea/texture/edge_sort.h"

#include <array>
#include <cstddef>
#include <span>

#include "fovea/base/parallel.h"

namespace fovea {

namespace {

constexpr int kDigitBits = 11;
constexpr std::size_t kDigits = std::size_t{1} << kDigitBits;
/// Keys of a chunk: many for its table of digits, few for a cache.
constexpr std::size_t kGrain = std::size_t{1} << 18;

using Table = std::array<std::size_t, kDigits>;

std::size_t digit(std::uint64_t key, int shift) { return (key >> shift) % kDigits; }

/// One pass of a radix sort: each chunk counts its digits, then puts its keys after those of smaller digits
/// and those of the chunks before it.
class Pass {
 public:
  Pass(std::span<const std::uint64_t> from, int shift, const Context& context)
      : from_(from), shift_(shift), context_(context), tables_((from.size() + kGrain - 1) / kGrain) {
    count();
  }

  void run(std::span<std::uint64_t> to) {
    set_starts();
    parallel_for(context_, from_.size(), kGrain, [&](std::size_t begin, std::size_t end) {
      Table& next = tables_[begin / kGrain];
      for (std::size_t i = begin; i < end; ++i) to[next[digit(from_[i], shift_)]++] = from_[i];
    });
  }

 private:
  void count() {
    parallel_for(context_, from_.size(), kGrain, [&](std::size_t begin, std::size_t end) {
      Table& table = tables_[begin / kGrain];
      table.fill(0);
      for (std::size_t i = begin; i < end; ++i) ++table[digit(from_[i], shift_)];
    });
  }

  void set_starts() {
    std::size_t start = 0;
    for (std::size_t d = 0; d < kDigits; ++d) {
      for (Table& table : tables_) {
        const std::size_t keys = table[d];
        table[d] = start;
        start += keys;
      }
    }
  }

  std::span<const std::uint64_t> from_;
  int shift_;
  const Context& context_;
  std::vector<Table> tables_;  // of each chunk: how many keys have a digit, then where the next goes
};

/// The bits in which keys differ.
std::uint64_t differing_bits(std::span<const std::uint64_t> keys) {
  std::uint64_t bits = 0;
  for (const std::uint64_t key : keys) bits |= key ^ keys[0];
  return bits;
}

}  // namespace

void sort_by_high_bits(std::vector<std::uint64_t>& keys, int low_bit, const Context& context) {
  const std::uint64_t differing = differing_bits(keys);
  std::vector<std::uint64_t> other(keys.size());
  for (int shift = low_bit; shift < 64; shift += kDigitBits) {
    if ((differing >> shift) % kDigits == 0) continue;
    Pass(keys, shift, context).run(other);
    keys.swap(other);
  }
}

}  // namespace fovea
