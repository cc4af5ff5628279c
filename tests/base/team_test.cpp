#include "fovea/base/team.h"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <stdexcept>
#include <thread>
#include <vector>

namespace fovea {
namespace {

TEST(Team, DoesEachPieceOnce) {
  for (const int threads : {1, 2, 5}) {
    Context context;
    context.threads = threads;
    Team team(context);
    for (std::size_t count = 0; count < 2000; ++count) {
      std::vector<std::atomic<int>> done(count % 23);
      team.run(done.size(), [&](std::size_t i) { ++done[i]; });
      for (const auto& d : done) ASSERT_EQ(d, 1) << threads << " threads";
    }
  }
}

TEST(Team, WakesUpAfterASleep) {
  Context context;
  context.threads = 2;
  Team team(context);
  for (int round = 0; round < 5; ++round) {
    std::this_thread::sleep_for(std::chrono::milliseconds(3));
    std::atomic<int> done = 0;
    team.run(100, [&](std::size_t) { ++done; });
    EXPECT_EQ(done, 100);
  }
}

TEST(Team, PassesExceptionsOnAndGoesOn) {
  for (const int threads : {1, 2}) {
    Context context;
    context.threads = threads;
    Team team(context);
    for (int round = 0; round < 100; ++round) {
      EXPECT_THROW(team.run(8,
                            [](std::size_t i) {
                              if (i == 3) throw std::runtime_error("3");
                            }),
                   std::runtime_error);
      std::atomic<int> done = 0;
      team.run(8, [&](std::size_t) { ++done; });
      EXPECT_EQ(done, 8);
    }
  }
}

TEST(Team, WorksOnAllItsThreads) {
  if (std::thread::hardware_concurrency() < 2) GTEST_SKIP() << "needs a machine with two threads";
  Context context;
  context.threads = 2;
  Team team(context);
  // Each waits for the other.
  std::atomic<int> arrived = 0;
  team.run(2, [&](std::size_t) {
    ++arrived;
    while (arrived < 2) std::this_thread::yield();
  });
  EXPECT_EQ(arrived, 2);
}

}  // namespace
}  // namespace fovea
