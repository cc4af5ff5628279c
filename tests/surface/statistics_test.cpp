#include "fovea/surface/statistics.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace fovea {
namespace {

TEST(Statistics, CountValuesByWeight) {
  const std::vector<float> values{5, 1, 3, 100}, weights{1, 2, 1, 0};
  const Statistics s = statistics(values, weights);
  EXPECT_EQ(s.least, 1);
  EXPECT_EQ(s.greatest, 5);  // 100 counts for nothing
  EXPECT_DOUBLE_EQ(s.mean, 2.5);
  EXPECT_DOUBLE_EQ(s.deviation, std::sqrt((2.5 * 2.5 + 2 * 1.5 * 1.5 + 0.5 * 0.5) / 4));
  EXPECT_EQ(s.quarter, 1);
  EXPECT_EQ(s.median, 3);
  EXPECT_EQ(s.three_quarters, 5);
}

TEST(Statistics, PercentilesLeaveTheirShareBelow) {
  std::vector<float> values, weights(100, 1.0f);
  for (int i = 99; i >= 0; --i) values.push_back(static_cast<float>(i));
  const std::vector<double> shares{0, 0.3, 0.5, 0.999, 1};
  EXPECT_EQ(percentiles(values, weights, shares), (std::vector<float>{0, 30, 50, 99, 99}));
  // The same where a value is cut in two with half the weight each.
  std::vector<float> twice = values, halves(200, 0.5f);
  twice.insert(twice.end(), values.begin(), values.end());
  EXPECT_EQ(percentiles(twice, halves, shares), percentiles(values, weights, shares));
}

TEST(Statistics, NothingIsZero) {
  const Statistics s = statistics({}, {});
  EXPECT_EQ(s.mean, 0);
  EXPECT_EQ(s.greatest, 0);
  const std::vector<float> values{3}, weights{0};
  EXPECT_EQ(percentiles(values, weights, std::vector<double>{0.5}), std::vector<float>{0});
}

}  // namespace
}  // namespace fovea
