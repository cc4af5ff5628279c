#include "fovea/model/wrap.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <limits>

namespace fovea {
namespace {

constexpr Wrap kWraps[] = {Wrap::repeat, Wrap::mirror, Wrap::clamp};

TEST(Wrap, BringsTexelsBackAsSamplersDo) {
  const std::array<int, 12> repeat{1, 2, 0, 1, 2, 0, 1, 2, 0, 1, 2, 0},
      mirror{1, 2, 2, 1, 0, 0, 1, 2, 2, 1, 0, 0};
  for (int i = -5; i < 7; ++i) {
    const auto k = static_cast<std::size_t>(i + 5);
    EXPECT_EQ(wrapped_texel(i, 3, Wrap::repeat), repeat[k]) << i;
    EXPECT_EQ(wrapped_texel(i, 3, Wrap::clamp), std::clamp(i, 0, 2)) << i;
    EXPECT_EQ(wrapped_texel(i, 3, Wrap::mirror), mirror[k]) << i;
  }
}

TEST(Wrap, ACoordinateFindsTheTexelAroundIt) {
  // The middle of texel i of 3 is (i + ½) / 3.
  for (const Wrap wrap : kWraps) {
    for (int i = -7; i < 8; ++i)
      EXPECT_EQ(nearest_texel((static_cast<float>(i) + 0.5f) / 3, 3, wrap), wrapped_texel(i, 3, wrap)) << i;
  }
}

TEST(Wrap, EveryUsableCoordinateIsInside) {
  const float tiny = std::numeric_limits<float>::denorm_min(), below_one = 1 - 6e-8f;
  for (const Wrap wrap : kWraps) {
    for (const float u :
         {0.0f, -0.0f, tiny, -tiny, 1e-9f, -1e-9f, 1.0f, below_one, -1.0f, 2.0f, 999999.9f, -999999.9f}) {
      for (const int size : {1, 2, 3, 4096}) {
        EXPECT_GE(nearest_texel(u, size, wrap), 0);
        EXPECT_LT(nearest_texel(u, size, wrap), size);
      }
    }
  }
}

TEST(Wrap, WhatIsNowhereIsAtZero) {
  const float infinity = std::numeric_limits<float>::infinity();
  for (const float u : {std::numeric_limits<float>::quiet_NaN(), infinity, -infinity, 3e38f, -1e6f})
    EXPECT_EQ(usable_coordinate(u), 0);
  EXPECT_EQ(usable_coordinate(-3.25f), -3.25f);
}

}  // namespace
}  // namespace fovea
