#include "fovea/simplify/value_classes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "collapse_states.h"

namespace fovea {
namespace {

const Channel& uv_channel(const CollapseState& state) {
  for (const Channel& channel : state.channels) {
    if (channel.is_uv()) return channel;
  }
  throw std::logic_error("the mesh has texture coordinates");
}

std::size_t class_count(const ValueClasses& classes) {
  std::set<std::uint32_t> roots;
  for (std::size_t i = 0; i < classes.size(); ++i) roots.insert(classes[i].root);
  return roots.size();
}

/// The classes of the channel for the edge a–b.
void find(ValueClasses& classes, const CollapseState& state, const Channel& channel, std::uint32_t a,
          std::uint32_t b) {
  classes.find(state.mesh, channel, a, b, state.mesh.edge_corners(test::edge_between(state, a, b), a));
}

/// Every entry is reached from its root, once.
void expect_lists_whole(const ValueClasses& classes) {
  std::size_t reached = 0;
  for (std::uint32_t i = 0; i < classes.size(); ++i) {
    if (classes[i].root != i) continue;
    classes.for_class(i, [&](const ValueClasses::Entry& entry) {
      EXPECT_EQ(entry.root, i);
      ++reached;
    });
  }
  EXPECT_EQ(reached, classes.size());
}

TEST(ValueClasses, APlainEdgeLeavesOneValue) {
  const CollapseState state = test::state_of(test::grid(4, 4));
  ValueClasses classes;
  find(classes, state, uv_channel(state), test::vertex_at(state, {0.5f, 0.5f, 0}),
       test::vertex_at(state, {0.75f, 0.5f, 0}));
  EXPECT_EQ(classes.size(), 2u);
  EXPECT_EQ(class_count(classes), 1u);
  expect_lists_whole(classes);
}

/// On the cylinder the line at angle 0 is a seam.
struct Cylinder {
  CollapseState state = test::state_of(test::open_cylinder(16, 4));
  const Channel& channel = uv_channel(state);
  std::uint32_t seam = test::vertex_at(state, {1, 0, 0});
  ValueClasses classes;

  /// The neighbour of `seam` on or off the seam.
  std::uint32_t neighbour(bool on_seam) const {
    std::uint32_t found = kInvalid;
    state.mesh.for_ring(seam, [&](std::uint32_t c) {
      const std::uint32_t w = state.mesh.vertex(CollapseMesh::next(c));
      if ((channel.single[w] == Channel::kMany) == on_seam) found = w;
    });
    return found;
  }
};

TEST(ValueClasses, ASeamEdgeLeavesOneValuePerSide) {
  Cylinder c;
  find(c.classes, c.state, c.channel, c.seam, c.neighbour(true));
  EXPECT_EQ(c.classes.size(), 4u);
  EXPECT_EQ(class_count(c.classes), 2u);
  expect_lists_whole(c.classes);
  for (std::uint32_t i = 0; i < c.classes.size(); ++i) {
    // Along the seam both sides may move.
    if (c.classes[i].root == i) {
      EXPECT_EQ(c.classes.held_value(c.channel, c.seam, c.neighbour(true), i), kInvalid);
    }
  }
}

TEST(ValueClasses, AnInnerVertexTakesTheValueOfTheSeam) {
  Cylinder c;
  const std::uint32_t inner = c.neighbour(false);
  find(c.classes, c.state, c.channel, c.seam, inner);
  EXPECT_EQ(c.classes.size(), 3u);
  EXPECT_EQ(class_count(c.classes), 2u);
  for (std::uint32_t i = 0; i < c.classes.size(); ++i) {
    if (c.classes[i].root != i) continue;
    const std::uint32_t held = c.classes.held_value(c.channel, c.seam, inner, i);
    ASSERT_NE(held, kInvalid);
    EXPECT_NE(held, c.channel.single[inner]);
  }
}

TEST(ValueClasses, WhereASeamEndsItsSidesJoinAtItsEnd) {
  // A fan around b; between a and b runs a seam that ends in b.
  test::PartBuilder part;
  const std::uint32_t b = part.vertex({0, 0, 0}, {0.5f, 0.5f});
  std::vector<std::uint32_t> rim;
  for (int i = 0; i <= 6; ++i) {
    const double angle = i * M_PI / 3;
    const auto x = static_cast<float>(std::cos(angle)), y = static_cast<float>(std::sin(angle));
    const Vec3f p = i == 6 ? Vec3f{1, 0, 0} : Vec3f{x, y, 0};  // the last is the first again
    rim.push_back(part.vertex(p, {0.5f + 0.5f * x, 0.5f + 0.5f * y - (i == 6 ? 0.1f : 0)}));
  }
  for (std::size_t i = 0; i < 6; ++i) part.triangle(b, rim[i], rim[i + 1]);
  const CollapseState state = test::state_of(test::weld_part(part.part()));
  const Channel& channel = uv_channel(state);
  const std::uint32_t centre = test::vertex_at(state, {0, 0, 0}), end = test::vertex_at(state, {1, 0, 0});
  ASSERT_EQ(channel.single[end], Channel::kMany);
  ValueClasses classes;
  find(classes, state, channel, end, centre);
  EXPECT_EQ(classes.size(), 3u);
  EXPECT_EQ(class_count(classes), 1u);
  EXPECT_EQ(classes.held_value(channel, end, centre, 0), channel.single[centre]);
}

TEST(ValueClasses, FindsEachOfThousandsOfValuesAtAPole) {
  constexpr int kAround = 3000;
  test::PartBuilder part;
  const auto rim = [](int i) {
    const double angle = 2 * M_PI * (i % kAround) / kAround;
    return Vec3f{static_cast<float>(std::cos(angle)), static_cast<float>(std::sin(angle)), 0};
  };
  for (int i = 0; i < kAround; ++i) {
    const auto u = static_cast<float>(i) / kAround, du = 1.0f / kAround;
    const std::uint32_t pole = part.vertex({0, 0, 1}, {u + du / 2, 1});
    part.triangle(pole, part.vertex(rim(i), {u, 0}), part.vertex(rim(i + 1), {u + du, 0}));
  }
  const CollapseState state = test::state_of(test::weld_part(part.part()));
  const Channel& channel = uv_channel(state);
  const std::uint32_t pole = test::vertex_at(state, {0, 0, 1}), other = test::vertex_at(state, rim(1));
  ValueClasses classes;
  find(classes, state, channel, pole, other);
  EXPECT_EQ(classes.size(), static_cast<std::size_t>(kAround) + 1);  // the pole's, and one at the rim
  EXPECT_EQ(class_count(classes), static_cast<std::size_t>(kAround) - 1);
  for (std::uint32_t i = 0; i < classes.size(); ++i) EXPECT_EQ(classes.index_of(classes[i].value), i);
  EXPECT_EQ(classes.index_of(kInvalid - 5), kInvalid);
  expect_lists_whole(classes);
}

}  // namespace
}  // namespace fovea
