#include "fovea/texture/edge_sort.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <memory>
#include <span>
#include <utility>

#include "fovea/base/parallel.h"

namespace fovea {

namespace {

using Keys = std::span<std::uint64_t>;

/// Keys that a thread takes at once.
constexpr std::size_t kKeyGrain = std::size_t{1} << 18;

// Buckets are cut at steps of 1/32 to 1/64 of the value: about the logarithm, since most edges of a picture
// are far below the largest. So most buckets fit a cache.
constexpr int kFractionBits = 5;
constexpr std::size_t kBuckets = std::size_t{64} << kFractionBits;
constexpr std::size_t kBucketGrain = 16;

std::size_t bucket_of(std::uint64_t value) {
  const int shift = std::max(static_cast<int>(std::bit_width(value)) - (kFractionBits + 1), 0);
  return (static_cast<std::size_t>(shift) << kFractionBits) + static_cast<std::size_t>(value >> shift);
}

/// How many keys each bucket gets, then where the next goes.
using BucketTable = std::array<std::size_t, kBuckets>;

/// Puts keys into buckets: each chunk counts its own, then puts them after those of lower buckets and those
/// of the chunks before it. Returns where buckets begin, and the end.
std::vector<std::size_t> put_into_buckets(Keys from, Keys to, int low_bit, const Context& context) {
  std::vector<BucketTable> tables((from.size() + kKeyGrain - 1) / kKeyGrain);
  parallel_for(context, from.size(), kKeyGrain, [&](std::size_t begin, std::size_t end) {
    BucketTable& table = tables[begin / kKeyGrain];
    table.fill(0);
    for (const std::uint64_t key : from.subspan(begin, end - begin)) ++table[bucket_of(key >> low_bit)];
  });
  std::vector<std::size_t> first{0};
  for (std::size_t b = 0; b < kBuckets; ++b) {
    std::size_t next = first.back();
    for (BucketTable& table : tables) next += std::exchange(table[b], next);
    first.push_back(next);
  }
  parallel_for(context, from.size(), kKeyGrain, [&](std::size_t begin, std::size_t end) {
    BucketTable& next = tables[begin / kKeyGrain];
    for (const std::uint64_t key : from.subspan(begin, end - begin))
      to[next[bucket_of(key >> low_bit)]++] = key;
  });
  return first;
}

constexpr int kDigitBits = 11;
constexpr std::size_t kDigits = std::size_t{1} << kDigitBits;
/// Fewer keys are compared: their tables would be longer.
constexpr std::size_t kFewest = kDigits / 2;

/// One pass of a radix sort.
void sort_by_digit(Keys from, Keys to, int shift) {
  std::array<std::uint32_t, kDigits> next{};  // how many keys have a digit, then where the next goes
  for (const std::uint64_t key : from) ++next[(key >> shift) % kDigits];
  std::uint32_t start = 0;
  for (std::uint32_t& n : next) start += std::exchange(n, start);
  for (const std::uint64_t key : from) to[next[(key >> shift) % kDigits]++] = key;
}

/// Sorts a bucket into `to`.
void sort_bucket(Keys from, Keys to, int low_bit) {
  const auto less = [&](std::uint64_t a, std::uint64_t b) { return a >> low_bit < b >> low_bit; };
  if (from.size() < kFewest) {
    std::copy(from.begin(), from.end(), to.begin());
    std::stable_sort(to.begin(), to.end(), less);
    return;
  }
  std::uint64_t differing = 0;
  for (const std::uint64_t key : from) differing |= key ^ from[0];
  Keys sorted = from, other = to;
  for (int shift = low_bit; shift < 64 && differing >> shift != 0; shift += kDigitBits) {
    if ((differing >> shift) % kDigits == 0) continue;
    sort_by_digit(sorted, other, shift);
    std::swap(sorted, other);
  }
  if (sorted.data() != to.data()) std::copy(sorted.begin(), sorted.end(), to.begin());
}

}  // namespace

void sort_by_high_bits(std::vector<std::uint64_t>& keys, int low_bit, const Context& context) {
  const auto memory = std::make_unique_for_overwrite<std::uint64_t[]>(keys.size());
  const Keys other(memory.get(), keys.size());
  const std::vector<std::size_t> first = put_into_buckets(keys, other, low_bit, context);
  parallel_for(context, kBuckets, kBucketGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t b = begin; b < end; ++b) {
      const std::size_t size = first[b + 1] - first[b];
      if (size > 0) sort_bucket(other.subspan(first[b], size), Keys(keys).subspan(first[b], size), low_bit);
    }
  });
}

}  // namespace fovea
