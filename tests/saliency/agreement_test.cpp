#include "fovea/saliency/agreement.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

#include "fovea/base/random.h"
#include "oracle/agreement_oracle.h"
#include "support/reading.h"

namespace fovea {
namespace {

using test::expect_error;
using Values = std::vector<float>;

void expect_near(const Agreement& a, const Agreement& b, double tolerance = 1e-9) {
  EXPECT_NEAR(a.correlation, b.correlation, tolerance);
  EXPECT_NEAR(a.spearman, b.spearman, tolerance);
  EXPECT_NEAR(a.auc, b.auc, tolerance);
  EXPECT_NEAR(a.nss, b.nss, tolerance);
  EXPECT_NEAR(a.kl, b.kl, tolerance);
  EXPECT_NEAR(a.similarity, b.similarity, tolerance);
}

void expect_numbers(const Agreement& a) {
  for (const double x : {a.correlation, a.spearman, a.auc, a.nss, a.kl, a.similarity})
    EXPECT_TRUE(std::isfinite(x));
  EXPECT_LE(std::abs(a.correlation), 1);
  EXPECT_LE(std::abs(a.spearman), 1);
  EXPECT_TRUE(a.auc >= 0 && a.auc <= 1);
  EXPECT_TRUE(a.similarity >= 0 && a.similarity <= 1 + 1e-12);
}

/// A random pair of maps; few distinct values if `levels` is small, so that there are ties.
struct Maps {
  Values predicted, observed, areas;

  Maps(std::size_t count, std::uint32_t levels, std::uint64_t seed) {
    Random random(seed);
    for (std::size_t i = 0; i < count; ++i) {
      predicted.push_back(static_cast<float>(random.below(levels)) - 2);
      observed.push_back(static_cast<float>(random.below(levels)));
      areas.push_back(static_cast<float>(random.uniform(0.1, 3)));
    }
    observed[0] = 1;
  }
  Agreement score(double fixated_area = 0.05) const {
    return agreement(predicted, observed, areas, {fixated_area});
  }
};

TEST(Agreement, EqualsTheWords) {
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    for (const std::uint32_t levels : {4u, 1000u}) {
      for (const double fixated_area : {0.05, 0.3}) {
        const Maps maps(60, levels, seed);
        expect_near(maps.score(fixated_area),
                    test::agreement_by_pairs(maps.predicted, maps.observed, maps.areas, fixated_area));
      }
    }
  }
}

TEST(Agreement, ByHand) {
  // Fixated is the last, which has 1 of an area of 3 above 0; the larger the area, the more it weighs.
  const Agreement a = agreement(Values{1, 0, 2, 2}, Values{0, 0, 1, 3}, Values{4, 1, 2, 1});
  // Means 10/8 and 5/8; sums of squares 3.5 and 7.875, of products 10 before the means.
  EXPECT_NEAR(a.correlation, (10 - 10 * 5.0 / 8) / std::sqrt(3.5 * 7.875), 1e-12);
  // Ranks 3, 0.5, 6.5, 6.5 and 2.5, 2.5, 6, 7.5, about 4: sums of squares 35 and 31.5, of products 30.
  EXPECT_NEAR(a.spearman, 30 / std::sqrt(35 * 31.5), 1e-12);
  EXPECT_NEAR(a.auc, (5 + 0.5 * 2) / 7, 1e-12);
  EXPECT_NEAR(a.nss, (2 - 1.25) / std::sqrt(3.5 / 8), 1e-12);
  // Densities 0, 0, 1.6, 4.8 and 0.8, 0, 1.6, 1.6.
  EXPECT_NEAR(a.kl, 4.8 * std::log(3) / 8, 1e-12);
  EXPECT_NEAR(a.similarity, (2 * 1.6 + 1.6) / 8, 1e-12);
}

TEST(Agreement, OfAMapWithItself) {
  const Maps maps(200, 1000, 1);
  const Agreement a = agreement(maps.observed, maps.observed, maps.areas);
  EXPECT_NEAR(a.correlation, 1, 1e-12);
  EXPECT_NEAR(a.spearman, 1, 1e-12);
  EXPECT_NEAR(a.auc, 1, 1e-12);
  EXPECT_GT(a.nss, 1);
  EXPECT_NEAR(a.kl, 0, 1e-12);
  EXPECT_NEAR(a.similarity, 1, 1e-12);
}

TEST(Agreement, OfAMapWithItsOpposite) {
  const Maps maps(200, 1000, 2);
  Values opposite = maps.observed;
  for (float& x : opposite) x = -x;
  const Agreement a = agreement(opposite, maps.observed, maps.areas);
  EXPECT_NEAR(a.correlation, -1, 1e-12);
  EXPECT_NEAR(a.spearman, -1, 1e-12);
  EXPECT_NEAR(a.auc, 0, 1e-12);
  EXPECT_LT(a.nss, -1);
  EXPECT_GT(a.kl, 0);
}

TEST(Agreement, FixatedIsTheTopOfWhatWasLookedAt) {
  // 100 elements of which 40 were looked at, with values 1 to 40: 5 % of these are the last two.
  Values observed(100, 0.0f), predicted(100, 0.0f);
  for (std::size_t i = 0; i < 40; ++i) observed[60 + i] = static_cast<float>(i + 1);
  predicted[98] = predicted[99] = 1;
  const Values areas(100, 1.0f);
  EXPECT_NEAR(agreement(predicted, observed, areas).auc, 1, 1e-12);
  predicted[97] = 1;
  EXPECT_NEAR(agreement(predicted, observed, areas).auc, 1 - 0.5 / 98, 1e-12);
  predicted[97] = predicted[98] = 0;
  EXPECT_NEAR(agreement(predicted, observed, areas).auc, (1 + 0.5) / 2, 1e-12);
  // Where the value at the border is shared, all that have it are fixated.
  observed[97] = observed[98];
  predicted[97] = predicted[98] = predicted[99] = 1;
  EXPECT_NEAR(agreement(predicted, observed, areas).auc, 1, 1e-12);
}

TEST(Agreement, ConstantMapsSayNothing) {
  const Maps maps(50, 10, 3);
  for (const float constant : {0.0f, 0.1f, 7.0f, -3.0f}) {
    const Agreement a = agreement(Values(50, constant), maps.observed, maps.areas);
    expect_numbers(a);
    EXPECT_EQ(a.correlation, 0);
    EXPECT_EQ(a.spearman, 0);
    EXPECT_NEAR(a.auc, 0.5, 1e-12);
    EXPECT_EQ(a.nss, 0);
    expect_near(a, agreement(Values(50, 1.0f), maps.observed, maps.areas));  // as densities all are uniform
  }
  const Agreement even = agreement(maps.predicted, Values(50, 2.0f), maps.areas);
  expect_numbers(even);
  EXPECT_EQ(even.correlation, 0);
  EXPECT_EQ(even.spearman, 0);
  EXPECT_EQ(even.auc, 0.5);  // all is fixated
  EXPECT_NEAR(even.nss, 0, 1e-12);
}

TEST(Agreement, UnitsDoNotMatter) {
  Maps maps(80, 1000, 4);
  for (float& x : maps.predicted) x += 2;  // from 0
  const Agreement before = maps.score();
  Maps scaled = maps;
  for (float& x : scaled.predicted) x *= 64;
  for (float& x : scaled.observed) x *= 0.125f;
  for (float& x : scaled.areas) x *= 1024;
  expect_near(scaled.score(), before);
}

TEST(Agreement, ShiftsAndBendsMatterOnlyWhereTheyMust) {
  Maps maps(80, 1000, 5);
  const Agreement before = maps.score();
  for (float& x : maps.predicted) x += 500;
  const Agreement shifted = maps.score();
  EXPECT_NEAR(shifted.correlation, before.correlation, 1e-9);
  EXPECT_NEAR(shifted.nss, before.nss, 1e-9);
  EXPECT_LT(shifted.kl, before.kl);  // nearer to uniform
  for (float& x : maps.predicted) x = x * x;
  const Agreement bent = maps.score();
  EXPECT_NEAR(bent.spearman, before.spearman, 1e-9);
  EXPECT_NEAR(bent.auc, before.auc, 1e-9);
}

TEST(Agreement, CuttingElementsChangesNothing) {
  for (std::uint64_t seed = 0; seed < 10; ++seed) {
    const Maps maps(60, seed % 2 == 0 ? 5 : 1000, seed);
    Maps cut = maps;
    for (std::size_t i = 0; i < 60; i += 3) {
      cut.areas[i] /= 2;
      cut.predicted.push_back(cut.predicted[i]);
      cut.observed.push_back(cut.observed[i]);
      cut.areas.push_back(cut.areas[i]);
    }
    expect_near(cut.score(), maps.score());
  }
}

TEST(Agreement, ElementsWithoutAreaCountNowhere) {
  const Maps maps(40, 10, 6);
  Maps more = maps;
  more.predicted.push_back(-1e30f);
  more.observed.push_back(1e30f);
  more.areas.push_back(0);
  expect_near(more.score(), maps.score(), 0);
}

TEST(Agreement, IsANumberForAnyNumbers) {
  constexpr float kLeast = std::numeric_limits<float>::denorm_min(),
                  kMost = std::numeric_limits<float>::max();
  const float values[] = {0, kLeast, 1, std::nextafter(1.0f, 2.0f), kMost};
  for (const float a : values) {
    for (const float b : values) {
      for (const float c : {kLeast, 1.0f, kMost}) {
        expect_numbers(agreement(Values{a, -b, b}, Values{b, a, 1}, Values{c, 1, kLeast}));
        expect_numbers(agreement(Values{a}, Values{1}, Values{c}));
      }
    }
  }
}

TEST(Agreement, BadInputIsRefused) {
  const auto refused = [](const Values& predicted, const Values& observed, const Values& areas,
                          const std::string& message, double share = 0.05) {
    expect_error([&] { agreement(predicted, observed, areas, {share}); }, ErrorKind::usage, "", message);
  };
  constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
  constexpr float kInfinite = std::numeric_limits<float>::infinity();
  refused({1, 2}, {1, 2, 3}, {1, 1, 1}, "2 predicted and 3 observed values do not fit 3 areas");
  refused({1, 2, 3}, {1, 2, 3}, {1, 1}, "do not fit 2 areas");
  refused({}, {}, {}, "nothing was observed");
  refused({1, 2}, {0, 0}, {1, 1}, "nothing was observed");
  refused({1, 2}, {0, 1}, {1, 0}, "nothing was observed");
  refused({1, kNan}, {1, 2}, {1, 1}, "predicted value 1 is not a finite number");
  refused({1, 2}, {kInfinite, 2}, {1, 1}, "observed value 0 is not a finite number");
  refused({1, 2}, {1, 2}, {1, kInfinite}, "area 1 is not a finite number");
  refused({1, 2}, {1, -2}, {1, 1}, "observed value 1 is negative");
  refused({1, 2}, {1, 2}, {-1, 1}, "area 0 is negative");
  refused({1, 2}, {1, 2}, {1, 1}, "(0, 1]", 0);
  refused({1, 2}, {1, 2}, {1, 1}, "(0, 1]", kNan);
}

}  // namespace
}  // namespace fovea
