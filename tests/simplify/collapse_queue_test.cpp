#include "fovea/simplify/collapse_queue.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <vector>

#include "fovea/base/random.h"

namespace fovea {
namespace {

TEST(CollapseQueue, EmptyHasNoFirst) {
  CollapseQueue queue(3);
  EXPECT_EQ(queue.first(), kInvalid);
}

TEST(CollapseQueue, TakesTheCheapest) {
  CollapseQueue queue(4);
  queue.set(0, 3.0);
  queue.set(1, 1.0);
  queue.set(2, 2.0);
  EXPECT_EQ(queue.first(), 1u);
  queue.remove(1);
  EXPECT_EQ(queue.first(), 2u);
  queue.set(2, 5.0);
  EXPECT_EQ(queue.first(), 0u);
  queue.set(3, 0.0);
  EXPECT_EQ(queue.first(), 3u);
}

TEST(CollapseQueue, RemovingWhatIsNotInDoesNothing) {
  CollapseQueue queue(2);
  queue.set(0, 1.0);
  queue.remove(1);
  EXPECT_EQ(queue.first(), 0u);
  EXPECT_FALSE(queue.contains(1));
}

TEST(CollapseQueue, OrdersAsTheBucketsOfASortedMap) {
  constexpr std::uint32_t kItems = 200;
  CollapseQueue queue(kItems);
  std::map<std::uint32_t, std::uint16_t> expected;
  Random random(7);
  for (int turn = 0; turn < 5000; ++turn) {
    const std::uint32_t item = random.below(kItems);
    if (random.below(4) == 0) {
      queue.remove(item);
      expected.erase(item);
    } else {
      const double cost = std::exp(random.uniform(-60, 10));
      queue.set(item, cost);
      expected[item] = CollapseQueue::bucket_of(cost);
    }
    std::uint16_t lowest = 0xFFFF;
    for (const auto& [i, bucket] : expected) lowest = std::min(lowest, bucket);
    const std::uint32_t first = queue.first();
    if (expected.empty()) {
      ASSERT_EQ(first, kInvalid);
    } else {
      ASSERT_TRUE(expected.contains(first));
      ASSERT_EQ(expected[first], lowest);
    }
  }
}

TEST(CollapseQueue, FloorIsWithinOnePercentBelow) {
  Random random(8);
  for (int i = 0; i < 1000; ++i) {
    const double cost = std::exp(random.uniform(-60, 60));
    const double floor = CollapseQueue::floor_of(CollapseQueue::bucket_of(cost));
    EXPECT_LE(floor, cost * (1 + 1e-7));  // the cost is rounded to a float first
    EXPECT_GE(floor, cost * 0.99);        // 7 bits of mantissa: steps of 1/128 at most
  }
}

TEST(CollapseQueue, NegativeRoundingNoiseCountsAsZero) { EXPECT_EQ(CollapseQueue::bucket_of(-1e-18), 0); }

}  // namespace
}  // namespace fovea
