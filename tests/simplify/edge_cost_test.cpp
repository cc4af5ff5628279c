#include "fovea/simplify/edge_cost.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "collapse_states.h"
#include "fovea/base/random.h"
#include "fovea/simplify/value_classes.h"

namespace fovea {
namespace {

/// The error of the merged vertex, class by class as the values will really be merged.
Quadric quadric_by_classes(const CollapseState& state, std::uint32_t e) {
  const auto [a, b] = state.mesh.edges[e].ends;
  Quadric q = state.mesh.quadric(a) + state.mesh.quadric(b);
  ValueClasses classes;
  for (const Channel& channel : state.channels) {
    if (channel.kind != ChannelKind::fitted) continue;
    classes.find(state.mesh, channel, a, b, state.mesh.edge_corners(e, a));
    for (std::uint32_t root = 0; root < classes.size(); ++root) {
      if (classes[root].root != root) continue;
      std::vector<float> sum(attribute_stride(channel.fit_width), 0.0f);
      classes.for_class(root, [&](const ValueClasses::Entry& entry) {
        for (std::size_t i = 0; i < sum.size(); ++i) sum[i] += channel.value_quadric(entry.value)[i];
      });
      const std::uint32_t held = classes.held_value(channel, a, b, root);
      if (held == kInvalid) {
        reduce(q, sum.data(), channel.fit_width);
      } else {
        const double scale = channel.scale[0];
        const double s[2] = {scale * channel.value(held)[0], scale * channel.value(held)[1]};
        hold(q, sum.data(), channel.fit_width, s);
      }
    }
  }
  return q;
}

TEST(EdgeCost, IsThePriceOfTheClassesThatMerge) {
  for (const auto& [name, mesh] : test::all_families()) {
    if (mesh.face_count() == 0) continue;
    const CollapseState state = test::state_of(mesh);
    const EdgeCost cost(state, Placement::optimal);
    Random random(6);
    for (std::uint32_t e = 0; e < state.mesh.edges.size(); ++e) {
      const Quadric ours = cost.quadric(e), expected = quadric_by_classes(state, e);
      for (int i = 0; i < 3; ++i) {
        const Vec3d p{random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)};
        // Sums of the same terms in another order, some added and taken away again.
        EXPECT_NEAR(ours.value(p), expected.value(p), 1e-9 * (1 + std::abs(expected.value(p)))) << name;
      }
    }
  }
}

}  // namespace
}  // namespace fovea
