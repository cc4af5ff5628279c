#include "fovea/cluster/radix_heap.h"

#include <gtest/gtest.h>

#include <cmath>
#include <queue>

#include "fovea/base/random.h"

namespace fovea {
namespace {

TEST(RadixHeap, TakesTheSmallestAsAnyQueueDoes) {
  Random random(7);
  RadixHeap<std::uint32_t> heap;
  std::priority_queue<double, std::vector<double>, std::greater<>> expected;
  double last = 0;
  for (int i = 0; i < 20000; ++i) {
    if (expected.empty() || random.below(3) > 0) {
      const double key = random.below(4) == 0
                             ? last
                             : last + std::ldexp(random.uniform(), -static_cast<int>(random.below(60)));
      heap.push(key, 0);
      expected.push(key);
    } else {
      last = expected.top();
      expected.pop();
      ASSERT_EQ(heap.pop().key, last);
    }
    ASSERT_EQ(heap.empty(), expected.empty());
  }
}

TEST(RadixHeap, KeepsItemsWithTheirKeys) {
  RadixHeap<char> heap;
  heap.push(2, 'b');
  heap.push(0, 'a');
  heap.push(1e300, 'd');
  heap.push(2.5, 'c');
  for (const char expected : {'a', 'b', 'c', 'd'}) EXPECT_EQ(heap.pop().item, expected);
}

TEST(RadixHeap, BeginsAgainWhenCleared) {
  RadixHeap<int> heap;
  heap.push(5, 5);
  heap.push(9, 9);
  heap.pop();
  heap.clear();
  EXPECT_TRUE(heap.empty());
  heap.push(1, 1);
  EXPECT_EQ(heap.pop().item, 1);
}

}  // namespace
}  // namespace fovea
