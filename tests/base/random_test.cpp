#include "fovea/base/random.h"

#include <gtest/gtest.h>

#include <array>

namespace fovea {
namespace {

TEST(Random, IsSplitMix64) {
  // First outputs for seed 1234567, from the reference implementation of SplitMix64.
  Random random(1234567);
  EXPECT_EQ(random.next(), 6457827717110365317ull);
  EXPECT_EQ(random.next(), 3203168211198807973ull);
}

TEST(Random, SeedsGiveTheirOwnStreams) {
  Random a(1), b(1), c(2);
  EXPECT_EQ(a.next(), b.next());
  EXPECT_NE(a.next(), c.next());
}

TEST(Random, UniformStaysInItsRangeAndFillsIt) {
  Random random(3);
  double sum = 0, low = 1, high = 0;
  constexpr int kCount = 10000;
  for (int i = 0; i < kCount; ++i) {
    const double x = random.uniform();
    ASSERT_GE(x, 0.0);
    ASSERT_LT(x, 1.0);
    sum += x;
    low = x < low ? x : low;
    high = x > high ? x : high;
  }
  // The mean of n uniform numbers has a standard deviation of 1 / sqrt(12 n) = 0.0029; five of them.
  EXPECT_NEAR(sum / kCount, 0.5, 0.015);
  EXPECT_LT(low, 0.01);
  EXPECT_GT(high, 0.99);
  const double y = random.uniform(-3, -2);
  EXPECT_GE(y, -3.0);
  EXPECT_LT(y, -2.0);
}

TEST(Random, BelowHitsEveryValueAboutAsOften) {
  Random random(4);
  std::array<int, 7> hits{};
  for (int i = 0; i < 7000; ++i) ++hits.at(random.below(7));
  // Binomial with n = 7000, p = 1/7: standard deviation 29; five of them.
  for (const int h : hits) EXPECT_NEAR(h, 1000, 150);
  EXPECT_EQ(random.below(1), 0u);
}

}  // namespace
}  // namespace fovea
