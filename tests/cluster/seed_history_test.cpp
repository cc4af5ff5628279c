#include "fovea/cluster/seed_history.h"

#include <gtest/gtest.h>

namespace fovea {
namespace {

TEST(SeedHistory, SeedsOfTheLastRoundHaveConverged) {
  SeedHistory history;
  EXPECT_EQ(history.add({1, 2, 3}), std::nullopt);
  EXPECT_EQ(history.add({1, 2, 4}), std::nullopt);
  EXPECT_EQ(history.add({1, 2, 4}), ClusterEnd::converged);
}

TEST(SeedHistory, SeedsOfAnEarlierRoundAreACycle) {
  SeedHistory history;
  EXPECT_EQ(history.add({1, 2, 3}), std::nullopt);
  EXPECT_EQ(history.add({1, 2, 4}), std::nullopt);
  EXPECT_EQ(history.add({1, 5, 4}), std::nullopt);
  EXPECT_EQ(history.add({1, 2, 4}), ClusterEnd::cycle);
}

TEST(SeedHistory, WhichClusterGrowsFromWhichDoesNotMatter) {
  SeedHistory history;
  EXPECT_EQ(history.add({1, 2, 3}), std::nullopt);
  EXPECT_EQ(history.add({3, 1, 2}), ClusterEnd::converged);
}

}  // namespace
}  // namespace fovea
