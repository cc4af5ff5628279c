#include "fovea/render/fragment_lists.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "fovea/base/random.h"

namespace fovea {
namespace {

using Corners = std::array<ScreenVertex, 3>;

/// A triangle that covers a picture of up to 64 × 64 pixels, everywhere equally near.
Corners wall(float nearness) {
  constexpr std::int32_t kFar = 1000 * kSubsamples;
  return {{{-kFar, -kFar, nearness}, {kFar, -kFar, nearness}, {0, kFar, nearness}}};
}

/// Many numbers are equal, so that triangles meet in depth; some corners are off the picture, and edges run
/// through the middles of pixels.
Corners random_triangle(Random& random, int size) {
  Corners corners;
  const std::int32_t steps[] = {1, kSubsamples / 2, kSubsamples};
  const std::int32_t step = steps[random.below(3)];
  const bool is_flat = random.below(3) == 0;
  const auto flat = static_cast<float>(1 + random.below(3));
  const auto place = [&] {
    const auto at =
        static_cast<std::int32_t>(random.below(static_cast<std::uint32_t>(2 * size * kSubsamples)));
    return (at - size * kSubsamples / 2) / step * step + kSubsamples / 2;
  };
  for (ScreenVertex& v : corners)
    v = {place(), place(), is_flat ? flat : static_cast<float>(random.uniform(1, 4))};
  return corners;
}

/// What a triangle shows in these tests; every third is full of holes.
bool shown(std::uint32_t triangle, int x, int y, std::uint32_t& value) {
  value = 1 + triangle * 10000 + static_cast<std::uint32_t>(y * 100 + x);
  return triangle % 3 != 0 || (x + 2 * y) % 5 != 0;
}
/// A row at a time, of what is said pixel by pixel.
template <class Value>
auto rows(Value value) {
  return [value](int y, int x0, int x1, std::uint32_t* out) {
    for (int x = x0; x < x1; ++x) {
      std::uint32_t shown = 1;
      *out++ = value(x, y, shown) ? shown : FragmentLists::kHole;
    }
  };
}
auto shows(std::uint32_t triangle) {
  return rows([triangle](int x, int y, std::uint32_t& value) { return shown(triangle, x, y, value); });
}
const auto kSolid = rows([](int, int, std::uint32_t&) { return true; });

/// Inside by the sign of three cross products; on an edge only at the top or left. Literal and slow.
bool is_inside(Corners v, int pixel_x, int pixel_y) {
  const std::int64_t x = std::int64_t{pixel_x} * kSubsamples + kSubsamples / 2,
                     y = std::int64_t{pixel_y} * kSubsamples + kSubsamples / 2;
  const auto side = [](const ScreenVertex& p, const ScreenVertex& q, std::int64_t px, std::int64_t py) {
    return (std::int64_t{q.x} - p.x) * (py - p.y) - (std::int64_t{q.y} - p.y) * (px - p.x);
  };
  if (side(v[0], v[1], v[2].x, v[2].y) < 0) std::swap(v[1], v[2]);
  for (std::size_t k = 0; k < 3; ++k) {
    const ScreenVertex &p = v[k], &q = v[(k + 1) % 3];
    const std::int64_t s = side(p, q, x, y);
    const bool is_top = p.y == q.y && q.x > p.x, is_left = q.y < p.y;
    if (s < 0 || (s == 0 && !is_top && !is_left)) return false;
  }
  return double_area(v) != 0;
}

struct Nearness {
  double value, tolerance;
};

/// Nearness in the middle of a pixel, by the weights of the corners in double precision.
Nearness nearness_at(const Corners& v, int pixel_x, int pixel_y, int width) {
  const double x = (pixel_x + 0.5) * kSubsamples, y = (pixel_y + 0.5) * kSubsamples;
  double value = 0, slope = 0, nearest = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    const ScreenVertex &p = v[(k + 1) % 3], &q = v[(k + 2) % 3];
    const double share = static_cast<double>(v[k].nearness) / static_cast<double>(double_area(v));
    value += ((q.x - p.x) * (y - p.y) - (q.y - p.y) * (x - p.x)) * share;
    slope -= (q.y - p.y) * share * kSubsamples;
    nearest = std::max(nearest, static_cast<double>(v[k].nearness));
  }
  // A row starts at its left end in single precision: a slope across the picture is rounded there.
  return {value, 0x1p-22 * (nearest + std::abs(slope) * width)};
}

using Triangles = std::map<std::uint32_t, Corners>;

FragmentLists fresh_lists(int size, const Triangles& triangles, bool backwards) {
  FragmentLists lists(size, size);
  std::vector<std::uint32_t> numbers;
  for (const auto& entry : triangles) numbers.push_back(entry.first);
  if (backwards) std::reverse(numbers.begin(), numbers.end());
  for (const std::uint32_t t : numbers) lists.insert(t, triangles.at(t), shows(t));
  return lists;
}

void expect_equal(const FragmentLists& a, const FragmentLists& b) {
  EXPECT_EQ(a.size(), b.size());
  for (int y = 0; y < a.height(); ++y) {
    for (int x = 0; x < a.width(); ++x) {
      const auto p = a.at(a.pixel(x, y)), q = b.at(b.pixel(x, y));
      EXPECT_TRUE(std::equal(p.begin(), p.end(), q.begin(), q.end())) << x << ", " << y;
    }
  }
}

void expect_sorted(std::span<const Fragment> list) {
  for (std::size_t i = 1; i < list.size(); ++i) {
    const Fragment &a = list[i - 1], &b = list[i];
    EXPECT_TRUE(a.nearness > b.nearness || (a.nearness == b.nearness && a.triangle < b.triangle));
  }
}

/// That a pixel has just the triangles around its middle, as they are there.
void expect_literal(const FragmentLists& lists, int x, int y, const Triangles& triangles) {
  const std::vector<Fragment> list = lists.at(lists.pixel(x, y));
  std::size_t count = 0;
  std::uint32_t value = 0;
  for (const auto& [t, v] : triangles) count += is_inside(v, x, y) && shown(t, x, y, value);
  EXPECT_EQ(list.size(), count) << x << ", " << y;
  for (const Fragment& fragment : list) {
    ASSERT_TRUE(triangles.contains(fragment.triangle));
    const Corners& v = triangles.at(fragment.triangle);
    EXPECT_TRUE(is_inside(v, x, y) && shown(fragment.triangle, x, y, value));
    EXPECT_EQ(fragment.value, value);
    const Nearness nearness = nearness_at(v, x, y, lists.width());
    EXPECT_NEAR(fragment.nearness, nearness.value, nearness.tolerance);
  }
}

/// The nearest fragment of each pixel, kept up to date by what the lists say of their changes.
class Front {
 public:
  explicit Front(const FragmentLists& lists) : lists_(lists), image_(lists.pixel_count()) {}

  auto note() {
    return [this](std::size_t pixel, const Fragment& before, const Fragment& after) {
      EXPECT_EQ(image_[pixel], copy(before));
      EXPECT_NE(copy(before), copy(after)) << "that is no change";
      image_[pixel] = copy(after);
    };
  }
  void expect_up_to_date() const {
    for (std::size_t p = 0; p < image_.size(); ++p) {
      const std::vector<Fragment> list = lists_.at(p);
      EXPECT_EQ(image_[p], copy(lists_.front(p).first));
      EXPECT_EQ(image_[p], list.empty() ? std::nullopt : std::optional(list[0]));
      EXPECT_EQ(copy(lists_.front(p).second), list.size() < 2 ? std::nullopt : std::optional(list[1]));
    }
  }

 private:
  static std::optional<Fragment> copy(const Fragment& fragment) {
    return fragment.triangle == kInvalid ? std::nullopt : std::optional(fragment);
  }

  const FragmentLists& lists_;
  std::vector<std::optional<Fragment>> image_;
};

/// Lists in which triangles come and go at random.
class BusyLists {
 public:
  BusyLists(int size, std::uint64_t seed) : random_(seed), lists_(size, size), front_(lists_) {}

  void change() {
    const std::uint32_t t = random_.below(40);
    if (const auto at = triangles_.find(t); at != triangles_.end()) {
      lists_.remove(t, at->second, front_.note());
      triangles_.erase(at);
    } else {
      triangles_[t] = random_triangle(random_, lists_.width());
      lists_.insert(t, triangles_[t], shows(t), front_.note());
    }
  }
  const FragmentLists& lists() const { return lists_; }
  const Front& front() const { return front_; }
  const Triangles& triangles() const { return triangles_; }

 private:
  Random random_;
  FragmentLists lists_;
  Front front_;
  Triangles triangles_;
};

// Sizes on both sides of the width up to which triangles are tried sample by sample.
constexpr int kSizes[] = {5, 24};

TEST(FragmentLists, AreSortedAndHaveTheTrianglesAroundEachPixel) {
  for (const int size : kSizes) {
    BusyLists busy(size, 11);
    for (int i = 0; i < 20; ++i) {
      for (int k = 0; k < 15; ++k) busy.change();
      for (int y = 0; y < size; ++y) {
        for (int x = 0; x < size; ++x) {
          expect_sorted(busy.lists().at(busy.lists().pixel(x, y)));
          expect_literal(busy.lists(), x, y, busy.triangles());
        }
      }
    }
  }
}

TEST(FragmentLists, DependOnTheTrianglesAndNotOnWhatWasBefore) {
  for (const int size : kSizes) {
    BusyLists busy(size, 12);
    for (int i = 0; i < 30; ++i) {
      for (int k = 0; k < 15; ++k) busy.change();
      expect_equal(busy.lists(), fresh_lists(size, busy.triangles(), false));
      expect_equal(busy.lists(), fresh_lists(size, busy.triangles(), true));
    }
  }
}

TEST(FragmentLists, SayWhatChangesInFront) {
  for (const int size : kSizes) {
    BusyLists busy(size, 13);
    for (int i = 0; i < 300; ++i) {
      busy.change();
      busy.front().expect_up_to_date();
    }
  }
}

TEST(FragmentLists, SayNothingOfWhatIsHidden) {
  FragmentLists lists(4, 4);
  int changes = 0;
  const auto count = [&](auto&&...) { ++changes; };
  lists.insert(1, wall(2), kSolid, count);
  EXPECT_EQ(changes, 16);
  lists.insert(2, wall(1), kSolid, count);
  lists.remove(2, wall(1), count);
  EXPECT_EQ(changes, 16);
  lists.remove(1, wall(2), count);
  EXPECT_EQ(changes, 32);
}

TEST(FragmentLists, OfEquallyNearTheSmallerNumberIsInFront) {
  FragmentLists lists(3, 2);
  for (const std::uint32_t t : {5u, 9u, 2u, 7u}) lists.insert(t, wall(1), kSolid);
  for (int p = 0; p < 6; ++p) {
    std::vector<std::uint32_t> order;
    for (const Fragment& fragment : lists.at(lists.pixel(p % 3, p / 3))) order.push_back(fragment.triangle);
    EXPECT_EQ(order, (std::vector<std::uint32_t>{2, 5, 7, 9}));
  }
}

TEST(FragmentLists, WhatLiesBehindAHoleIsSeen) {
  const auto left_half = rows([](int x, int, std::uint32_t&) { return x < 2; });
  FragmentLists lists(4, 1);
  Front front(lists);
  lists.insert(1, wall(2), left_half, front.note());
  EXPECT_TRUE(lists.at(3).empty());
  lists.insert(2, wall(1), kSolid, front.note());
  EXPECT_EQ(lists.at(1)[0].triangle, 1u);
  EXPECT_EQ(lists.at(2)[0].triangle, 2u);
  // Takes nothing away where it has its hole.
  lists.remove(1, wall(2), front.note());
  EXPECT_EQ(lists.size(), 4u);
  for (std::size_t p = 0; p < 4; ++p) EXPECT_EQ(lists.at(p)[0].triangle, 2u);
  front.expect_up_to_date();
}

TEST(FragmentLists, ATriangleOfHolesLeavesNoTrace) {
  const auto hole = rows([](int, int, std::uint32_t&) { return false; });
  FragmentLists lists(4, 4);
  Front front(lists);
  lists.insert(1, wall(2), hole, front.note());
  EXPECT_EQ(lists.size(), 0u);
  lists.remove(1, wall(2), front.note());
  EXPECT_EQ(lists.size(), 0u);
  front.expect_up_to_date();
}

TEST(FragmentLists, TrianglesOffThePictureOrWithoutAreaAreNowhere) {
  constexpr std::int32_t kFar = 1 << 28;  // as far as vertices are put
  const Corners nowhere[] = {
      {{{5 * kSubsamples, 0, 1}, {9 * kSubsamples, 0, 1}, {7 * kSubsamples, 4 * kSubsamples, 1}}},
      {{{-kFar, -kFar, 1}, {kFar, -kFar, 1}, {0, -kSubsamples, 1}}},
      {{{0, 0, 1}, {2 * kSubsamples, 2 * kSubsamples, 1}, {4 * kSubsamples, 4 * kSubsamples, 1}}},
      {{{kSubsamples / 2, kSubsamples / 2, 1},
        {kSubsamples / 2, kSubsamples / 2, 1},
        {kSubsamples / 2, kSubsamples / 2, 1}}},
      {{{kSubsamples, kSubsamples, 1},
        {kSubsamples + 100, kSubsamples, 1},
        {kSubsamples, kSubsamples + 100, 1}}},  // between the middles of pixels
  };
  FragmentLists lists(4, 4);
  for (const Corners& v : nowhere) {
    lists.insert(1, v, kSolid);
    EXPECT_EQ(lists.size(), 0u);
    lists.remove(1, v);
  }
  lists.insert(2, {{{-kFar, -kFar, 1}, {kFar, -kFar, 1}, {0, kFar, 1}}}, kSolid);
  EXPECT_EQ(lists.size(), 16u) << "corners may be far away";
}

TEST(FragmentLists, APictureWithoutPixelsHoldsNothing) {
  FragmentLists lists(0, 0);
  lists.insert(1, wall(1), kSolid);
  lists.remove(1, wall(1));
  EXPECT_EQ(lists.size(), 0u);
}

TEST(FragmentLists, SizeCountsTheFragments) {
  BusyLists busy(24, 14);
  for (int i = 0; i < 200; ++i) {
    busy.change();
    std::size_t count = 0;
    for (std::size_t p = 0; p < busy.lists().pixel_count(); ++p) count += busy.lists().at(p).size();
    ASSERT_EQ(busy.lists().size(), count);
  }
}

TEST(FragmentLists, TakeAFewTimesWhatTheirFragmentsNeed) {
  EXPECT_EQ(sizeof(Fragment), 12u);
  constexpr std::size_t kPixels = std::size_t{64} * 64;
  FragmentLists lists(64, 64);
  EXPECT_EQ(lists.bytes(), 32 * kPixels);
  for (std::uint32_t t = 0; t < 40; ++t) {
    lists.insert(t, wall(static_cast<float>(t % 7)), kSolid);
    const std::size_t behind = lists.size() - std::min(lists.size(), 2 * kPixels);
    EXPECT_GE(lists.bytes(), 32 * kPixels + 12 * behind);
    // Rooms of 1, 2, 4 … are at most four times the fragments; the pool grows by doubling.
    EXPECT_LE(lists.bytes(), 32 * kPixels + 9 * 12 * behind);
  }
}

TEST(FragmentLists, WhatComesAndGoesAgainTakesNoMoreRoom) {
  Random random(15);
  std::vector<Corners> triangles;
  for (int i = 0; i < 60; ++i) triangles.push_back(random_triangle(random, 24));
  FragmentLists lists(24, 24);
  std::size_t first = 0;
  for (int round = 0; round < 5; ++round) {
    for (std::uint32_t t = 0; t < 60; ++t) lists.insert(t, triangles[t], shows(t));
    for (std::uint32_t t = 0; t < 60; ++t) lists.remove(t, triangles[t]);
    EXPECT_EQ(lists.size(), 0u);
    if (round == 0) first = lists.bytes();
    EXPECT_EQ(lists.bytes(), first);
  }
}

}  // namespace
}  // namespace fovea
