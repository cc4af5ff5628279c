#include "fovea/texture/size_ladder.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

#include "fovea/base/random.h"

namespace fovea {
namespace {

using ::testing::ElementsAre;

LadderStep step(double bytes, double loss) { return {0, bytes, loss}; }

std::vector<double> bytes_of(const SizeLadder& ladder) {
  std::vector<double> bytes;
  for (const LadderStep& s : ladder) bytes.push_back(s.bytes);
  return bytes;
}

TEST(LowerHull, LeavesOutWhatCostsMoreThanItSaves) {
  // (60, 9) is above the line from (100, 0) to (50, 5); (70, 1) is below.
  EXPECT_THAT(bytes_of(lower_hull({step(60, 9), step(50, 5), step(100, 0), step(70, 1), step(10, 100)})),
              ElementsAre(100, 70, 50, 10));
  // More bytes and more loss is of no use.
  EXPECT_THAT(bytes_of(lower_hull({step(100, 3), step(80, 0)})), ElementsAre(80));
  EXPECT_TRUE(lower_hull({}).empty());
}

TEST(ChooseSteps, TakesFromWhereLeastIsLost) {
  const std::vector<SizeLadder> ladders{
      {step(100, 0), step(50, 1), step(10, 3)}, {step(100, 0), step(50, 100), step(10, 1000)}, {}};
  EXPECT_THAT(choose_steps(ladders, 200), ElementsAre(0, 0, 0));
  EXPECT_THAT(choose_steps(ladders, 199), ElementsAre(1, 0, 0));
  EXPECT_THAT(choose_steps(ladders, 110), ElementsAre(2, 0, 0));
  EXPECT_THAT(choose_steps(ladders, 109), ElementsAre(2, 1, 0));
  EXPECT_THAT(choose_steps(ladders, 5), ElementsAre(2, 2, 0));  // cannot be
}

TEST(FillRoom, SpendsWhatIsLeftOnWhatSavesMost) {
  const std::vector<std::vector<LadderStep>> ways{
      {step(100, 0), step(60, 9), step(50, 10), step(10, 30)}, {step(100, 0), step(30, 4)}, {}};
  std::vector<std::size_t> chosen{3, 1, 0};
  fill_room(ways, 95, chosen);  // 55 are left
  EXPECT_THAT(chosen, ElementsAre(1, 1, 0));
  fill_room(ways, 1000, chosen);
  EXPECT_THAT(chosen, ElementsAre(0, 0, 0));
  fill_room(ways, 10, chosen);  // nothing is left
  EXPECT_THAT(chosen, ElementsAre(0, 0, 0));
}

/// All choices of three ladders, tried one by one.
double least_loss(const std::vector<SizeLadder>& ladders, double bytes) {
  double least = std::numeric_limits<double>::infinity();
  for (const LadderStep& a : ladders[0])
    for (const LadderStep& b : ladders[1])
      for (const LadderStep& c : ladders[2])
        if (a.bytes + b.bytes + c.bytes <= bytes) least = std::min(least, a.loss + b.loss + c.loss);
  return least;
}

// Between two points of the common hull the greedy way misses at most the loss of one step.
TEST(ChooseSteps, IsNearTheBestOfAll) {
  Random random(5);
  for (int trial = 0; trial < 50; ++trial) {
    std::vector<SizeLadder> ladders;
    for (int i = 0; i < 3; ++i) {
      std::vector<LadderStep> steps;
      const double size = 50 + 100 * random.uniform(), detail = random.uniform();
      for (int k = 0; k < 8; ++k) {
        const double s = 1.0 / (1 + k);
        steps.push_back(step(size * s, detail * (1 / s - 1) * (0.8 + 0.4 * random.uniform())));
      }
      ladders.push_back(lower_hull(steps));
    }
    double largest = 0;
    for (const SizeLadder& ladder : ladders)
      for (std::size_t k = 1; k < ladder.size(); ++k)
        largest = std::max(largest, ladder[k].loss - ladder[k - 1].loss);
    const double bytes = 80 + 200 * random.uniform();
    const std::vector<std::size_t> chosen = choose_steps(ladders, bytes);
    double sum = 0, loss = 0;
    for (std::size_t i = 0; i < 3; ++i) {
      sum += ladders[i][chosen[i]].bytes;
      loss += ladders[i][chosen[i]].loss;
    }
    const double best = least_loss(ladders, bytes);
    if (best < std::numeric_limits<double>::infinity()) {
      EXPECT_LE(sum, bytes);
      EXPECT_LE(loss, best + largest);
    }
  }
}

}  // namespace
}  // namespace fovea
