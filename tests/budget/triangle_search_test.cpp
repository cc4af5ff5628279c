#include "fovea/budget/triangle_search.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

namespace fovea {
namespace {

TEST(TriangleSearch, FindsTheMostWithinTheBytes) {
  for (const double fixed : {0.0, 500.0, 40000.0}) {
    for (const double bend : {1.0, 0.9, 1.1}) {
      for (const std::uint64_t bytes : {45000u, 100000u, 700000u}) {
        std::set<std::uint64_t> asked;
        const auto bytes_at = [&](std::uint64_t n) {
          EXPECT_TRUE(asked.insert(n).second) << n;
          return static_cast<std::uint64_t>(fixed + 20 * std::pow(static_cast<double>(n), bend));
        };
        const auto found = most_triangles(bytes, 100000, bytes_at);
        ASSERT_TRUE(found);
        EXPECT_LE(asked.size(), 9u);
        asked.clear();
        const std::uint64_t taken = bytes_at(*found);
        EXPECT_LE(taken, bytes);
        if (*found < 100000) {
          EXPECT_GT(static_cast<double>(taken), 0.985 * static_cast<double>(bytes));
        }
      }
    }
  }
}

TEST(TriangleSearch, WhatFitsStays) {
  EXPECT_EQ(most_triangles(1000, 40, [](std::uint64_t n) { return 20 * n; }), 40u);
}

TEST(TriangleSearch, TooFewBytesHaveNoAnswer) {
  EXPECT_FALSE(most_triangles(1000, 4000, [](std::uint64_t n) { return 2000 + 20 * n; }));
  EXPECT_FALSE(most_triangles(10, 1, [](std::uint64_t n) { return 20 * n; }));
}

TEST(TriangleSearch, StepsAreNoTrouble) {
  // A simplification may not reach every number.
  const auto bytes_at = [](std::uint64_t n) { return 100 + 20 * (n / 64 * 64 + 12); };
  const auto found = most_triangles(10000, 4000, bytes_at);
  ASSERT_TRUE(found);
  EXPECT_LE(bytes_at(*found), 10000u);
  EXPECT_GT(bytes_at(*found), 8500u);
}

}  // namespace
}  // namespace fovea
