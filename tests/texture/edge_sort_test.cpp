#include "fovea/texture/edge_sort.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "fovea/base/random.h"

namespace fovea {
namespace {

std::vector<std::uint64_t> random_keys(std::size_t count, std::uint64_t mask) {
  Random random(9);
  std::vector<std::uint64_t> keys(count);
  for (std::uint64_t& key : keys) key = random.next() & mask;
  return keys;
}

TEST(EdgeSort, IsAStableSortByTheHighBits) {
  // 600,000 keys are three chunks.
  for (const std::size_t count : {std::size_t{0}, std::size_t{1}, std::size_t{1000}, std::size_t{600'000}}) {
    for (const int low_bit : {20, 32, 41, 63}) {
      // With few bits many keys are equal, and some passes have nothing to do.
      for (const std::uint64_t mask : {~std::uint64_t{0}, std::uint64_t{0xF00000300000000F}}) {
        std::vector<std::uint64_t> keys = random_keys(count, mask), expected = keys;
        std::stable_sort(expected.begin(), expected.end(),
                         [&](std::uint64_t a, std::uint64_t b) { return a >> low_bit < b >> low_bit; });
        for (const int threads : {1, 3}) {
          Context context;
          context.threads = threads;
          std::vector<std::uint64_t> sorted = keys;
          sort_by_high_bits(sorted, low_bit, context);
          EXPECT_TRUE(sorted == expected) << count << " from bit " << low_bit;
        }
      }
    }
  }
}

}  // namespace
}  // namespace fovea
