#include "fovea/budget/marginal.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "fovea/base/random.h"

namespace fovea {
namespace {

/// Two ladders with geometric sizes and losses that add up, and a little that does not.
struct Problem {
  explicit Problem(std::uint64_t seed, double mixed = 0) {
    Random random(seed);
    for (int l = 0; l < 2; ++l) {
      double bytes = random.uniform(1e5, 1e6), loss = 0, step = random.uniform(0.01, 1);
      const double shrink = random.uniform(0.5, 0.8), worse = random.uniform(1.3, 2.5);
      for (int i = 0; i < 14; ++i) {
        bytes_of[l].push_back(static_cast<std::uint64_t>(bytes));
        loss_of[l].push_back(loss);
        bytes *= shrink;
        loss += step;
        step *= worse;
      }
    }
    ladders.rungs = {14, 14};
    ladders.bytes = [this](const Rungs& r) { return bytes_of[0][r[0]] + bytes_of[1][r[1]]; };
    ladders.loss = [this, mixed](const Rungs& r) {
      ++asked;
      const double a = loss_of[0][r[0]], b = loss_of[1][r[1]];
      return a + b + mixed * std::sqrt(a * b);
    };
  }
  Problem(const Problem&) = delete;

  JointLadders ladders;
  int asked = 0;
  std::vector<std::uint64_t> bytes_of[2];
  std::vector<double> loss_of[2];
};

TEST(Marginal, PruningWalksTheHullWhereLossesAddUp) {
  for (std::uint64_t seed = 1; seed < 30; ++seed) {
    Problem problem(seed);
    const std::vector<JointPoint> path = prune(problem.ladders, 0);
    const int asked = problem.asked;
    const std::vector<JointPoint> hull = lower_hull(exhaust(problem.ladders));
    // All on the hull are on the way.
    for (const JointPoint& best : hull) {
      EXPECT_TRUE(std::ranges::any_of(path, [&](const JointPoint& p) { return p.rungs == best.rungs; }))
          << seed;
    }
    EXPECT_EQ(path.size(), 27u);
    EXPECT_LE(asked, 2 * 27);  // of 196
    EXPECT_EQ(path.back().rungs, (Rungs{13, 13}));
  }
}

TEST(Marginal, LongerStepsGetPastBadRungs) {
  // Every other rung of the first ladder loses nearly as much as the one below it.
  Problem problem(3);
  for (std::size_t i = 1; i + 1 < problem.loss_of[0].size(); i += 2)
    problem.loss_of[0][i] = 0.95 * problem.loss_of[0][i + 1] + 0.05 * problem.loss_of[0][i - 1];
  const std::vector<JointPoint> hull = lower_hull(exhaust(problem.ladders));
  const auto found = [&](std::size_t ahead) {
    const std::vector<std::size_t> both{ahead, ahead};
    const std::vector<JointPoint> path = prune(problem.ladders, 0, both);
    EXPECT_EQ(path.back().rungs, (Rungs{13, 13}));
    return std::ranges::count_if(hull, [&](const JointPoint& best) {
      return std::ranges::any_of(path, [&](const JointPoint& p) { return p.rungs == best.rungs; });
    });
  };
  EXPECT_EQ(found(2), std::ssize(hull));
  EXPECT_EQ(found(2), found(3));
  EXPECT_LT(found(1), std::ssize(hull));
  const std::vector<std::size_t> first{2};
  EXPECT_EQ(prune(problem.ladders, 0, first).size(),
            prune(problem.ladders, 0, std::vector<std::size_t>{2, 0}).size())
      << "one where nothing is given";
}

TEST(Marginal, PruningIsNearTheHullWhereLossesAlmostAddUp) {
  for (std::uint64_t seed = 1; seed < 30; ++seed) {
    Problem problem(seed, -0.2);
    const std::vector<JointPoint> all = exhaust(problem.ladders);
    for (const JointPoint& p : prune(problem.ladders, 0)) {
      double best = p.loss;
      for (const JointPoint& other : all) {
        if (other.bytes <= p.bytes) best = std::min(best, other.loss);
      }
      EXPECT_LT(p.loss, 1.2 * best + 1e-9) << seed;
    }
  }
}

TEST(Marginal, StopsOnceItFits) {
  Problem problem(3);
  const std::vector<JointPoint> whole = prune(problem.ladders, 0);
  const std::uint64_t bytes = whole[10].bytes;
  const std::vector<JointPoint> path = prune(problem.ladders, bytes);
  EXPECT_EQ(path.size(), 11u);
  EXPECT_LE(path.back().bytes, bytes);
  EXPECT_GT(path[9].bytes, bytes);
}

TEST(Marginal, GrowingStaysWithinBytes) {
  for (std::uint64_t seed = 1; seed < 10; ++seed) {
    Problem problem(seed);
    const std::uint64_t bytes = prune(problem.ladders, 0)[12].bytes;
    const std::vector<JointPoint> path = grow(problem.ladders, bytes);
    ASSERT_FALSE(path.empty());
    EXPECT_EQ(path.front().rungs, (Rungs{13, 13}));
    for (const JointPoint& p : path) EXPECT_LE(p.bytes, bytes);
    for (std::size_t i = 1; i < path.size(); ++i) EXPECT_LE(path[i].loss, path[i - 1].loss);
    // As good as pruning to the same bytes.
    EXPECT_LE(path.back().loss, 1.0001 * prune(problem.ladders, bytes).back().loss) << seed;
  }
  Problem problem(1);
  EXPECT_TRUE(grow(problem.ladders, 10).empty());
}

TEST(Marginal, ALadderOfOneRungStays) {
  JointLadders ladders;
  ladders.rungs = {1, 3};
  ladders.bytes = [](const Rungs& r) { return 100 + 30 * (2 - r[1]); };
  ladders.loss = [](const Rungs& r) { return static_cast<double>(r[1]); };
  EXPECT_EQ(prune(ladders, 0).back().rungs, (Rungs{0, 2}));
  EXPECT_EQ(exhaust(ladders).size(), 3u);
}

TEST(Marginal, TheHullIsConvex) {
  const std::vector<JointPoint> hull =
      lower_hull({{{0}, 100, 0}, {{1}, 90, 5}, {{2}, 60, 6}, {{3}, 55, 4}, {{4}, 10, 20}, {{5}, 10, 30}});
  ASSERT_EQ(hull.size(), 3u);
  EXPECT_EQ(hull[0].rungs, Rungs{0});
  EXPECT_EQ(hull[1].rungs, Rungs{3});
  EXPECT_EQ(hull[2].rungs, Rungs{4});
}

}  // namespace
}  // namespace fovea
